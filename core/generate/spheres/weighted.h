/* The weighted mode: a depth that is the sum of what the balls say. */
#ifndef SPORE_GENERATE_SPHERES_WEIGHTED_H
#define SPORE_GENERATE_SPHERES_WEIGHTED_H

#include "core/generate/spheres/private.h"

/* Moves balls and finds their weights (balls->count, > 0) and the level, so that sum_i w_i max(0, r_i - |p - c_i|) -
 * *level meets the depth inside the solid and is next to nowhere above 0 outside, the balls standing for their images
 * too (bound: as for spore_spheres_fit). `balls` comes with a start. The level lets the sums' tails reach out unfelt,
 * of which smooth sides are made: without it they are either felt or missed inside; how far it pays hangs on the shape.
 * It is 0 of one ball. */
bool spore_spheres_weigh(const SporeSolid *solid, SporeBalls *balls, const uint8_t *bound, double *weights,
                         double *level, uint64_t seed, const SporeProgressPart *progress, SporeError *error);

#endif
