/* How large a step an explicit integrator can take. */
#ifndef SPORE_SIM_STEP_LIMIT_H
#define SPORE_SIM_STEP_LIMIT_H

#include "core/sim/model.h"

typedef struct SporeStepLimit {
  double frequency; /* largest angular eigenfrequency of M^-1 K, rad/s */
  double damping;   /* largest eigenvalue of M^-1 D, 1/s */
  double dt_s;      /* largest stable step of symplectic Euler; infinite where nothing is stiff */
} SporeStepLimit;

/* By power iteration on M^-1 K and M^-1 D at (q, v), blocks in `held` (held_count, ascending) kept still. With damping
 * d and frequency w, symplectic Euler is stable while w^2 h^2 + 2 d h < 4; contacts and links may use 1 of that (see
 * SporeSoftening), so dt_s is the root for 3. The iteration's value is a lower bound, so 2% are taken off. False: no
 * memory. */
bool spore_step_limit(const SporeModel *model, const double *q, const double *v, const uint32_t *held,
                      size_t held_count, SporeStepLimit *limit, SporeError *error);

#endif
