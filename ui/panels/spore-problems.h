/* What is wrong with the scene, and what its run had to mend. Signal: checked (GPtrArray *diagnostics, borrowed).
 * A button beneath the list does win.fix where the selected problem has a fix. */
#ifndef SPORE_UI_PANELS_SPORE_PROBLEMS_H
#define SPORE_UI_PANELS_SPORE_PROBLEMS_H

#include <gtk/gtk.h>

#include "core/scene/check.h"
#include "ui/document/spore-editor-document.h"

G_BEGIN_DECLS

#define SPORE_TYPE_PROBLEMS spore_problems_get_type()
G_DECLARE_FINAL_TYPE(SporeProblems, spore_problems, SPORE, PROBLEMS, GtkBox)

void spore_problems_set_document(SporeProblems *self, SporeEditorDocument *document);
/* A message of the monitor, "BODY: what happened; what to do", translated. */
void spore_problems_add_run(SporeProblems *self, guint64 step, const char *text);
void spore_problems_clear_run(SporeProblems *self);
/* The selected problem; NULL: none is. Borrowed until the next check. */
const SporeDiagnostic *spore_problems_selected(SporeProblems *self);
/* A problem with a fix that the text tells of; NULL: none is. Borrowed likewise. */
const SporeDiagnostic *spore_problems_fixable(SporeProblems *self, const char *text);

G_END_DECLS
#endif
