/* Symplectic Euler. */
#include <assert.h>
#include <string.h>

#include "core/base/text.h"
#include "core/integrate/integrator.h"

/* v1 = v0 + h M^-1 f(q0, v0); q1 = q0 + h v1. */
static SporeStepResult step(const SporeDynamics *dynamics, const SporeSolverFields *fields, SporeHistory *history,
                            double h, const double *q0, const double *v0, double *q1, double *v1, double *scratch) {
  assert(h > 0 && q0 != q1 && v0 != v1);
  void *data = dynamics->data;
  size_t n = 3 * dynamics->block_count;
  double *force = scratch, *kicked = scratch + n;
  dynamics->force(data, q0, v0, force);
  memcpy(kicked, v0, n * sizeof *v0);
  dynamics->kick(data, force, h, kicked);
  dynamics->drift(data, q0, kicked, h, q1, v1);
  return (SporeStepResult){.converged = true, .force_evaluations = 1};
}

const SporeIntegrator spore_symplectic_euler = {
    .name = "symplectic_euler",
    .doc =
        N_("First order, one force evaluation a step; conserves energy well, but needs small steps where it is stiff."),
    .swings = true,
    .stable_square = 4,
    .stable_damping = 2,
    .shift = 1,
    .scratch = 3 * 2,
    .step = step,
};
