/* Inertia of a solid, and how it turns when nothing acts on it. */
#ifndef SPORE_MODELS_COMMON_RIGID_MOTION_H
#define SPORE_MODELS_COMMON_RIGID_MOTION_H

#include <stdbool.h>

#include "core/math/quat.h"

typedef struct SporeInertia {
  SporeMat3 tensor;         /* about the centre of mass, axes of the body's frame, kg m^2 */
  double moment[3];         /* principal ones, smallest first, kg m^2 */
  double inverse[3];        /* 1 / moment */
  SporeMat3 principal;      /* columns: principal axes in the body's frame, right-handed */
  SporeQuat principal_quat; /* the same */
  bool even;                /* three equal moments: a ball, a cube */
} SporeInertia;

/* False where the moments are not all positive and finite; `moment` tells them all the same. */
bool spore_inertia_init(SporeInertia *inertia, SporeMat3 tensor);
/* World axes, symmetric to the last bit. */
SporeMat3 spore_inertia_turned(const SporeInertia *inertia, SporeQuat orientation);
/* Free motion for h seconds: turns *orientation (of the body's frame) and *spin (rad/s, world axes). Keeps the angular
 * momentum to rounding, however fast or slender the body. */
void spore_inertia_drift(const SporeInertia *inertia, double h, SporeQuat *orientation, SporeVec3 *spin);
/* The longest h (s) for which that is right. A longer motion keeps the momentum and stays stable, but turns the body
 * over too early or too late. INFINITY: any h, as for a ball or a body of revolution, up to rounding. */
double spore_inertia_longest_drift(const SporeInertia *inertia, SporeQuat orientation, SporeVec3 spin);

#endif
