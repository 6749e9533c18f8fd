/* The box of one generator in the inspector: the number, Generate, and the quality of the result. */
#include "ui/panels/spore-generator-box.h"

#include <glib/gi18n.h>

#include "ui/panels/report.h"

struct _SporeGeneratorBox {
  GtkBox parent;
  GtkWidget *label, *count, *button, *result, *remarks, *tools, *freeze;
  guint known;          /* last count of the document */
  char *action, *asset; /* asset: path of what is there, or NULL */
  gboolean filling;
};

G_DEFINE_FINAL_TYPE(SporeGeneratorBox, spore_generator_box, GTK_TYPE_BOX)

static void generate(GtkWidget *widget, SporeGeneratorBox *self) {
  if (self->filling) return;
  guint count = (guint)gtk_spin_button_get_value_as_int(GTK_SPIN_BUTTON(self->count));
  spore_activate(GTK_WIDGET(self), self->action, g_variant_new_uint32(count));
}

static void freeze_toggled(GtkToggleButton *button, SporeGeneratorBox *self) {
  if (self->filling || !self->asset) return;
  if (gtk_toggle_button_get_active(button))
    spore_activate(GTK_WIDGET(self), "set-property", g_variant_new("(sss)", self->asset, "frozen", "true"));
  else spore_activate(GTK_WIDGET(self), "unset-property", g_variant_new("(ss)", self->asset, "frozen"));
}

static void spore_generator_box_finalize(GObject *object) {
  g_free(SPORE_GENERATOR_BOX(object)->action);
  g_free(SPORE_GENERATOR_BOX(object)->asset);
  G_OBJECT_CLASS(spore_generator_box_parent_class)->finalize(object);
}

static void spore_generator_box_class_init(SporeGeneratorBoxClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->finalize = spore_generator_box_finalize;
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-generator-box.ui");
  gtk_widget_class_bind_template_child(widget, SporeGeneratorBox, label);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorBox, count);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorBox, button);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorBox, result);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorBox, remarks);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorBox, tools);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorBox, freeze);
  gtk_widget_class_bind_template_callback(widget, generate);
  gtk_widget_class_bind_template_callback(widget, freeze_toggled);
}

static void spore_generator_box_init(SporeGeneratorBox *self) {
  gtk_widget_init_template(GTK_WIDGET(self));
  spore_ignore_wheel(self->count);
}

GtkWidget *spore_generator_box_new(const char *action, const char *label, guint count, guint maximum) {
  SporeGeneratorBox *self = g_object_new(SPORE_TYPE_GENERATOR_BOX, NULL);
  self->action = g_strdup(action);
  gtk_label_set_text(GTK_LABEL(self->label), label);
  gtk_spin_button_set_range(GTK_SPIN_BUTTON(self->count), MIN(count, 1), maximum);
  if (!count) spore_spin_shows_none(self->count);
  gtk_spin_button_set_increments(GTK_SPIN_BUTTON(self->count), 10, 100);
  gtk_spin_button_set_value(GTK_SPIN_BUTTON(self->count), count);
  g_signal_connect(self->count, "value-changed", G_CALLBACK(generate), self);
  return GTK_WIDGET(self);
}

static void set_class(GtkWidget *widget, const char *name, gboolean has) {
  GtkStyleContext *style = gtk_widget_get_style_context(widget);
  if (has) gtk_style_context_add_class(style, name);
  else gtk_style_context_remove_class(style, name);
}

void spore_generator_box_set_result(SporeGeneratorBox *self, const char *text, SporeGeneratorState state) {
  gtk_label_set_text(GTK_LABEL(self->result), text);
  gtk_label_set_text(GTK_LABEL(self->remarks), state.remarks);
  gtk_widget_set_visible(self->remarks, *state.remarks != '\0');
  gtk_button_set_label(GTK_BUTTON(self->button), state.stale ? _("Regenerate") : _("Generate"));
  g_free(self->asset);
  self->asset = g_strdup(state.asset);
  self->filling = TRUE;
  gtk_toggle_button_set_active(GTK_TOGGLE_BUTTON(self->freeze), state.frozen);
  if (state.count && state.count != self->known) gtk_spin_button_set_value(GTK_SPIN_BUTTON(self->count), state.count);
  self->known = state.count;
  self->filling = FALSE;
  gtk_widget_set_no_show_all(self->tools, TRUE);
  gtk_widget_set_visible(self->tools, state.generated);
  gtk_widget_set_sensitive(self->button, !state.frozen);
  gtk_widget_set_sensitive(self->count, !state.frozen);
  set_class(self->button, "suggested-action", state.stale);
  set_class(self->remarks, "stale", state.stale);
}
