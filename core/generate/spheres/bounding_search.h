/* Search for bounding balls, which moves one ball at a time: the cost of a place, and places of less cost. */
#ifndef SPORE_GENERATE_SPHERES_BOUNDING_SEARCH_H
#define SPORE_GENERATE_SPHERES_BOUNDING_SEARCH_H

#include "core/generate/spheres/bounding.h"

#define SPORE_BOUNDING_HARD 1e4

/* Points near a ball that no other ball contains, relative to the ball's old centre; padded to whole SPORE_LOCAL_LANES.
 */
typedef struct SporeBoundingLocal {
  size_t count;
  float *x, *y, *z, *distance; /* m; scratch */
  float *cost;                 /* above 0: of containing the point; below 0: of leaving it uncovered; 0: padding */
  int32_t *bin;                /* scratch */
} SporeBoundingLocal;

#define SPORE_BOUNDING_RAYS 256

/* Rays from the centre of a ball, lengths in radii of the ball. */
typedef struct SporeBoundingShell {
  float *x, *y, *z;
  float *from, *to; /* where the rays leave the other balls; where the rays end */
  SporeVec3 middle; /* m */
  double radius;    /* m */
} SporeBoundingShell;
bool spore_bounding_shell_create(SporeBoundingShell *shell);
void spore_bounding_shell_clear(SporeBoundingShell *shell);
/* Sets the rays, with one random rotation for all. */
void spore_bounding_shell_turn(SporeBoundingShell *shell, SporeRandom *random);
/* Prepares the rays of ball i, whose surface may move outward by up to `reach`. */
void spore_bounding_shell_look(SporeBoundingShell *shell, const SporeSymmetry *symmetry, const SporeBalls *balls,
                               size_t i, double reach);
/* m^3 that the ball adds to the union of the others if the ball is put there. */
double spore_bounding_shell_volume(const SporeBoundingShell *shell, SporeVec3 centre, double radius);

typedef struct SporeBoundingSearch {
  const SporeSolid *solid; /* with its symmetry: each ball stands for its images too, and points are folded */
  const uint8_t *bound;    /* balls: bits of the mirror planes that each stays on */
  SporeCosts costs;
  SporeBalls *balls;
  double cost;  /* of uncovered volume relative to volume outside; from SPORE_BOUNDING_HARD on all must be covered */
  bool many;    /* more balls than gain from a long search */
  double *step; /* balls: search distance, in radii; spore_bounding_settle adapts it */
  uint32_t *reached; /* scratch: points, reached_count */
  size_t reached_count;
  SporeBoundingLocal local;
  SporeBoundingShell shell;
  uint64_t work; /* about the number of points visited so far: measure of the time spent */
  SporeRandom random;
} SporeBoundingSearch;

/* Allocates for search->costs and counts `held` again. False: no memory. */
bool spore_bounding_open(SporeBoundingSearch *search);
void spore_bounding_close(SporeBoundingSearch *search);
/* The allowed centre for ball i: folded by the symmetry and projected on the planes to which the ball is bound. */
SporeVec3 spore_bounding_confine(const SporeBoundingSearch *search, size_t i, SporeVec3 centre);
/* Collects the points at distances `inner` to `radius` from c in search->reached. */
void spore_bounding_reach(SporeBoundingSearch *search, SporeVec3 c, double inner, double radius);
/* Sets the search distance of all balls, in radii. */
void spore_bounding_set_steps(SporeBoundingSearch *search, double step);
/* Moves ball i to the best of some places nearby. Returns the cost saved, m^3; 0: the ball stays. */
double spore_bounding_settle(SporeBoundingSearch *search, size_t i);
/* If no ball contains p: covers p with the ball that can do so at least cost. */
void spore_bounding_cover(SporeBoundingSearch *search, SporeVec3 p);
/* Removes ball i, or inserts ball i after its removal (radius > 0). Both return the cost saved. */
double spore_bounding_remove(SporeBoundingSearch *search, size_t i);
double spore_bounding_insert(SporeBoundingSearch *search, size_t i, SporeVec3 c, double radius);
/* Removes balls of little worth and divides balls that contain much volume outside, in batches. A batch is kept if it
 * lowers the cost after the balls around have settled. Stops after about `work`. False: no memory or cancelled; see
 * *error. */
bool spore_bounding_relocate(SporeBoundingSearch *search, uint64_t work, const SporeProgressPart *progress,
                             SporeError *error);

#endif
