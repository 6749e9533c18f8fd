#include <assert.h>
#include <string.h>

#include "core/base/text.h"
#include "core/integrate/integrator.h"

/* q moves with v0, and v with the forces at q0. Contacts and links are taken as by symplectic Euler: their push moves
 * q at once, or no softening could hold them. */
static SporeStepResult step(const SporeDynamics *dynamics, const SporeSolverFields *fields, SporeHistory *history,
                            double h, const double *q0, const double *v0, double *q1, double *v1, double *scratch) {
  assert(h > 0 && q0 != q1 && v0 != v1);
  void *data = dynamics->data;
  size_t n = 3 * dynamics->block_count;
  double *force = scratch, *pushed = force + n, *change = pushed + n;
  memcpy(pushed, v0, n * sizeof *v0);
  if (dynamics->soften(data, h, false)) {
    memset(force, 0, n * sizeof *force);
    dynamics->set_time(data, h);
    dynamics->term_force(data, q0, v0, force);
    dynamics->kick(data, force, h, pushed);
  }
  dynamics->body_force(data, q0, v0, force);
  memset(change, 0, n * sizeof *change);
  dynamics->kick(data, force, h, change);
  dynamics->drift(data, q0, pushed, h, q1, v1);
  dynamics->carry(data, change, q1, v1);
  return (SporeStepResult){.converged = true, .force_evaluations = 1};
}

const SporeIntegrator spore_explicit_euler = {
    .name = "explicit_euler",
    .doc = N_("First order, one force evaluation a step; feeds energy into all that swings, so that only what is well "
              "damped stays bounded. For comparison."),
    .scratch = 3 * 3,
    .step = step,
};
