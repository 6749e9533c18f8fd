/* Keeping what a run shows as the beginning of the scene. No GTK. */
#ifndef SPORE_AUTHOR_POSE_EDITS_H
#define SPORE_AUTHOR_POSE_EDITS_H

#include "core/base/progress.h"
#include "core/scene/compile.h"

/* Makes the present state of the simulation, whose thread stands still, the scene's beginning: each active and passive
 * body begins where it is, at rest; one undo step. A body that is where its model puts it keeps no pose. left_out: gets
 * a translated sentence (g_free) for each body whose state cannot be kept, which begins as before, and for each
 * instrument whose jaws hold something, which is let go. FALSE with a GError: there is no body that moved and can be
 * kept, and nothing was changed. */
gboolean spore_edit_keep_pose(SporeDocument *document, const SporeSimulation *simulation, GPtrArray *left_out,
                              GError **error);
/* Runs a copy of the scene from its beginning for that time, and keeps what has become of it. */
gboolean spore_edit_keep_pose_after(SporeDocument *document, double time_s, const SporeCancel *cancel,
                                    const SporeProgress *progress, GPtrArray *left_out, GError **error);
/* Lets all bodies begin as their geometry says again, as one undo step. */
gboolean spore_edit_forget_pose(SporeDocument *document, GError **error);

#endif
