/* The weighted mode: a depth that is the sum of what the balls say. */
#ifndef SPORE_GENERATE_SPHERES_WEIGHTED_H
#define SPORE_GENERATE_SPHERES_WEIGHTED_H

#include "core/generate/spheres_parts.h"

/* Moves balls and finds their weights (balls->count, > 0) so that sum_i w_i max(0, r_i - |p - c_i|) meets the depth
 * inside the solid and is next to nothing outside, the balls standing for their images too (bound: as for
 * spore_spheres_fit). `balls` comes with a start. */
bool spore_spheres_weigh(const SporeSolid *solid, SporeBalls *balls, const uint8_t *bound, double *weights,
                         uint64_t seed, const SporeProgressPart *progress, SporeError *error);

#endif
