/* Fixes of what checks find, as the diagnostics offer them. A fix is data, which any thread may run; one thread owns
 * the document. No GTK. */
#ifndef SPORE_AUTHOR_FIX_H
#define SPORE_AUTHOR_FIX_H

#include "core/base/progress.h"
#include "core/scene/check.h"

/* What the fix of the diagnostic does, for a button, translated. g_free; NULL: it has none. */
char *spore_fix_label(const SporeDiagnostic *diagnostic);
/* Whether the diagnostic has a fix that needs no answer, so that it can be done with all others at once. */
gboolean spore_fix_asks_nothing(const SporeDiagnostic *diagnostic);
/* Name of a kind of fix, for reports: "hold"; NULL: none. */
const char *spore_fix_name(SporeFix fix);

typedef struct SporeFixWork SporeFixWork;
/* The fix of the diagnostic. NULL with a GError: it has none that can be done without asking, or what it is about is
 * not there any more. */
SporeFixWork *spore_fix_work_new(SporeDocument *document, const SporeDiagnostic *diagnostic, GError **error);
void spore_fix_work_free(gpointer work);
/* Whether running it takes long: it generates something. */
gboolean spore_fix_work_is_long(const SporeFixWork *work);
gboolean spore_fix_work_run(gpointer work, const SporeProgress *progress, GError **error);
/* Does it, as one undo step. FALSE with a GError: nothing was changed. */
gboolean spore_fix_work_apply(const SporeFixWork *work, SporeDocument *document, GError **error);
/* Path of what it changes, as the document was when the fix was made. */
const char *spore_fix_work_path(const SporeFixWork *work);

#endif
