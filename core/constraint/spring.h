/* A damped spring between two points, or what holds them together: its law alone. */
#ifndef SPORE_CONSTRAINT_SPRING_H
#define SPORE_CONSTRAINT_SPRING_H

#include <stdbool.h>

#include "core/math/mat3.h"

typedef struct SporeSpring {
  double stiffness;   /* N/m */
  double damping;     /* N s/m, along the spring; in all directions where rest_length is 0 */
  double rest_length; /* m */
  SporeVec3 fallback; /* unit: the direction to use where the ends meet and rest_length is not 0 */
  SporeVec3 free;     /* unit: the direction in which nothing holds, where rest_length is 0; zero: none */
  double friction;    /* along `free`: Coulomb coefficient */
} SporeSpring;

/* Friction along the free direction is a spring that slips (see core/collide/response.h), as stiff as the rest:
 *   T = k stretch + c speed,  cut to mu N, where N holds; on end a it is -T along `free`. */
double spore_spring_friction(const SporeSpring *spring, double stretch, double speed, double held);
/* Whether it slips, and gives way to motion. */
bool spore_spring_slips(const SporeSpring *spring, double stretch, double speed, double held);

/* What it holds of a vector: all that is not free. */
SporeVec3 spore_spring_held(const SporeSpring *spring, SporeVec3 a);
/* Force (N) on end a; end b gets its opposite. */
SporeVec3 spore_spring_force(const SporeSpring *spring, SporeVec3 a, SporeVec3 b, SporeVec3 velocity_a,
                             SporeVec3 velocity_b);
/* -df/d(a - b) without what is not positive semi-definite (compression sideways), and -df/d(velocity_a - velocity_b):
 *   K = k [max(0, 1 - L/l) (I - nn^T) + nn^T],  D = c nn^T;  K = k P, D = c P, P = I - ff^T where L = 0. */
void spore_spring_jacobian(const SporeSpring *spring, SporeVec3 a, SporeVec3 b, SporeMat3 *stiffness,
                           SporeMat3 *damping);
/* J */
double spore_spring_energy(const SporeSpring *spring, SporeVec3 a, SporeVec3 b);

#endif
