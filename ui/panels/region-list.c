/* The list of the regions of a body or asset: add, edit, delete. */
#include "ui/panels/region-list.h"

#include <glib/gi18n.h>

#include "core/author/region_edits.h"
#include "ui/panels/report.h"
#include "ui/panels/spore-property-row.h"
#include "ui/panels/spore-section-list.h"

static void activate_named(GtkButton *button, const char *action) {
  const char *path = g_object_get_data(G_OBJECT(button), "path");
  spore_activate(GTK_WIDGET(button), action, g_variant_new_string(path));
}

static GtkWidget *new_button(GtkWidget *button, const char *action, const char *path) {
  g_object_set_data_full(G_OBJECT(button), "path", g_strdup(path), g_free);
  g_signal_connect(button, "clicked", G_CALLBACK(activate_named), (gpointer)action);
  return button;
}

GtkWidget *spore_row_icon_new(const char *icon, const char *text, const char *action, const char *path) {
  GtkWidget *button = gtk_button_new_from_icon_name(icon, GTK_ICON_SIZE_BUTTON);
  gtk_style_context_add_class(gtk_widget_get_style_context(button), "row-button");
  gtk_button_set_relief(GTK_BUTTON(button), GTK_RELIEF_NONE);
  gtk_widget_set_tooltip_text(button, text);
  atk_object_set_name(gtk_widget_get_accessible(button), text);
  return new_button(button, action, path);
}

static GtkWidget *new_head(SporeObject *region, const char *path) {
  GtkWidget *head = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6), *name = gtk_label_new(spore_object_name(region));
  g_autofree char *place = g_strdup_printf(_("Place region %s in the view"), spore_object_name(region));
  g_autofree char *paint = g_strdup_printf(_("Paint region %s in the view"), spore_object_name(region));
  g_autofree char *delete = g_strdup_printf(_("Delete region %s"), spore_object_name(region));
  gtk_label_set_xalign(GTK_LABEL(name), 0);
  gtk_label_set_ellipsize(GTK_LABEL(name), PANGO_ELLIPSIZE_END);
  gtk_widget_set_hexpand(name, TRUE);
  gtk_style_context_add_class(gtk_widget_get_style_context(name), "heading");
  gtk_container_add(GTK_CONTAINER(head), name);
  gtk_container_add(GTK_CONTAINER(head), spore_row_icon_new("find-location-symbolic", place, "place-region", path));
  gtk_container_add(GTK_CONTAINER(head), spore_row_icon_new("document-edit-symbolic", paint, "paint-region", path));
  gtk_container_add(GTK_CONTAINER(head), spore_row_icon_new("edit-delete-symbolic", delete, "remove-region", path));
  return head;
}

/* The facts follow the region, and what it holds. */
static void show_facts(GtkLabel *label) {
  SporeEditorDocument *document = g_object_get_data(G_OBJECT(label), "document");
  const char *path = g_object_get_data(G_OBJECT(label), "path");
  const SporeObject *region = spore_document_by_path(spore_editor_document_get(document), path);
  g_autofree char *facts = region ? spore_region_facts(spore_editor_document_get(document), region) : NULL;
  gtk_label_set_text(label, facts ? facts : "");
  gtk_widget_set_visible(GTK_WIDGET(label), facts != NULL);
}

static void add_facts(GtkBox *box, SporeEditorDocument *document, const char *path) {
  GtkWidget *label = spore_section_fact_new(box);
  g_object_set_data(G_OBJECT(label), "document", document);
  g_object_set_data_full(G_OBJECT(label), "path", g_strdup(path), g_free);
  gtk_widget_set_no_show_all(label, TRUE);
  g_signal_connect_object(document, "changed", G_CALLBACK(show_facts), label, G_CONNECT_SWAPPED);
  show_facts(GTK_LABEL(label));
}

static void add_region(GtkBox *box, SporeEditorDocument *document, SporeObject *region, GPtrArray *rows) {
  g_autofree char *path = spore_object_path(region);
  const SporeObjectType *type = spore_object_type(region);
  gtk_container_add(GTK_CONTAINER(box), new_head(region, path));
  add_facts(box, document, path);
  for (guint i = 0; i < type->table->count; i++) {
    GtkWidget *row = spore_property_row_new(document, path, type, i);
    gtk_container_add(GTK_CONTAINER(box), row);
    g_ptr_array_add(rows, row);
  }
}

void spore_fill_region_list(GtkBox *box, SporeEditorDocument *document, const char *holder, const SporeObjectType *type,
                            const char *empty, GPtrArray *rows) {
  SporeObject *object = spore_document_by_path(spore_editor_document_get(document), holder);
  const char *element = spore_region_element(type);
  guint count = 0;
  for (guint i = 0; object && i < spore_object_child_count(object); i++) {
    SporeObject *child = spore_object_child(object, i);
    if (!g_str_equal(spore_object_type(child)->element, element)) continue;
    add_region(box, document, child, rows);
    count++;
  }
  if (!count) gtk_label_set_text(GTK_LABEL(spore_section_fact_new(box)), empty);
  GtkWidget *button = new_button(gtk_button_new_with_label(_("Add region")), "add-region", holder);
  gtk_widget_set_tooltip_text(button,
                              _("A ball in the middle of the body, to be placed and sized in the view or by its rows"));
  GtkWidget *buttons = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6);
  gtk_container_add(GTK_CONTAINER(buttons), button);
  button = new_button(gtk_button_new_with_label(_("Paint region")), "paint-region", holder);
  gtk_widget_set_tooltip_text(button, _("A region that a brush paints on the organ in the view"));
  gtk_container_add(GTK_CONTAINER(buttons), button);
  gtk_container_add(GTK_CONTAINER(box), buttons);
}
