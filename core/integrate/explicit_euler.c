/* Explicit Euler. */
#include <assert.h>
#include <string.h>

#include "core/base/text.h"
#include "core/integrate/integrator.h"

/* q moves with v0, and v with the forces at q0. */
static SporeStepResult step(const SporeDynamics *dynamics, const SporeSolverFields *fields, SporeHistory *history,
                            double h, const double *q0, const double *v0, double *q1, double *v1, double *scratch) {
  assert(h > 0 && q0 != q1 && v0 != v1);
  void *data = dynamics->data;
  size_t n = 3 * dynamics->block_count;
  double *force = scratch, *change = force + n;
  dynamics->force(data, q0, v0, force);
  memset(change, 0, n * sizeof *change);
  dynamics->kick(data, force, h, change);
  dynamics->drift(data, q0, v0, h, q1, v1);
  dynamics->carry(data, change, q1, v1);
  return (SporeStepResult){.converged = true, .force_evaluations = 1};
}

const SporeIntegrator spore_explicit_euler = {
    .name = "explicit_euler",
    .doc = N_("First order, one force evaluation a step; feeds energy into all that swings, so that only what is well "
              "damped stays bounded. For comparison."),
    .scratch = 3 * 2,
    .step = step,
};
