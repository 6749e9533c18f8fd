/* Keeps the input of an attempt: as text, minutes of it take longer than a frame. */
#include "ui/jobs/track-work.h"

#include "core/scene/compile.h"
#include "ui/jobs/under-way.h"

SporeTrackWork *spore_track_work_new(const char *scene, const SporeAttempt *attempt, SporeTrack *input) {
  SporeTrackWork *work = g_new0(SporeTrackWork, 1);
  spore_work_begin();
  work->scene = g_strdup(scene);
  work->attempt = *attempt;
  work->input = input;
  return work;
}

gboolean spore_track_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  const SporeTrackWork *work = data;
  return spore_attempts_add_track(work->scene, &work->attempt, work->input, error);
}

void spore_track_work_free(gpointer data) {
  SporeTrackWork *work = data;
  spore_input_free(work->input);
  g_free(work->scene);
  g_free(work);
  spore_work_end();
}
