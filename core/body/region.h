/* Parts of a body that are of another stiffness or density than the rest. */
#ifndef SPORE_SIM_REGION_H
#define SPORE_SIM_REGION_H

#include "core/math/vec3.h"

/* What has its middle, at rest, nearer than radius to the centre. */
typedef struct SporeRegion {
  SporeVec3 centre; /* body's frame, m */
  double radius;    /* m */
  double stiffness; /* factors on what the model's parameters give; of all regions that hold a place */
  double density;
  size_t elements; /* that it holds: counted where a model is made */
} SporeRegion;

typedef struct SporeRegions {
  size_t count;
  SporeRegion *regions;
} SporeRegions;

typedef struct SporeRegionFactors {
  double stiffness, density;
} SporeRegionFactors;

/* Of an element whose middle is there; it is counted. regions: NULL: none. */
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
