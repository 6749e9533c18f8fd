/* A slider for what a step may cost, and what the scene gives up for it. */
#ifndef SPORE_UI_PANELS_SPORE_BUDGET_H
#define SPORE_UI_PANELS_SPORE_BUDGET_H

#include <gtk/gtk.h>

#include "ui/document/spore-editor-document.h"

G_BEGIN_DECLS

#define SPORE_TYPE_BUDGET spore_budget_get_type()
G_DECLARE_FINAL_TYPE(SporeBudgetBox, spore_budget, SPORE, BUDGET, GtkBox)

void spore_budget_set_document(SporeBudgetBox *self, SporeEditorDocument *document);

G_END_DECLS
#endif
