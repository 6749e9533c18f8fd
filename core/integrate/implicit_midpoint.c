#include <assert.h>

#include "core/base/text.h"
#include "core/integrate/stage.h"

/* v at the middle from half a step of implicit Euler, and on along it: momentum changes by twice what half a step did.
 */
static SporeStepResult step(const SporeDynamics *dynamics, const SporeSolverFields *fields, SporeHistory *history,
                            double h, const double *q0, const double *v0, double *q1, double *v1, double *scratch) {
  assert(h > 0 && q0 != q1 && v0 != v1);
  size_t n = 3 * dynamics->block_count;
  double *v = scratch, *work = v + n;
  dynamics->set_time(dynamics->data, 0.5 * h);
  SporeStepResult result = spore_stage_solve(dynamics, fields, 0.5 * h, q0, v0, NULL, v, work);
  dynamics->drift(dynamics->data, q0, v, h, q1, v1);
  for (size_t i = 0; i < n; i++) work[i] = v[i] - v0[i];
  dynamics->carry(dynamics->data, work, q1, v1);
  return result;
}

const SporeIntegrator spore_implicit_midpoint = {
    .name = "implicit_midpoint",
    .doc = N_("Second order, stable at any step and damps nothing by itself: motion that it cannot resolve rings on. "
              "Implicit Euler steps in where contacts are stiff."),
    .implicit = true,
    .damping = SPORE_DAMPING_NEUTRAL,
    .scratch = 3 * (1 + SPORE_STAGE_SCRATCH),
    .step = step,
};
