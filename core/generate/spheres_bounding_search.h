/* Balls around a solid, moved one at a time: what a place costs, where another costs less. */
#ifndef SPORE_GENERATE_SPHERES_BOUNDING_SEARCH_H
#define SPORE_GENERATE_SPHERES_BOUNDING_SEARCH_H

#include "core/generate/spheres_bounding.h"

#define SPORE_BOUNDING_HARD 1e4

/* Points about a ball that no other one holds, relative to where it was; padded to whole SPORE_LOCAL_LANES. */
typedef struct SporeBoundingLocal {
  size_t count;
  float *x, *y, *z, *distance; /* m; scratch */
  float *price;                /* of holding a point, below 0: of leaving it; 0: of the padding */
} SporeBoundingLocal;

typedef struct SporeBoundingSearch {
  const SporeSolid *solid; /* whose symmetry the balls follow: they stand for their images, points are folded */
  const uint8_t *bound;    /* balls: mirror planes that they stay on, as bits */
  SporePrices prices;
  SporeBalls *balls;
  double price;      /* of volume left uncovered, against volume outside; from SPORE_BOUNDING_HARD on nothing is */
  double *step;      /* balls: how far to look around, in radii; settling makes it longer or shorter */
  uint32_t *reached; /* scratch: points, reached_count */
  size_t reached_count;
  SporeBoundingLocal local;
  SporeRandom random;
} SporeBoundingSearch;

/* Room for search->prices, and `held` counted anew. False: no memory. */
bool spore_bounding_open(SporeBoundingSearch *search);
void spore_bounding_close(SporeBoundingSearch *search);
/* The centre, or its image, that ball i may have. */
SporeVec3 spore_bounding_confine(const SporeBoundingSearch *search, size_t i, SporeVec3 centre);
/* Points within `radius` of c, into search->reached. */
void spore_bounding_reach(SporeBoundingSearch *search, SporeVec3 c, double radius);
/* How far all balls look around next, in radii. */
void spore_bounding_set_steps(SporeBoundingSearch *search, double step);
/* Moves ball i to the best of some places around; returns what that saves, m^3, 0: it stays. */
double spore_bounding_settle(SporeBoundingSearch *search, size_t i);
/* Covers p with the ball that can do so at least cost, where no ball does. */
void spore_bounding_cover(SporeBoundingSearch *search, SporeVec3 p);
/* Takes ball i away, or puts it where there is none (radius > 0 then); both return what that saves. */
double spore_bounding_remove(SporeBoundingSearch *search, size_t i);
double spore_bounding_insert(SporeBoundingSearch *search, size_t i, SporeVec3 c, double radius);
/* Trials, each of which gives up a ball of little worth and divides one that holds much outside, and stands where that
 * saves. False: no memory, or cancelled, which *error says. */
bool spore_bounding_relocate(SporeBoundingSearch *search, size_t trials, const SporeProgressPart *progress,
                             SporeError *error);

#endif
