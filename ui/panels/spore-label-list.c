/* The list of the organs of a label map, with a choice of those that are wanted. */
#include "ui/panels/spore-label-list.h"

#include <glib/gi18n.h>

struct _SporeLabelList {
  GtkBox parent;
  SporeLabelSource *source; /* label map of the checks; NULL: none yet */
  GPtrArray *checks;
  gboolean filling;
};

G_DEFINE_FINAL_TYPE(SporeLabelList, spore_label_list, GTK_TYPE_BOX)

enum { CHANGED, SIGNAL_COUNT };
static guint signals[SIGNAL_COUNT];

static void toggled(SporeLabelList *self) {
  if (!self->filling) g_signal_emit(self, signals[CHANGED], 0);
}

static void destroy_child(GtkWidget *child, gpointer data) { gtk_widget_destroy(child); }

static void build(SporeLabelList *self, SporeLabelSource *source) {
  gtk_container_foreach(GTK_CONTAINER(self), destroy_child, NULL);
  g_ptr_array_set_size(self->checks, 0);
  g_clear_pointer(&self->source, spore_label_source_unref);
  self->source = spore_label_source_ref(source);
  for (gsize i = 0; i < spore_label_source_count(source); i++) {
    g_autofree char *name = spore_label_source_name(source, i);
    const double millilitres = 1e6 * spore_label_source_volume(source, i);
    g_autofree char *text = spore_label_source_is_guessed(source, i)
                                ? g_strdup_printf(_("%s (guessed), %.3g ml"), name, millilitres)
                                : g_strdup_printf(_("%s, %.3g ml"), name, millilitres);
    GtkWidget *check = gtk_check_button_new_with_label(text);
    gtk_widget_set_tooltip_text(check, _("Whether this organ is meshed; the rest counts as nothing"));
    g_signal_connect_swapped(check, "toggled", G_CALLBACK(toggled), self);
    gtk_container_add(GTK_CONTAINER(self), check);
    g_ptr_array_add(self->checks, check);
  }
  gtk_widget_show_all(GTK_WIDGET(self));
}

void spore_label_list_set_options(SporeLabelList *self, const SporeGenerateOptions *options) {
  self->filling = TRUE;
  if (self->source != options->labels) build(self, options->labels);
  for (guint i = 0; i < self->checks->len; i++)
    gtk_toggle_button_set_active(self->checks->pdata[i], spore_generate_wants_label(options, i));
  self->filling = FALSE;
}

void spore_label_list_get_options(SporeLabelList *self, SporeGenerateOptions *options) {
  for (guint i = 0; self->source == options->labels && i < self->checks->len; i++)
    spore_generate_want_label(options, i, gtk_toggle_button_get_active(self->checks->pdata[i]));
}

static void spore_label_list_finalize(GObject *object) {
  SporeLabelList *self = SPORE_LABEL_LIST(object);
  g_clear_pointer(&self->source, spore_label_source_unref);
  g_ptr_array_unref(self->checks);
  G_OBJECT_CLASS(spore_label_list_parent_class)->finalize(object);
}

static void spore_label_list_class_init(SporeLabelListClass *class) {
  G_OBJECT_CLASS(class)->finalize = spore_label_list_finalize;
  signals[CHANGED] =
      g_signal_new("changed", G_TYPE_FROM_CLASS(class), G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
}

static void spore_label_list_init(SporeLabelList *self) {
  self->checks = g_ptr_array_new();
  gtk_orientable_set_orientation(GTK_ORIENTABLE(self), GTK_ORIENTATION_VERTICAL);
}
