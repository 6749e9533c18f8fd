/* Recorded input that is kept in a scene. No GTK. */
#ifndef SPORE_AUTHOR_TRACK_EDITS_H
#define SPORE_AUTHOR_TRACK_EDITS_H

#include "core/haptic/track.h"
#include "core/scene/document.h"

/* Keeps the recording as a track of the scene, as one undo step: its file is saved with the scene, and each tool whose
 * body was recorded is led by it from then on. Returns the track. NULL with a GError: nothing was recorded. */
SporeObject *spore_edit_keep_track(SporeDocument *document, const SporeTrack *recording, GError **error);

#endif
