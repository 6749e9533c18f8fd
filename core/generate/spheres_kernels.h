/* The inner loop of a field of balls: see spheres_parts.h. */
#ifndef SPORE_GENERATE_SPHERES_KERNELS_H
#define SPORE_GENERATE_SPHERES_KERNELS_H

#include "core/math/simd.h"

/* Balls as columns, relative to the middle of a block of points. */
typedef struct SporeNearBalls {
  size_t count;
  const float *x, *y, *z, *r;
  const float *number; /* whole */
} SporeNearBalls;

/* r_i - distance at the SPORE_BLOCK points x, y, z: the largest, the second largest (-HUGE_VALF where there is one
 * ball), and the number of the ball of the largest, the first of equals. */
SPORE_DECLARE_KERNEL(void, spore_field_block, const SporeNearBalls *balls, const float *x, const float *y,
                     const float *z, float *best, float *second, float *owner);

#define SPORE_LOCAL_LANES 16 /* columns of points are padded to whole ones of these */

/* distance[k] of the points from `at`; count is rounded up to whole lanes. */
SPORE_DECLARE_KERNEL(void, spore_local_distances, const float *x, const float *y, const float *z, size_t count,
                     const float at[3], float *distance);

/* Of the points no farther than `radius`: their prices above 0 and below 0, summed up, and the largest distance of one
 * of those below 0, 0 where there is none. */
typedef struct SporeLocalCost {
  float outside, inside, farthest;
} SporeLocalCost;
SPORE_DECLARE_KERNEL(void, spore_local_cost, const float *distance, const float *price, size_t count, float radius,
                     SporeLocalCost *cost);

#endif
