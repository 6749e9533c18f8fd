/* Repeats a run from what moved it, and films it. */
#include "ui/jobs/film-work.h"

#include <glib/gi18n.h>
#include <string.h>

#include "ui/document/attempts.h"
#include "ui/jobs/under-way.h"
#include "ui/jobs/work-place.h"

#define WIDTH 1280 /* of each run's picture, pixels */
#define HEIGHT 720
#define FPS 30

#define NUMBERED "-%05d" /* what makes a name that of a row of pictures */

const SporeExportFormat spore_film_formats[] = {
    {.name = "webm",
     .moments = SPORE_EXPORT_SERIES,
     .suffix = ".webm",
     .label = N_("Film"),
     .doc = N_("the run as a film in WebM, seen through the scene's camera, as fast as in life")},
    {.name = "png-row",
     .moments = SPORE_EXPORT_SERIES,
     .suffix = ".png",
     .label = N_("Row of pictures"),
     .doc = N_("the run as numbered pictures in PNG, for a program that cuts films")},
    {.name = "png",
     .moments = SPORE_EXPORT_ONE_MOMENT,
     .suffix = ".png",
     .label = N_("Picture"),
     .doc = N_("one moment of the run in PNG, seen through the scene's camera")},
    {.name = NULL},
};

char *spore_film_file(const SporeExportFormat *format, const char *file) {
  SporeReelKind kind;
  if (!g_str_equal(format->name, "png-row") || !spore_reel_kind(file, &kind, NULL) || kind != SPORE_REEL_PICTURE)
    return g_strdup(file);
  g_autofree char *stem = g_strndup(file, strlen(file) - strlen(format->suffix));
  return g_strconcat(stem, NUMBERED, format->suffix, NULL);
}

SporeFilmWork *spore_film_work_new(const SporeDocument *document, const char *file, double end_s, double speed) {
  SporeFilmWork *work = g_new0(SporeFilmWork, 1);
  spore_work_begin();
  work->document = spore_document_copy(document);
  work->file = g_strdup(file);
  work->end_s = end_s, work->speed = speed, work->fps = FPS;
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
                          .fps = work->fps,
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
  g_free(work->filmed.legends);
  g_free(work->file);
  g_free(work);
  spore_work_end();
}

char *spore_film_work_report(const SporeFilmWork *work) {
  const SporeFilmed *filmed = &work->filmed;
  g_autofree char *size = g_strdup_printf("%d × %d", filmed->width, filmed->height);
  g_autofree char *line = filmed->length_s > 0
                              ? g_strdup_printf(_("%s: %llu pictures of %s, %.2f s"), work->file,
                                                (unsigned long long)filmed->pictures, size, filmed->length_s)
                              : g_strdup_printf(_("%s: a picture of %s"), work->file, size);
  return g_markup_printf_escaped("<b>%s</b>\n%s", _("Written"), line);
}
