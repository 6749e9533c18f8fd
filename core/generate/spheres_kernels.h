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

#endif
