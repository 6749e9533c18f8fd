/* Collision happens between spheres only: every pair of models meets in the same way. */
#ifndef SPORE_COLLIDE_SPHERE_H
#define SPORE_COLLIDE_SPHERE_H

#include <stddef.h>
#include <stdint.h>

#include "core/math/vec3.h"

/* Part of the smaller radius. Two spheres that move further than this against each other in a step are fast: the step
 * looks ahead for their contact, since without its force they would be deep in each other when the next step begins. */
#define SPORE_SPHERES_FAST 0.25

/* Steps that pairs of bodies that are not soft are looked ahead for. What they enter without a force they would get
 * back with one: energy from nothing. A soft body has its own damping. */
#define SPORE_SPHERES_AHEAD 1.5

/* All spheres of a world, those of one body next to each other. Unmovable bodies come first. */
typedef struct SporeSpheres {
  size_t count, static_count;
  double *centre;   /* count x 3, m */
  double *velocity; /* count x 3, m/s */
  double *radius;   /* count, m */
  uint32_t *body;   /* count: index of the body */
  double *before;   /* count x 3, m: the centre a step ago; where a sphere was put where it is since, the centre, or
                       not a number. NULL: nothing is known of a step before */
  double slowest; /* m/s: bodies that are not soft are looked ahead for where they meet faster (SPORE_SPHERES_AHEAD) */
} SporeSpheres;

/* Normal from b to a; depth > 0 when they overlap. */
typedef struct SporeContact {
  uint32_t a, b; /* sphere indices, a < b */
  SporeVec3 normal;
  double depth;     /* m */
  double gap_speed; /* m/s, along the normal, negative when approaching */
} SporeContact;

typedef struct SporePair {
  uint32_t a, b; /* sphere indices, a < b */
} SporePair;

#endif
