/* The scene of an accuracy study: makes worlds of a document by other methods, steps, levels and stretches of input. */
#ifndef SPORE_APP_CLI_ACCURACY_SCENE_H
#define SPORE_APP_CLI_ACCURACY_SCENE_H

#include "app/cli/scene.h"
#include "core/measure/accuracy.h"

typedef struct SporeAccuracySource SporeAccuracySource;

/* run: borrowed. body: whose method is varied; NULL: of all that physics moves. Fills *scene, which lives as long as
 * the source. */
SporeAccuracySource *spore_accuracy_source_new(SporeRun *run, const char *body, SporeAccuracyScene *scene);
void spore_accuracy_source_free(SporeAccuracySource *source);

#endif
