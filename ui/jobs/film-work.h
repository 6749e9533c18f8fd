/* A film of a run, as data for a SporeJob: the run is repeated from what moved it, and drawn without a window. It
 * counts as under way (ui/jobs/under-way.h). No GTK. */
#ifndef SPORE_UI_JOBS_FILM_WORK_H
#define SPORE_UI_JOBS_FILM_WORK_H

#include "core/base/progress.h"
#include "ui/render/filming.h"

typedef struct SporeFilmWork {
  SporeDocument *document; /* a copy of the scene, the worker's own */
  char *file;              /* as spore_reel_kind */
  SporeTrack *input;       /* recorded, owned; NULL: that of the scene */
  SporeTrack *beside;      /* of a second run, shown at its right, owned; NULL: there is one run */
  double end_s, speed;     /* as SporeFilming has them */
  SporeFilmed filmed;      /* out */
} SporeFilmWork;

/* Takes the tracks. */
SporeFilmWork *spore_film_work_new(const SporeDocument *document, const char *file, SporeTrack *input,
                                   SporeTrack *beside, double end_s, double speed);
gboolean spore_film_work_run(gpointer work, const SporeProgress *progress, GError **error);
void spore_film_work_free(gpointer work);

#endif
