/* Which model moves a body, and which preset of it has the model's values. */
#ifndef SPORE_UI_PANELS_SPORE_MODEL_CHOICE_H
#define SPORE_UI_PANELS_SPORE_MODEL_CHOICE_H

#include <gtk/gtk.h>

#include "core/scene/document.h"

G_BEGIN_DECLS

#define SPORE_TYPE_MODEL_CHOICE spore_model_choice_get_type()
G_DECLARE_FINAL_TYPE(SporeModelChoice, spore_model_choice, SPORE, MODEL_CHOICE, GtkBox)

/* A choice of all models. */
GtkWidget *spore_model_choice_new(const SporeSchema *schema);
/* A choice of the presets of a type of model; NULL: it has none. */
GtkWidget *spore_model_choice_new_of_presets(const SporeModelType *type);
/* model: of the body, or NULL. */
void spore_model_choice_set_model(SporeModelChoice *self, SporeObject *model);

G_END_DECLS
#endif
