/* How large a step an explicit integrator can take. */
#ifndef SPORE_SIM_STEP_LIMIT_H
#define SPORE_SIM_STEP_LIMIT_H

#include "core/integrate/solver.h"
#include "core/body/model.h"

typedef struct SporeStepLimit {
  double frequency;  /* largest angular eigenfrequency of M^-1 K, rad/s */
  double damping;    /* largest eigenvalue of M^-1 D, 1/s */
  double dt_s;       /* largest stable step; infinite where nothing is stiff, 0 where no step is stable */
  double whole_dt_s; /* without any reserve: the smaller of what the modes of this frequency and of this damping bear;
                        explicit Euler bears at least so much */
} SporeStepLimit;

/* For the explicit method `kind`, by power iteration on M^-1 K and M^-1 D at (q, v), blocks in `held` (held_count,
 * ascending) kept still. With damping d and frequency w, a method is stable while w^2 h^2 + b d h < a (4 and 2 for
 * symplectic Euler: see SporeIntegrator); contacts and links may use 1 of that, so dt_s is the
 * root for a - 1. Explicit Euler is stable while h K is no more than D in any direction: dt_s is found by bisection.
 * The iteration's value is a lower bound, so 2% are taken off dt_s. False: no memory. */
bool spore_step_limit(const SporeModel *model, SporeIntegratorKind kind, const double *q, const double *v,
                      const uint32_t *held, size_t held_count, SporeStepLimit *limit, SporeError *error);

#endif
