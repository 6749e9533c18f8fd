/* Parts of a body that are of another stiffness or density than the rest. */
#ifndef SPORE_SIM_REGION_H
#define SPORE_SIM_REGION_H

#include <stdbool.h>
#include <stddef.h>

#include "core/math/vec3.h"

/* Balls in the body, painted or placed: the region holds the elements whose middle, at rest, lies in one of the balls:
 * nearer to its centre than its radius. */
typedef struct SporeRegion {
  size_t ball_count; /* at least 1 */
  double *balls;     /* ball_count x 4: centre (body's frame) and radius, m */
  double stiffness;  /* factor on the stiffness that the model's parameters give; above 0 */
  double density;    /* factor on the density; above 0 */
  size_t elements;   /* that the region holds: counted while a model is made */
} SporeRegion;

/* The regions of a body. The arrays belong to whoever made them. */
typedef struct SporeRegions {
  size_t count;
  SporeRegion *regions;
} SporeRegions;

/* Factors on the stiffness and the density of an element; 1: as the model's parameters say. */
typedef struct SporeRegionFactors {
  double stiffness, density;
} SporeRegionFactors;

/* Whether the place lies in one of the balls; balls: count x 4, centre and radius. */
static inline bool spore_balls_hold(const double *balls, size_t count, SporeVec3 place) {
  for (size_t i = 0; i < count; i++)
    if (spore_vec3_distance(spore_vec3_load(balls + 4 * i), place) < balls[4 * i + 3]) return true;
  return false;
}

/* Factors for an element whose middle, at rest, is `middle` (body's frame, m). Where regions overlap, their factors are
 * multiplied. Each region that holds the element counts it in `elements`. regions: NULL: none. */
static inline SporeRegionFactors spore_regions_at(const SporeRegions *regions, SporeVec3 middle) {
  SporeRegionFactors factors = {1, 1};
  for (size_t i = 0; regions && i < regions->count; i++) {
    SporeRegion *region = &regions->regions[i];
    if (!spore_balls_hold(region->balls, region->ball_count, middle)) continue;
    factors.stiffness *= region->stiffness;
    factors.density *= region->density;
    region->elements++;
  }
  return factors;
}

#endif
