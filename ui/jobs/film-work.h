/* A film of a run, as data for a SporeJob: the run is repeated from what moved it, and drawn without a window. It
 * counts as under way (ui/jobs/under-way.h). No GTK. */
#ifndef SPORE_UI_JOBS_FILM_WORK_H
#define SPORE_UI_JOBS_FILM_WORK_H

#include "core/base/progress.h"
#include "ui/export/export.h"
#include "ui/render/filming.h"

typedef struct SporeFilmWork {
  SporeDocument *document;                /* a copy of the scene, the worker's own */
  char *file;                             /* as spore_reel_kind */
  guint count;                            /* of runs, side by side */
  SporeTrack *inputs[SPORE_FILMING_MOST]; /* what moved each, owned; NULL: read from the file */
  char *input_files[SPORE_FILMING_MOST];  /* NULL: none, the input is there */
  double end_s, speed, fps;               /* as SporeFilming has them */
  SporeFilmed filmed;                     /* out */
} SporeFilmWork;

/* Formats of pictures beside those of spore_export_formats; they have no function that writes, since a film work does.
 * The last has no name. */
extern const SporeExportFormat spore_film_formats[];
/* The pattern of a row of pictures in that format, or the file; g_free. */
char *spore_film_file(const SporeExportFormat *format, const char *file);

/* No run yet, and 30 pictures a second. */
SporeFilmWork *spore_film_work_new(const SporeDocument *document, const char *file, double end_s, double speed);
/* Adds a run, of this input or of that in the file; takes either. */
void spore_film_work_add(SporeFilmWork *work, SporeTrack *input, char *input_file);
gboolean spore_film_work_run(gpointer work, const SporeProgress *progress, GError **error);
void spore_film_work_free(gpointer work);
/* What was written, in words, with markup. g_free. */
char *spore_film_work_report(const SporeFilmWork *work);

#endif
