/* Keeping what a run shows as the beginning of the scene. No GTK. */
#ifndef SPORE_AUTHOR_POSE_EDITS_H
#define SPORE_AUTHOR_POSE_EDITS_H

#include "core/base/progress.h"
#include "core/scene/compile.h"

/* Keeping a pose as data: taken from a simulation, written by any thread, and then put into the document. */
typedef struct SporePoseWork SporePoseWork;
/* Takes what spore_edit_keep_pose keeps. NULL with a GError: there is nothing to keep. */
SporePoseWork *spore_pose_work_new(SporeDocument *document, const SporeSimulation *simulation, GError **error);
void spore_pose_work_free(gpointer work);
/* Makes the files. Nothing of the simulation is needed any more. */
gboolean spore_pose_work_run(gpointer work, const SporeProgress *progress, GError **error);
/* Keeps the poses, as one undo step; a body that is gone meanwhile is passed over. */
gboolean spore_pose_work_apply(SporePoseWork *work, SporeDocument *document, GError **error);
/* What is not kept, as of spore_edit_keep_pose; the work's own. */
const GPtrArray *spore_pose_work_left_out(const SporePoseWork *work);

/* Makes the present state of the simulation, whose thread stands still, the scene's beginning: each active and passive
 * body begins where it is, at rest; one undo step. A body that is where its model puts it keeps no pose. left_out: gets
 * a translated sentence (g_free) for each body whose state cannot be kept, which begins as before, and for each
 * instrument whose jaws hold something, which is let go. FALSE with a GError: there is no body that moved and can be
 * kept, and nothing was changed. */
gboolean spore_edit_keep_pose(SporeDocument *document, const SporeSimulation *simulation, const SporeProgress *progress,
                              GPtrArray *left_out, GError **error);
/* Runs a copy of the scene from its beginning for that time, and keeps what has become of it. */
gboolean spore_edit_keep_pose_after(SporeDocument *document, double time_s, const SporeCancel *cancel,
                                    const SporeProgress *progress, GPtrArray *left_out, GError **error);
/* Lets all bodies begin as their geometry says again, as one undo step. */
gboolean spore_edit_forget_pose(SporeDocument *document, GError **error);

#endif
