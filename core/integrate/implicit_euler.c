#include <assert.h>

#include "core/base/text.h"
#include "core/integrate/stage.h"

/* The history's a is how the last step changed v: the next one's guess. */
static SporeStepResult step(const SporeDynamics *dynamics, const SporeSolverFields *fields, SporeHistory *history,
                            double h, const double *q0, const double *v0, double *q1, double *v1, double *scratch) {
  assert(h > 0 && q0 != q1 && v0 != v1);
  double *v = scratch, *work = v + 3 * dynamics->block_count;
  dynamics->set_shape(dynamics->data, q0, h);
  const double *change = history->step_s == h ? history->a : NULL;
  SporeStepResult result = spore_stage_solve(dynamics, fields, h, q0, v0, change, v, work);
  dynamics->drift(dynamics->data, q0, v, h, q1, v1);
  for (size_t i = 0; history->a && i < 3 * dynamics->block_count; i++) history->a[i] = v[i] - v0[i];
  history->step_s = h;
  return result;
}

const SporeIntegrator spore_implicit_euler = {
    .name = "implicit_euler",
    .doc = N_("First order, stable at any step; damps fast motion, and solves a nonlinear system every step."),
    .implicit = true,
    .remembers = true,
    .damping = SPORE_DAMPING_FULL,
    .scratch = 3 * (1 + SPORE_STAGE_SCRATCH),
    .step = step,
};
