/* The list of the levels of detail of a body. */
#include "ui/panels/level-list.h"

#include <glib/gi18n.h>

#include "ui/panels/batch.h"
#include "ui/panels/region-list.h"
#include "ui/panels/spore-property-row.h"

static GtkWidget *new_head(const SporeObject *level, const char *path) {
  const char *label = _(spore_object_type(level)->label);
  GtkWidget *head = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6), *name = gtk_label_new(label);
  g_autofree char *delete = g_strdup_printf(_("Delete: %s"), label);
  gtk_label_set_xalign(GTK_LABEL(name), 0);
  gtk_widget_set_hexpand(name, TRUE);
  gtk_style_context_add_class(gtk_widget_get_style_context(name), "heading");
  gtk_widget_set_tooltip_text(name, _(spore_object_type(level)->doc));
  gtk_container_add(GTK_CONTAINER(head), name);
  gtk_container_add(GTK_CONTAINER(head), spore_row_icon_new("edit-delete-symbolic", delete, "remove-level", path));
  return head;
}

static void add_level(GtkBox *box, SporeEditorDocument *document, SporeObject *level, GPtrArray *rows) {
  g_autofree char *path = spore_object_path(level);
  const SporeObjectType *type = spore_object_type(level);
  gtk_container_add(GTK_CONTAINER(box), new_head(level, path));
  for (guint i = 0; i < type->table->count; i++) {
    GtkWidget *row = spore_property_row_new(document, path, type, i);
    gtk_container_add(GTK_CONTAINER(box), row);
    g_ptr_array_add(rows, row);
  }
}

void spore_add_level_list(GtkBox *box, SporeEditorDocument *document, const SporeObject *body, GPtrArray *rows) {
  const SporeObject *fidelity = spore_object_child_of(body, "fidelity");
  for (guint i = 0; fidelity && i < spore_object_child_count(fidelity); i++)
    add_level(box, document, spore_object_child(fidelity, i), rows);
  GtkWidget *buttons = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6);
  gtk_container_add(GTK_CONTAINER(buttons),
                    spore_action_button_new(_("Add coarse level"), "win.add-level::coarse",
                                            _("The body once more, with about a quarter of its degrees of freedom")));
  gtk_container_add(GTK_CONTAINER(buttons),
                    spore_action_button_new(_("Add medium level"), "win.add-level::medium",
                                            _("The body once more, with about half of its degrees of freedom")));
  gtk_container_add(GTK_CONTAINER(box), buttons);
}
