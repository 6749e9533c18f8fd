/* Swing: how much energy an integrator takes from one mass that swings on a spring, or as a pendulum. */
#ifndef SPORE_SIM_SWING_H
#define SPORE_SIM_SWING_H

#include "core/integrate/integrator.h"
#include "core/math/vec3.h"

/* A mass of 1 kg that swings about the origin, without damping. */
typedef struct SporeSwing {
  double frequency; /* rad/s, of small swings */
  double length;    /* m, of a pendulum: it hangs along -y where gravity is frequency^2 length; 0: a spring */
  double stiffness; /* N/m, of the pendulum's rod */
  SporeVec3 position, velocity; /* at the start, m and m/s */
} SporeSwing;

/* Steps the swing by the method, in steps of h seconds, for whole periods of a second at least.
 * *share: of the energy, that the method takes away in a second, 0..1. False: no memory, the swing is too slow for the
 * step, or the step is not stable. fields: of the solver; nonlinear and tolerance are not used. */
bool spore_swing_damping(const SporeSwing *swing, SporeIntegratorKind kind, const SporeSolverFields *fields, double h,
                         double *share);

#endif
