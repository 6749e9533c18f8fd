/* What the files of the bounding mode share. */
#ifndef SPORE_GENERATE_SPHERES_BOUNDING_H
#define SPORE_GENERATE_SPHERES_BOUNDING_H

#include "core/generate/spheres/private.h"

/* Points that give the cost of a set of balls. A point outside the solid costs where a ball contains it. A point inside
 * or on the surface costs where no ball contains it. Each point stands for its share of the volume around the solid. */
typedef struct SporeCosts {
  double *xyz, *cost; /* count x 3, count: in the order in which they were added */
  size_t count;
  SporePoints points;
  double *volume; /* m^3, below 0 inside the solid and on its surface; 0 for the padding */
  uint16_t *held; /* number of balls that contain the point */
} SporeCosts;
/* Points that are dense at the surface, sparser with the distance from the surface, and folded by the solid's symmetry.
 * `count`: number of balls. */
bool spore_costs_create(SporeCosts *costs, const SporeSolid *solid, size_t count, SporeRandom *random,
                        const SporeProgressPart *progress, SporeError *error);
/* Adds points inside, each for the volume. Afterwards `held` is 0 for all points. False: no memory. */
bool spore_costs_add(SporeCosts *costs, const double *xyz, size_t count, double volume);
void spore_costs_clear(SporeCosts *costs);

/* Whether the balls contain the whole solid: each triangle of the surface is divided until one ball contains each
 * piece, and no corner of a hollow between the balls lies inside the solid. For solids with a closed surface. Also
 * false where memory is short. */
bool spore_balls_cover(const SporeSolid *solid, const SporeBalls *balls);
/* Middles of surface pieces that no ball contains by `margin` of the diagonal. The pieces have edges of about `finest`
 * of the diagonal, longer where there would be more than `most`. *points: x y z each; the caller frees it, on failure
 * too. False: no memory. */
bool spore_balls_gaps(const SporeSolid *solid, const SporeBalls *balls, double margin, double finest, size_t most,
                      double **points, size_t *count);
/* Grows balls until they cover the solid, each about as little as possible. False: no memory. */
bool spore_balls_grow_to_cover(const SporeSolid *solid, SporeBalls *balls);

/* Moves and grows balls so that they, with their images in the solid's mirror planes (bound: as for spore_spheres_fit),
 * contain all of the solid and little else. */
bool spore_spheres_bound(const SporeSolid *solid, SporeBalls *balls, const uint8_t *bound, uint64_t seed,
                         const SporeProgressPart *progress, SporeError *error);

#endif
