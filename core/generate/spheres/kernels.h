/* The inner loop of a field of balls: see spheres_parts.h. */
#ifndef SPORE_GENERATE_SPHERES_KERNELS_H
#define SPORE_GENERATE_SPHERES_KERNELS_H

#include <stdint.h>

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

/* Of the points no farther than `radius`: their costs above 0 and below 0, summed up, and the largest distance of one
 * of those below 0, 0 where there is none. */
typedef struct SporeLocalCost {
  float outside, inside, farthest;
} SporeLocalCost;
SPORE_DECLARE_KERNEL(void, spore_local_cost, const float *distance, const float *cost, size_t count, float radius,
                     SporeLocalCost *sum);

/* A block of samples of the depth and the balls that reach it, as columns, relative to its middle; lengths in any unit.
 */
typedef struct SporeWeightedBlock {
  size_t count;                              /* of balls */
  const float *x, *y, *z, *r, *weight;       /* count */
  const float *px, *py, *pz, *depth, *share; /* SPORE_BLOCK samples, and what each counts for */
  float smoothing, level;
} SporeWeightedBlock;

/* sum[k] = sum_i w_i (r_i - d_i)+ - level of the samples. slopes: count x 5, by x, y, z, r, w, and one by the level, of
 * the shares of the samples times |sum - depth|, rounded below `smoothing`; outside, where the depth is below 0, only a
 * sum above 0 is wrong, and where no ball reaches, no level is. */
SPORE_DECLARE_KERNEL(void, spore_weighted_slopes, const SporeWeightedBlock *block, float *sum, float *slopes);

/* Rays x, y, z from the origin, whole lanes of them; ball: centre and radius. from[k] becomes where the ray leaves the
 * ball, where that is farther and the ray enters it within 1. */
SPORE_DECLARE_KERNEL(void, spore_rays_leave, const float *x, const float *y, const float *z, size_t count,
                     const float ball[4], float *from);
/* Sum of the cubes of where the rays leave the ball, at `to` at most, less the cubes of `from`, where that is more. */
SPORE_DECLARE_KERNEL(void, spore_rays_volume, const float *x, const float *y, const float *z, const float *from,
                     const float *to, size_t count, const float ball[4], float *sum);

#endif
