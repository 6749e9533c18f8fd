/* Parts of a body that are of another stiffness or density than the rest. */
#ifndef SPORE_SIM_REGION_H
#define SPORE_SIM_REGION_H

#include "core/math/vec3.h"

/* A ball in the body: it holds the elements whose middle, at rest, lies nearer than `radius` to the centre. */
typedef struct SporeRegion {
  SporeVec3 centre; /* body's frame, m */
  double radius;    /* m */
  double stiffness; /* factor on the stiffness that the model's parameters give; above 0 */
  double density;   /* factor on the density; above 0 */
  size_t elements;  /* that the region holds: counted while a model is made */
} SporeRegion;

/* The regions of a body. The array belongs to whoever made it. */
typedef struct SporeRegions {
  size_t count;
  SporeRegion *regions;
} SporeRegions;

/* Factors on the stiffness and the density of an element; 1: as the model's parameters say. */
typedef struct SporeRegionFactors {
  double stiffness, density;
} SporeRegionFactors;

/* Factors for an element whose middle, at rest, is `middle` (body's frame, m). Where regions overlap, their factors are
 * multiplied. Each region that holds the element counts it in `elements`. regions: NULL: none. */
static inline SporeRegionFactors spore_regions_at(const SporeRegions *regions, SporeVec3 middle) {
  SporeRegionFactors factors = {1, 1};
  for (size_t i = 0; regions && i < regions->count; i++) {
    SporeRegion *region = &regions->regions[i];
    if (!(spore_vec3_distance(region->centre, middle) < region->radius)) continue;
    factors.stiffness *= region->stiffness;
    factors.density *= region->density;
    region->elements++;
  }
  return factors;
}

#endif
