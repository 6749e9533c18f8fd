#include <string.h>

#include "core/base/text.h"
#include "core/integrate/integrator.h"

/* v1 = v0 + h M^-1 f(q0, v0); q1 = q0 + h v1. Contacts and links push on the velocity that the bodies' own forces
 * lead to. */
static SporeStepResult step(const SporeDynamics *dynamics, const SporeSolverFields *fields, double h, const double *q0,
                            const double *v0, double *q1, double *v1, double *scratch) {
  size_t n = 3 * dynamics->block_count;
  double *force = scratch, *kicked = scratch + n;
  dynamics->body_force(dynamics->data, q0, v0, force);
  memcpy(kicked, v0, n * sizeof *v0);
  dynamics->kick(dynamics->data, force, h, kicked);
  if (dynamics->term_force(dynamics->data, q0, kicked, h, force)) dynamics->kick(dynamics->data, force, h, kicked);
  dynamics->drift(dynamics->data, q0, kicked, h, q1, v1);
  return (SporeStepResult){.converged = true, .force_evaluations = 1};
}

const SporeIntegrator spore_symplectic_euler = {
    .name = "symplectic_euler",
    .doc =
        N_("First order, one force evaluation a step; conserves energy well, but needs small steps where it is stiff."),
    .implicit = false,
    .scratch = 3 * 2,
    .step = step,
};
