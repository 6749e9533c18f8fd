/* The worlds that a stability study (core/measure/stability.h) makes of a document. */
#ifndef SPORE_AUTHOR_STABILITY_SCENE_H
#define SPORE_AUTHOR_STABILITY_SCENE_H

#include "core/measure/stability.h"
#include "core/scene/compile.h"

/* A document that is varied; the document itself is never changed. For one thread. */
typedef struct SporeVariedScene SporeVariedScene;

/* All borrowed; pool, input and cancel as for spore_simulation_new. */
SporeVariedScene *spore_varied_scene_new(SporeDocument *document, SporePool *pool, const SporeTrack *input,
                                         const SporeCancel *cancel);
void spore_varied_scene_free(SporeVariedScene *varied);
/* The study's way to the scene, valid as long as that is. */
SporeStabilityScene spore_varied_scene_worlds(SporeVariedScene *varied);

#endif
