/* The inspector of several bodies: what is done to all of them, and the properties that are set for all at once. */
#ifndef SPORE_UI_PANELS_BATCH_H
#define SPORE_UI_PANELS_BATCH_H

#include "ui/document/spore-editor-document.h"
#include "ui/panels/spore-section-list.h"

/* Adds the sections. bodies: of SporeObject *, two or more. */
void spore_add_batch(SporeSectionList *sections, SporeEditorDocument *document, const GPtrArray *bodies);
/* "liver, spleen, uterus". g_free. */
char *spore_batch_names(const GPtrArray *bodies);
/* A button for an action of the window. */
GtkWidget *spore_action_button_new(const char *label, const char *action, const char *hint);
/* The button that makes what is selected soft. */
GtkWidget *spore_soft_button_new(void);

#endif
