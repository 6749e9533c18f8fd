/* What the files of the bounding mode share. */
#ifndef SPORE_GENERATE_SPHERES_BOUNDING_H
#define SPORE_GENERATE_SPHERES_BOUNDING_H

#include "core/generate/spheres/private.h"

/* Points that say what a set of balls costs: those outside the solid where a ball holds them, those inside and on the
 * surface where none does. Each stands for its share of the volume around the solid. */
typedef struct SporeCosts {
  double *xyz, *cost; /* count x 3, count: as they came */
  size_t count;
  SporePoints points;
  double *volume; /* m^3, below 0 inside the solid and on its surface; 0 for the padding */
  uint16_t *held; /* how many balls hold the point */
} SporeCosts;
/* Fine at the surface, coarser with the distance from it, folded by the solid's symmetry; `count`: of the balls that
 * they are for. */
bool spore_costs_create(SporeCosts *costs, const SporeSolid *solid, size_t count, SporeRandom *random,
                        const SporeProgressPart *progress, SporeError *error);
/* More points inside, each for the volume; all points are held by none then. False: no memory. */
bool spore_costs_add(SporeCosts *costs, const double *xyz, size_t count, double volume);
void spore_costs_clear(SporeCosts *costs);

/* Whether the balls hold the whole solid: each triangle of its surface divided until one ball holds each piece, and no
 * corner of a hollow between the balls left inside the solid. Meant for solids whose surface is closed. False as well
 * where memory is short. */
bool spore_balls_cover(const SporeSolid *solid, const SporeBalls *balls);
/* Middles of pieces of the surface, of an edge of about `finest` of the diagonal (more where there are very many), that
 * no ball holds by `margin` of the diagonal: *points, x y z each, the caller's to free, on failure too. False: no
 * memory. */
bool spore_balls_gaps(const SporeSolid *solid, const SporeBalls *balls, double margin, double finest, double **points,
                      size_t *count);
/* Grows balls until they cover the solid, each by about as little as that takes. False: no memory. */
bool spore_balls_grow_to_cover(const SporeSolid *solid, SporeBalls *balls);

/* Moves and grows balls so that they, with their images in the solid's mirror planes (bound: as for spore_spheres_fit),
 * hold all of the solid and little besides. */
bool spore_spheres_bound(const SporeSolid *solid, SporeBalls *balls, const uint8_t *bound, uint64_t seed,
                         const SporeProgressPart *progress, SporeError *error);

#endif
