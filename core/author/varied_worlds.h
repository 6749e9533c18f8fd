/* Worlds that a study makes of variations of one document, each kept until the study drops it. */
#ifndef SPORE_AUTHOR_VARIED_WORLDS_H
#define SPORE_AUTHOR_VARIED_WORLDS_H

#include "core/scene/variation.h"

/* The document is never changed. All borrowed; pool and cancel as for spore_simulation_new. For one thread. */
typedef struct SporeVariedWorlds {
  SporeDocument *document;
  SporePool *pool;
  const SporeCancel *cancel;
  GPtrArray *made; /* of SporeSimulation *: worlds that are not dropped yet */
} SporeVariedWorlds;

void spore_varied_worlds_init(SporeVariedWorlds *worlds, SporeDocument *document, SporePool *pool,
                              const SporeCancel *cancel);
/* Frees the worlds that were not dropped. */
void spore_varied_worlds_clear(SporeVariedWorlds *worlds);
/* input as for spore_simulation_new. NULL with *fault: the scene cannot run so, or cancelled. */
SporeWorld *spore_varied_worlds_make(SporeVariedWorlds *worlds, const SporeVariation *variation,
                                     const SporeTrack *input, SporeError *fault);
/* Of a world that was made and not dropped. */
SporeSimulation *spore_varied_worlds_simulation(const SporeVariedWorlds *worlds, const SporeWorld *world);
void spore_varied_worlds_drop(SporeVariedWorlds *worlds, SporeWorld *world);

#endif
