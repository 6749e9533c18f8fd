/* What a step of the scene consists of, what is left out, why, and what each costs or saves. */
#ifndef SPORE_UI_PANELS_SPORE_PLAN_H
#define SPORE_UI_PANELS_SPORE_PLAN_H

#include <gtk/gtk.h>

#include "ui/document/spore-editor-document.h"

G_BEGIN_DECLS

#define SPORE_TYPE_PLAN spore_plan_get_type()
G_DECLARE_FINAL_TYPE(SporePlanPanel, spore_plan, SPORE, PLAN, GtkBox)

/* The plan is made when the panel is shown, and again after the scene has changed. */
void spore_plan_set_document(SporePlanPanel *self, SporeEditorDocument *document);
/* Writes the table that is shown, as CSV. */
gboolean spore_plan_save(SporePlanPanel *self, const char *file, GError **error);

G_END_DECLS
#endif
