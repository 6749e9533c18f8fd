/* Whether loops of a body along a line go through each other, from outside while a world runs.
 *
 * A body along a line (SporeModelLine) is as thick as its collision spheres. Two of them that are farther apart along
 * the line than the sum of their radii belong to different windings. Where they come nearer than the sum of their radii
 * the windings press on each other, and nearer than half of it one goes through the other: contacts do not hold there.
 *
 * Pairs that may come so near are listed once for many steps, until a sphere has moved by half of how much farther the
 * list looks (L. Verlet, "Computer 'Experiments' on Classical Fluids I", Phys. Rev. 159, 1967). */
#ifndef SPORE_MEASURE_LOOPS_H
#define SPORE_MEASURE_LOOPS_H

#include "core/sim/world.h"

#define SPORE_LOOPS_THROUGH 0.5 /* of the sum of the radii: nearer is through each other */

typedef struct SporeLoopsPair {
  uint32_t a, b; /* spheres of the body, from 0; a < b */
} SporeLoopsPair;

/* The loops of one body. */
typedef struct SporeLoopsBody {
  uint32_t body;
  double least;     /* distance of two spheres of different windings over the sum of their radii, the least so far; 1:
                       none touched */
  double least_s;   /* when that was, s */
  uint64_t through; /* steps that began with some pair nearer than SPORE_LOOPS_THROUGH */
  bool from_start;  /* the first of them did */
  /* Private. */
  size_t start, count; /* spheres, among all of the world */
  double skin;         /* m: how much farther the list looks */
  double *along;       /* count: place on the line at the start, m */
  double *listed;      /* count x 3: centres when the pairs were listed */
  size_t pair_count, pair_capacity;
  SporeLoopsPair *pairs;
} SporeLoopsBody;

typedef struct SporeLoops {
  size_t count; /* of bodies along a line that can touch something */
  SporeLoopsBody *bodies;
  uint64_t steps; /* looked at */
  double time_s;  /* at the end of the last of them */
} SporeLoops;

/* Takes the present state for how the bodies lie at rest. Bodies for which there is no memory are left out. Clear by
 * spore_loops_clear. */
void spore_loops_start(SporeLoops *loops, const SporeWorld *world);
void spore_loops_clear(SporeLoops *loops);
/* Looks at where the spheres were when the last step began; to be called after each step. May take memory: a body for
 * whose pairs there is none is left out from then on. */
void spore_loops_step(SporeLoops *loops, const SporeWorld *world);

#endif
