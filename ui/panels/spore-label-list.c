/* The list of the organs of a label map, with a choice of what becomes of each. */
#include "ui/panels/spore-label-list.h"

#include <glib/gi18n.h>

#include "core/author/anatomy.h"
#include "core/author/label_choice.h"
#include "ui/panels/report.h"

#define CHOICE_LEAST_CHARS 4
#define CHOICE_CHARS 8

struct _SporeLabelList {
  GtkBox parent;
  SporeLabelSource *source; /* label map of the rows; NULL: none yet */
  GPtrArray *combos;
  gboolean filling;
};

G_DEFINE_FINAL_TYPE(SporeLabelList, spore_label_list, GTK_TYPE_BOX)

enum { CHANGED, SIGNAL_COUNT };
static guint signals[SIGNAL_COUNT];

static void chosen(SporeLabelList *self) {
  if (!self->filling) g_signal_emit(self, signals[CHANGED], 0);
}

static void destroy_child(GtkWidget *child, gpointer data) { gtk_widget_destroy(child); }

static gboolean draw_colour(GtkWidget *area, cairo_t *cr, gpointer data) {
  const GdkRGBA *colour = g_object_get_data(G_OBJECT(area), "colour");
  gdk_cairo_set_source_rgba(cr, colour);
  cairo_paint(cr);
  return TRUE;
}

static GtkWidget *new_colour(const char *name, guint16 label) {
  double colour[3];
  GtkWidget *area = gtk_drawing_area_new();
  spore_anatomy_colour(name, label, colour);
  const GdkRGBA rgba = {colour[0], colour[1], colour[2], 1};
  g_object_set_data_full(G_OBJECT(area), "colour", gdk_rgba_copy(&rgba), (GDestroyNotify)gdk_rgba_free);
  g_signal_connect(area, "draw", G_CALLBACK(draw_colour), NULL);
  gtk_widget_set_size_request(area, 12, 12);
  gtk_widget_set_valign(area, GTK_ALIGN_CENTER);
  return area;
}

static char *text_of(const SporeLabelSource *source, gsize i, const char *name) {
  double size[3];
  spore_label_source_size(source, i, size);
  return g_strdup_printf(spore_label_source_is_guessed(source, i) ? _("%s (guessed), %.3g ml, %.0f × %.0f × %.0f mm")
                                                                  : _("%s, %.3g ml, %.0f × %.0f × %.0f mm"),
                         name, 1e6 * spore_label_source_volume(source, i), 1e3 * size[0], 1e3 * size[1], 1e3 * size[2]);
}

/* As SporeLabelChoice counts them. */
static GtkWidget *new_choice(SporeLabelList *self, const char *name) {
  GtkWidget *combo = gtk_combo_box_text_new();
  gtk_combo_box_text_append_text(GTK_COMBO_BOX_TEXT(combo), _("Soft"));
  gtk_combo_box_text_append_text(GTK_COMBO_BOX_TEXT(combo), _("Around"));
  gtk_combo_box_text_append_text(GTK_COMBO_BOX_TEXT(combo), _("Leave out"));
  gtk_widget_set_tooltip_text(combo, _("Soft: tetrahedra that move; around: an unmovable surface; left out: nothing"));
  atk_object_set_name(gtk_widget_get_accessible(combo), name);
  g_signal_connect_swapped(combo, "changed", G_CALLBACK(chosen), self);
  spore_combo_shrinks(combo, CHOICE_LEAST_CHARS, CHOICE_CHARS);
  spore_ignore_wheel(combo);
  return combo;
}

static void add_row(SporeLabelList *self, gsize i) {
  g_autofree char *name = spore_label_source_name(self->source, i), *text = text_of(self->source, i, name);
  GtkWidget *row = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6), *label = gtk_label_new(text);
  GtkWidget *combo = new_choice(self, name);
  gtk_label_set_ellipsize(GTK_LABEL(label), PANGO_ELLIPSIZE_END);
  gtk_label_set_xalign(GTK_LABEL(label), 0);
  gtk_widget_set_hexpand(label, TRUE);
  gtk_widget_set_tooltip_text(label, text);
  gtk_container_add(GTK_CONTAINER(row), new_colour(name, spore_label_source_label(self->source, i)));
  gtk_container_add(GTK_CONTAINER(row), label);
  gtk_container_add(GTK_CONTAINER(row), combo);
  gtk_container_add(GTK_CONTAINER(self), row);
  g_ptr_array_add(self->combos, combo);
}

static void build(SporeLabelList *self, SporeLabelSource *source) {
  gtk_container_foreach(GTK_CONTAINER(self), destroy_child, NULL);
  g_ptr_array_set_size(self->combos, 0);
  g_clear_pointer(&self->source, spore_label_source_unref);
  self->source = spore_label_source_ref(source);
  for (gsize i = 0; i < spore_label_source_count(source); i++) add_row(self, i);
  gtk_widget_show_all(GTK_WIDGET(self));
}

void spore_label_list_set_options(SporeLabelList *self, const SporeGenerateOptions *options) {
  self->filling = TRUE;
  if (self->source != options->labels) build(self, options->labels);
  for (guint i = 0; i < self->combos->len; i++)
    gtk_combo_box_set_active(self->combos->pdata[i], (int)spore_label_choice(options, i));
  self->filling = FALSE;
}

void spore_label_list_get_options(SporeLabelList *self, SporeGenerateOptions *options) {
  for (guint i = 0; self->source == options->labels && i < self->combos->len; i++)
    spore_label_choose(options, i, (SporeLabelChoice)MAX(gtk_combo_box_get_active(self->combos->pdata[i]), 0));
}

static void spore_label_list_finalize(GObject *object) {
  SporeLabelList *self = SPORE_LABEL_LIST(object);
  g_clear_pointer(&self->source, spore_label_source_unref);
  g_ptr_array_unref(self->combos);
  G_OBJECT_CLASS(spore_label_list_parent_class)->finalize(object);
}

static void spore_label_list_class_init(SporeLabelListClass *class) {
  G_OBJECT_CLASS(class)->finalize = spore_label_list_finalize;
  signals[CHANGED] =
      g_signal_new("changed", G_TYPE_FROM_CLASS(class), G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
}

static void spore_label_list_init(SporeLabelList *self) {
  self->combos = g_ptr_array_new();
  gtk_orientable_set_orientation(GTK_ORIENTABLE(self), GTK_ORIENTATION_VERTICAL);
}
