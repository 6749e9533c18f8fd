/* Balls around a solid, moved one at a time: what a place costs, where another costs less. */
#ifndef SPORE_GENERATE_SPHERES_BOUNDING_SEARCH_H
#define SPORE_GENERATE_SPHERES_BOUNDING_SEARCH_H

#include "core/generate/spheres/bounding.h"

#define SPORE_BOUNDING_HARD 1e4

/* Points about a ball that no other one holds, relative to where it was; padded to whole SPORE_LOCAL_LANES. */
typedef struct SporeBoundingLocal {
  size_t count;
  float *x, *y, *z, *distance; /* m; scratch */
  float *cost;                 /* of holding a point, below 0: of leaving it; 0: of the padding */
} SporeBoundingLocal;

#define SPORE_BOUNDING_RAYS 256

/* Rays from where a ball is, lengths in its radii. */
typedef struct SporeBoundingShell {
  float *x, *y, *z;
  float *from, *to; /* where they leave the other balls; where they end */
  SporeVec3 middle; /* m */
  double radius;    /* m */
} SporeBoundingShell;
bool spore_bounding_shell_create(SporeBoundingShell *shell);
void spore_bounding_shell_clear(SporeBoundingShell *shell);
/* All rays together, somehow. */
void spore_bounding_shell_turn(SporeBoundingShell *shell, SporeRandom *random);
/* From ball i, which may come to reach out farther by `reach`. */
void spore_bounding_shell_look(SporeBoundingShell *shell, const SporeSymmetry *symmetry, const SporeBalls *balls,
                               size_t i, double reach);
/* m^3 that the ball adds to the others if it is put there. */
double spore_bounding_shell_volume(const SporeBoundingShell *shell, SporeVec3 centre, double radius);

typedef struct SporeBoundingSearch {
  const SporeSolid *solid; /* whose symmetry the balls follow: they stand for their images, points are folded */
  const uint8_t *bound;    /* balls: mirror planes that they stay on, as bits */
  SporeCosts costs;
  SporeBalls *balls;
  double cost;       /* of volume left uncovered, against volume outside; from SPORE_BOUNDING_HARD on nothing is */
  double *step;      /* balls: how far to look around, in radii; settling makes it longer or shorter */
  uint32_t *reached; /* scratch: points, reached_count */
  size_t reached_count;
  SporeBoundingLocal local;
  SporeBoundingShell shell;
  uint64_t work; /* points looked at so far, about: what looking around costs */
  SporeRandom random;
} SporeBoundingSearch;

/* Room for search->costs, and `held` counted anew. False: no memory. */
bool spore_bounding_open(SporeBoundingSearch *search);
void spore_bounding_close(SporeBoundingSearch *search);
/* The centre, or its image, that ball i may have. */
SporeVec3 spore_bounding_confine(const SporeBoundingSearch *search, size_t i, SporeVec3 centre);
/* Points at `inner` to `radius` from c, into search->reached. */
void spore_bounding_reach(SporeBoundingSearch *search, SporeVec3 c, double inner, double radius);
/* How far all balls look around next, in radii. */
void spore_bounding_set_steps(SporeBoundingSearch *search, double step);
/* Moves ball i to the best of some places around; returns what that saves, m^3, 0: it stays. */
double spore_bounding_settle(SporeBoundingSearch *search, size_t i);
/* Covers p with the ball that can do so at least cost, where no ball does. */
void spore_bounding_cover(SporeBoundingSearch *search, SporeVec3 p);
/* Takes ball i away, or puts it where there is none (radius > 0 then); both return what that saves. */
double spore_bounding_remove(SporeBoundingSearch *search, size_t i);
double spore_bounding_insert(SporeBoundingSearch *search, size_t i, SporeVec3 c, double radius);
/* Gives up balls of little worth and divides those that hold much outside, in batches, each of which stands where it
 * saves once all around have settled; until about `work` is done. False: no memory, or cancelled, which *error says. */
bool spore_bounding_relocate(SporeBoundingSearch *search, uint64_t work, const SporeProgressPart *progress,
                             SporeError *error);

#endif
