/* The weighted mode: the depth is a weighted sum of the depths in the balls. */
#ifndef SPORE_GENERATE_SPHERES_WEIGHTED_H
#define SPORE_GENERATE_SPHERES_WEIGHTED_H

#include "core/generate/spheres/private.h"

/* Moves balls and finds their weights (balls->count, > 0) and the level, so that sum_i w_i max(0, r_i - |p - c_i|) -
 * *level matches the depth inside the solid and is almost nowhere above 0 outside. Each ball stands for its images too
 * (bound: as for spore_spheres_fit). `balls` holds the start on entry. The level lets balls reach out of the solid
 * without a positive depth there; such balls make smooth sides. Without the level, the sum is either above 0 outside or
 * too small inside. The gain depends on the shape. The level is 0 for one ball. */
bool spore_spheres_weigh(const SporeSolid *solid, SporeBalls *balls, const uint8_t *bound, double *weights,
                         double *level, uint64_t seed, const SporeProgressPart *progress, SporeError *error);

#endif
