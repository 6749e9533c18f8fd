/* Pictures of the moments at which the steps of an exercise were done, for the page that `spore run` writes. */
#ifndef SPORE_APP_RUN_PICTURES_H
#define SPORE_APP_RUN_PICTURES_H

#include "app/cli/scene.h"
#include "core/author/exercise_report.h"

typedef struct SporeRunPictures SporeRunPictures;

/* The run is borrowed, and has an exercise. Nothing is drawn yet. */
SporeRunPictures *spore_run_pictures_new(SporeRun *run);
void spore_run_pictures_free(SporeRunPictures *pictures); /* NULL is allowed */
/* Draws the scene where a step was done since the last look; to be called after the exercise has watched. */
void spore_run_pictures_look(SporeRunPictures *pictures);
/* Valid until the next look. */
SporeReportPictures spore_run_pictures_get(const SporeRunPictures *pictures);

#endif
