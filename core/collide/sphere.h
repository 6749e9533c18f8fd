/* Collision happens between spheres only: every pair of models meets in the same way. */
#ifndef SPORE_COLLIDE_SPHERE_H
#define SPORE_COLLIDE_SPHERE_H

#include <stddef.h>
#include <stdint.h>

#include "core/math/vec3.h"

/* All spheres of a world, those of one body next to each other. Unmovable bodies come first. */
typedef struct SporeSpheres {
  size_t count, static_count;
  double *centre;   /* count x 3, m */
  double *velocity; /* count x 3, m/s */
  double *radius;   /* count, m */
  uint32_t *body;   /* count: index of the body */
} SporeSpheres;

/* Normal from b to a; depth > 0 when they overlap. */
typedef struct SporeContact {
  uint32_t a, b; /* sphere indices, a < b */
  SporeVec3 normal;
  double depth;     /* m */
  double gap_speed; /* m/s, along the normal, negative when approaching */
} SporeContact;

#endif
