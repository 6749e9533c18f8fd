/* A watched point: a place of a body that is followed while the world runs. */
#ifndef SPORE_MEASURE_WATCH_H
#define SPORE_MEASURE_WATCH_H

#include "core/sim/world.h"

/* The point at each level of detail that its body has. Memory of its own: spore_watch_clear. */
typedef struct SporeWatch {
  uint32_t body;
  SporeMapping mapping[SPORE_LOD_COUNT]; /* of one point; without points at a level that the body does not have */
  uint32_t *places[SPORE_LOD_COUNT];     /* of spore_mapping_find_places; NULL: no cut can split the body's nodes */
} SporeWatch;

/* at: world, m, where the point is at time 0; of a thread whose control points come and go, the point of its line
 * nearest to that is watched. To be called before the first step. False: no memory, or the body cannot carry the point;
 * *watch is empty then. */
bool spore_watch_init(SporeWatch *watch, const SporeWorld *world, uint32_t body, SporeVec3 at, SporeError *error);
void spore_watch_clear(SporeWatch *watch);
/* Where the point is now, m, and its velocity, m/s; world, 3 each. Not a number while the point is a particle out of
 * the world. Belongs to the thread that steps. */
void spore_watch_measure(SporeWatch *watch, const SporeWorld *world, double *position, double *velocity);

#endif
