/* A generator at work before its result is applied. It runs again when its options change, and the document does not
 * change until Apply. One runs at a time.
 *
 * Signals
 *   changed ()           anything below may have; on the GTK thread, at most ten times a second while it works
 *   failed (s message)   there is no result; not when it was cancelled. The preview has ended, unless its generator has
 *                        places to pick or labels to choose, which may be chosen otherwise then
 *   applied ()           the document has the result, which can still be read during the call                      */
#ifndef SPORE_UI_JOBS_SPORE_GENERATOR_H
#define SPORE_UI_JOBS_SPORE_GENERATOR_H

#include "ui/document/spore-editor-document.h"
#include "ui/jobs/spore-job.h"
#include "ui/jobs/works.h"

G_BEGIN_DECLS

#define SPORE_TYPE_GENERATOR spore_generator_get_type()
G_DECLARE_FINAL_TYPE(SporeGenerator, spore_generator, SPORE, GENERATOR, GObject)

SporeGenerator *spore_generator_new(SporeEditorDocument *document);
/* Begins a preview, or goes on with other options: the last run is dropped, and several calls in a row make one run.
 * FALSE: the body shows no mesh, or its asset is frozen. body NULL: the options name a file. */
gboolean spore_generator_preview(SporeGenerator *self, SporeObject *body, const SporeGenerateOptions *options,
                                 GError **error);
/* Goes on from a label map that was only listed: what was chosen is made. */
void spore_generator_make(SporeGenerator *self);
/* Applies the result as soon as there is one. */
void spore_generator_apply_when_done(SporeGenerator *self);
/* Gives the result to the body, as one undo step, and ends the preview. What was only listed is made first. FALSE:
 * there is no result yet, or it does not fit the document any more; the preview goes on. */
gboolean spore_generator_apply(SporeGenerator *self, GError **error);
/* Ends the preview at once; the document stays as it was. */
void spore_generator_cancel(SporeGenerator *self);

SporeDocument *spore_generator_get_document(SporeGenerator *self);
gboolean spore_generator_is_active(SporeGenerator *self);    /* working, or with a result that waits */
gboolean spore_generator_is_working(SporeGenerator *self);   /* or about to */
SporeObject *spore_generator_get_body(SporeGenerator *self); /* NULL: not active, or of a file */
const SporeGenerateOptions *spore_generator_get_options(SporeGenerator *self); /* when active */
const SporeGenerateWork *spore_generator_get_result(SporeGenerator *self);     /* NULL: none with these options */
/* Why a preview that goes on has no result; NULL: it has not failed. */
const char *spore_generator_get_refusal(SporeGenerator *self);
SporeJob *spore_generator_get_job(SporeGenerator *self); /* NULL: does not run */

G_END_DECLS
#endif
