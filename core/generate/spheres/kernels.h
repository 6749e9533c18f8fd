/* The inner loops of a field of balls: see private.h. */
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

/* r_i - distance at the SPORE_BLOCK points x, y, z: the largest value, the second largest (-HUGE_VALF where there is
 * one ball), and the number of the ball with the largest value (the first of equal ones). */
SPORE_DECLARE_KERNEL(void, spore_field_block, const SporeNearBalls *balls, const float *x, const float *y,
                     const float *z, float *best, float *second, float *owner);

/* values[i]: r_i - distance from `at`. Returns the second largest (the largest when there is one ball). */
SPORE_DECLARE_KERNEL(double, spore_balls_values, const double *x, const double *y, const double *z, const double *r,
                     size_t count, const double at[3], double *values);

/* Bit k: point k of the SPORE_BLOCK points x, y, z has a squared distance from `at` in [inner, outer]. */
SPORE_DECLARE_KERNEL(uint32_t, spore_block_between, const double *x, const double *y, const double *z,
                     const double at[3], double inner, double outer);

/* depth[k]: radius - distance from `at` of the SPORE_BLOCK points x, y, z. */
SPORE_DECLARE_KERNEL(void, spore_block_depths, const double *x, const double *y, const double *z, const double at[3],
                     double radius, double *depth);

/* reaches[i]: 1 where ball i reaches into the bounding sphere (centre and radius), else 0. */
SPORE_DECLARE_KERNEL(void, spore_balls_reach, const double *x, const double *y, const double *z, const double *r,
                     size_t count, const double bound[4], uint8_t *reaches);

#define SPORE_LOCAL_LANES 16 /* columns of points are padded to a multiple of this */

/* distance[k] of the points from `at`; count is rounded up to whole lanes. */
SPORE_DECLARE_KERNEL(void, spore_local_distances, const float *x, const float *y, const float *z, size_t count,
                     const float at[3], float *distance);

/* Of the points within `radius`: the sum of the costs above 0, the sum of the costs below 0, and the largest distance
 * of a point with a cost below 0 (0: there is none). */
typedef struct SporeLocalCost {
  float outside, inside, farthest;
} SporeLocalCost;
SPORE_DECLARE_KERNEL(void, spore_local_cost, const float *distance, const float *cost, size_t count, float radius,
                     SporeLocalCost *sum);

/* bin[k]: 0 where distance[k] is below `first`, from there on one more for each 1 / scale, `bins` at most. count is
 * rounded up to whole lanes. */
SPORE_DECLARE_KERNEL(void, spore_local_bins, const float *distance, size_t count, float first, float scale, int bins,
                     int32_t *bin);

/* A block of depth samples and the balls that reach it, as columns, relative to the block's middle. Lengths in any
 * unit. */
typedef struct SporeWeightedBlock {
  size_t count;                              /* of balls */
  const float *x, *y, *z, *r, *weight;       /* count */
  const float *px, *py, *pz, *depth, *share; /* SPORE_BLOCK samples; share: weight of each in the loss */
  float smoothing, level;
  float *distance; /* scratch, count x SPORE_BLOCK */
} SporeWeightedBlock;

/* sum[k] = sum_i w_i (r_i - d_i)+ - level of the samples. slopes: derivatives of the loss, count x 5, by x, y, z, r, w,
 * then one by the level. The loss is the sum of share times |sum - depth|, rounded below `smoothing`. Outside, where
 * the depth is below 0, only a sum above 0 is an error. A sample that no ball reaches adds nothing to the level's
 * derivative. */
SPORE_DECLARE_KERNEL(void, spore_weighted_slopes, const SporeWeightedBlock *block, float *sum, float *slopes);

/* Unit rays x, y, z from the origin, in whole lanes. ball: centre and radius. from[k] becomes the distance at which the
 * ray leaves the ball, if that is farther than from[k] and the ray enters the ball within 1. */
SPORE_DECLARE_KERNEL(void, spore_rays_leave, const float *x, const float *y, const float *z, size_t count,
                     const float ball[4], float *from);
/* Sum of (leave^3 - from^3) over the rays where leave is larger than from. leave: distance at which the ray leaves the
 * ball, `to` at most. */
SPORE_DECLARE_KERNEL(void, spore_rays_volume, const float *x, const float *y, const float *z, const float *from,
                     const float *to, size_t count, const float ball[4], float *sum);

#endif
