/* The choice of the model that moves a body, and of its preset. */
#include "ui/panels/spore-model-choice.h"

#include <glib/gi18n.h>

#include "ui/panels/report.h"

struct _SporeModelChoice {
  GtkBox parent;
  GtkWidget *combo;
  const char *action;         /* of the window, takes the choice */
  const SporePreset *presets; /* NULL: the choice is of models */
  gboolean filling;
};

G_DEFINE_FINAL_TYPE(SporeModelChoice, spore_model_choice, GTK_TYPE_BOX)

/* "No model" can be chosen; "own values" cannot. */
static void chosen(GtkComboBox *combo, SporeModelChoice *self) {
  const char *id = gtk_combo_box_get_active_id(combo);
  if (id && !self->filling && (*id || !self->presets))
    spore_activate(GTK_WIDGET(self), self->action, g_variant_new_string(id));
}

static SporeModelChoice *new_choice(const char *text, const char *action, const char *none) {
  SporeModelChoice *self = g_object_new(SPORE_TYPE_MODEL_CHOICE, "spacing", 6, NULL);
  GtkWidget *label = gtk_label_new(text);
  self->action = action;
  self->combo = gtk_combo_box_text_new();
  spore_ignore_wheel(self->combo);
  gtk_label_set_xalign(GTK_LABEL(label), 0);
  gtk_label_set_mnemonic_widget(GTK_LABEL(label), self->combo);
  gtk_widget_set_hexpand(label, TRUE);
  gtk_style_context_add_class(gtk_widget_get_style_context(GTK_WIDGET(self)), "generator");
  gtk_container_add(GTK_CONTAINER(self), label);
  gtk_container_add(GTK_CONTAINER(self), self->combo);
  gtk_combo_box_text_append(GTK_COMBO_BOX_TEXT(self->combo), "", none);
  g_signal_connect(self->combo, "changed", G_CALLBACK(chosen), self);
  return self;
}

GtkWidget *spore_model_choice_new(const SporeSchema *schema) {
  SporeModelChoice *self = new_choice(_("Model"), "set-model", _("None"));
  for (SporeModelRegistry registry = spore_schema_registry(schema); *registry; registry++)
    gtk_combo_box_text_append(GTK_COMBO_BOX_TEXT(self->combo), (*registry)->name, _((*registry)->label));
  return GTK_WIDGET(self);
}

GtkWidget *spore_model_choice_new_of_presets(const SporeModelType *type) {
  if (!type->presets) return NULL;
  SporeModelChoice *self = new_choice(_("Preset"), "use-preset", _("Own values"));
  self->presets = type->presets;
  for (const SporePreset *preset = type->presets; preset->name; preset++) {
    g_autofree char *text = g_strdup_printf("%s (%s)", _(preset->label), preset->source);
    gtk_combo_box_text_append(GTK_COMBO_BOX_TEXT(self->combo), preset->name, text);
  }
  return GTK_WIDGET(self);
}

/* Whether the model has the preset's values. */
static gboolean has_preset(SporeObject *model, const SporePreset *preset) {
  const SporeParameterTable *table = spore_object_type(model)->table;
  gboolean same = TRUE;
  for (const char *const *setting = preset->settings; *setting && same; setting += 2) {
    SporeValue value = {0};
    int index = spore_parameter_find(table, setting[0]);
    same = index >= 0 && spore_parameter_parse(&table->parameters[index], setting[1], &value, NULL) &&
           spore_value_equal(&value, spore_object_value(model, (guint)index));
    spore_value_clear(&value);
  }
  return same;
}

static const char *preset_of(const SporePreset *preset, SporeObject *model) {
  while (preset->name && !has_preset(model, preset)) preset++;
  return preset->name ? preset->name : "";
}

void spore_model_choice_set_model(SporeModelChoice *self, SporeObject *model) {
  const char *id = "";
  if (model) id = self->presets ? preset_of(self->presets, model) : spore_object_type(model)->element;
  self->filling = TRUE;
  gtk_combo_box_set_active_id(GTK_COMBO_BOX(self->combo), id);
  self->filling = FALSE;
}

static void spore_model_choice_class_init(SporeModelChoiceClass *class) {}

static void spore_model_choice_init(SporeModelChoice *self) {}
