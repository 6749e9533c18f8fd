/* Repeats a run from what moved it, and films it. */
#include "ui/jobs/film-work.h"

#include "ui/jobs/under-way.h"

#define WIDTH 1280 /* of each run's picture, pixels */
#define HEIGHT 720
#define FPS 30

SporeFilmWork *spore_film_work_new(const SporeDocument *document, const char *file, SporeTrack *input,
                                   SporeTrack *beside, double end_s, double speed) {
  SporeFilmWork *work = g_new0(SporeFilmWork, 1);
  spore_work_begin();
  work->document = spore_document_copy(document);
  work->file = g_strdup(file);
  work->input = input, work->beside = beside;
  work->end_s = end_s, work->speed = speed;
  return work;
}

/* The last word of the progress: to ask whether to go on is to repeat it. */
typedef struct Told {
  const SporeProgress *progress;
  double fraction;
} Told;

static bool tell(void *data, double fraction, const char *stage) {
  Told *told = data;
  told->fraction = fraction;
  return spore_progress(told->progress, fraction, stage);
}

static bool is_cancelled(void *data) {
  const Told *told = data;
  return !spore_progress(told->progress, told->fraction, NULL);
}

gboolean spore_film_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeFilmWork *work = data;
  Told told = {progress, 0};
  const SporeProgress telling = {.report = tell, .data = &told};
  const SporeCancel cancel = {is_cancelled, &told};
  const SporeTrack *const inputs[SPORE_FILMING_MOST] = {work->input, work->beside};
  SporeFilming filming = {.file = work->file,
                          .width = WIDTH,
                          .height = HEIGHT,
                          .to_s = work->end_s,
                          .fps = FPS,
                          .speed = work->speed,
                          .shown = {.surfaces = TRUE},
                          .cancel = &cancel};
  gboolean made = TRUE;
  for (guint runs = work->beside ? 2 : 1; made && filming.count < runs; filming.count += made) {
    filming.documents[filming.count] = work->document;
    filming.simulations[filming.count] =
        spore_simulation_new(work->document, NULL, inputs[filming.count], &cancel, error);
    made = filming.simulations[filming.count] != NULL;
  }
  gboolean done = made && spore_filming_run(&filming, &telling, &work->filmed, error);
  for (guint i = 0; i < filming.count; i++) spore_simulation_free(filming.simulations[i]);
  return done;
}

static void free_track(SporeTrack *track) {
  if (track) spore_track_clear(track);
  g_free(track);
}

void spore_film_work_free(gpointer data) {
  SporeFilmWork *work = data;
  spore_document_free(work->document);
  free_track(work->input);
  free_track(work->beside);
  g_free(work->filmed.gl_renderer);
  g_free(work->file);
  g_free(work);
  spore_work_end();
}
