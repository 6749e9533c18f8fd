/* Repeats a run from what moved it, and films it. */
#include "ui/jobs/film-work.h"

#include "ui/document/attempts.h"
#include "ui/jobs/under-way.h"
#include "ui/jobs/work-place.h"

#define WIDTH 1280 /* of each run's picture, pixels */
#define HEIGHT 720
#define FPS 30

SporeFilmWork *spore_film_work_new(const SporeDocument *document, const char *file, double end_s, double speed) {
  SporeFilmWork *work = g_new0(SporeFilmWork, 1);
  spore_work_begin();
  work->document = spore_document_copy(document);
  work->file = g_strdup(file);
  work->end_s = end_s, work->speed = speed;
  return work;
}

void spore_film_work_add(SporeFilmWork *work, SporeTrack *input, char *input_file) {
  g_return_if_fail(work->count < SPORE_FILMING_MOST);
  work->inputs[work->count] = input;
  work->input_files[work->count++] = input_file;
}

/* Prepares the runs. *filming has those that were prepared, whatever happens. */
static gboolean prepare(SporeFilmWork *work, SporeFilming *filming, GError **error) {
  for (guint run = 0; run < work->count; run++) {
    const char *file = work->input_files[run];
    if (file && !(work->inputs[run] = spore_attempts_read_track(file, error))) return FALSE;
    SporeSimulation *simulation = spore_simulation_new(work->document, NULL, work->inputs[run], filming->cancel, error);
    if (!simulation) return FALSE;
    filming->documents[run] = work->document;
    filming->simulations[run] = simulation;
    filming->count++;
  }
  return TRUE;
}

gboolean spore_film_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeFilmWork *work = data;
  SporeWorkPlace place;
  spore_work_place_init(&place, progress);
  SporeFilming filming = {.file = work->file,
                          .width = WIDTH,
                          .height = HEIGHT,
                          .to_s = work->end_s,
                          .fps = FPS,
                          .speed = work->speed,
                          .shown = {.surfaces = TRUE},
                          .cancel = &place.cancel};
  gboolean done = prepare(work, &filming, error) && spore_filming_run(&filming, &place.progress, &work->filmed, error);
  for (guint i = 0; i < filming.count; i++) spore_simulation_free(filming.simulations[i]);
  return done;
}

void spore_film_work_free(gpointer data) {
  SporeFilmWork *work = data;
  spore_document_free(work->document);
  for (guint i = 0; i < work->count; i++) {
    spore_input_free(work->inputs[i]);
    g_free(work->input_files[i]);
  }
  g_free(work->filmed.gl_renderer);
  g_free(work->file);
  g_free(work);
  spore_work_end();
}
