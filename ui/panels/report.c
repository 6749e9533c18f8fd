/* Small services that panels share: actions, errors, figures in words, and layout. */
#include "ui/panels/report.h"

#include <glib/gi18n.h>

#include "ui/document/labels.h"

void spore_activate(GtkWidget *widget, const char *name, GVariant *parameter) {
  GActionGroup *group = gtk_widget_get_action_group(widget, "win");
  GtkWidget *window = gtk_widget_get_toplevel(widget);
  if (!group && G_IS_ACTION_GROUP(window)) group = G_ACTION_GROUP(window);
  g_autoptr(GVariant) taken = parameter ? g_variant_ref_sink(parameter) : NULL;
  if (group) g_action_group_activate_action(group, name, taken);
}

void spore_report(GtkWidget *widget, const GError *error) {
  spore_activate(widget, "report", g_variant_new_string(error->message));
}

void spore_box_fit(GtkBox *box, int width) {
  g_autoptr(GList) children = gtk_container_get_children(GTK_CONTAINER(box));
  int needed = -gtk_box_get_spacing(box);
  for (GList *child = children; child; child = child->next) {
    int least;
    gtk_widget_get_preferred_width(child->data, &least, NULL);
    if (gtk_widget_get_visible(child->data)) needed += least + gtk_box_get_spacing(box);
  }
  gtk_orientable_set_orientation(GTK_ORIENTABLE(box),
                                 needed <= width ? GTK_ORIENTATION_HORIZONTAL : GTK_ORIENTATION_VERTICAL);
}

void spore_combo_shrinks(GtkWidget *combo, int least_chars, int most_chars) {
  g_autoptr(GList) cells = gtk_cell_layout_get_cells(GTK_CELL_LAYOUT(combo));
  g_object_set(cells->data, "ellipsize", PANGO_ELLIPSIZE_END, "width-chars", least_chars, "max-width-chars", most_chars,
               NULL);
}

/* The event stops here without being handled, so that the parent gets it. */
static gboolean pass_on(GtkWidget *widget, GdkEventScroll *event, gpointer data) {
  g_signal_stop_emission_by_name(widget, "scroll-event");
  return GDK_EVENT_PROPAGATE;
}

void spore_ignore_wheel(GtkWidget *widget) { g_signal_connect(widget, "scroll-event", G_CALLBACK(pass_on), NULL); }

static gboolean show_none(GtkSpinButton *spin, gpointer data) {
  if (gtk_spin_button_get_value(spin) != 0) return FALSE;
  if (*gtk_entry_get_text(GTK_ENTRY(spin))) gtk_entry_set_text(GTK_ENTRY(spin), "");
  return TRUE;
}

void spore_spin_shows_none(GtkWidget *spin) {
  gtk_entry_set_placeholder_text(GTK_ENTRY(spin), "–");
  g_signal_connect(spin, "output", G_CALLBACK(show_none), NULL);
}

char *spore_label_of(const char *name) {
  g_autofree char *label = spore_label_of_name(name);
  return g_strdup(_(label));
}

char *spore_choice_label(const char *choice) {
  return spore_name_is_word(choice) ? spore_label_of(choice) : g_strdup(choice);
}

gboolean spore_unit_is_angle(const char *unit) { return g_str_equal(unit, "rad") || g_str_equal(unit, "rad/s"); }

gboolean spore_unit_is_flow(const char *unit) { return g_str_equal(unit, "m^3/s"); }

double spore_unit_scale(const char *unit) {
  if (spore_unit_is_flow(unit)) return 60e6;
  return g_str_equal(unit, "m") ? 1e3 : spore_unit_is_angle(unit) ? 180 / G_PI : 1;
}

char *spore_unit_label(const char *unit) {
  GString *label = g_string_new(g_str_equal(unit, "m") ? "mm" : spore_unit_is_flow(unit) ? "ml/min" : unit);
  if (spore_unit_is_angle(unit)) g_string_replace(label, "rad", "°", 0);
  g_string_replace(label, "^2", "²", 0);
  g_string_replace(label, "^3", "³", 0);
  return g_string_free(label, FALSE);
}

char *spore_value_text(const SporeParameter *parameter, const SporeValue *value) {
  int length = spore_parameter_format(parameter, value, NULL, 0);
  char *text = g_malloc((gsize)MAX(length, 0) + 1);
  text[0] = '\0';
  spore_parameter_format(parameter, value, text, (gsize)MAX(length, 0) + 1);
  return text;
}
