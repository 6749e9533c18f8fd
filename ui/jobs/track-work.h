/* Keeps the input of an attempt in a file, as data for a SporeJob. It counts as under way (ui/jobs/under-way.h). No
 * GTK.
 */
#ifndef SPORE_UI_JOBS_TRACK_WORK_H
#define SPORE_UI_JOBS_TRACK_WORK_H

#include "core/base/progress.h"
#include "ui/document/attempts.h"

typedef struct SporeTrackWork {
  char *scene; /* its file */
  SporeAttempt attempt;
  SporeTrack *input; /* owned */
} SporeTrackWork;

/* Takes the input. */
SporeTrackWork *spore_track_work_new(const char *scene, const SporeAttempt *attempt, SporeTrack *input);
gboolean spore_track_work_run(gpointer work, const SporeProgress *progress, GError **error);
void spore_track_work_free(gpointer work);

#endif
