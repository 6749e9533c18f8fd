/* Velocity Verlet. */
#include <assert.h>
#include <string.h>

#include "core/base/text.h"
#include "core/integrate/integrator.h"

/* Kick, drift, kick (velocity Verlet). Forces at the end that depend on velocity see it as the first kick, made twice,
 * has it; that is right to second order. The bodies' own are kept as the history's a for the next step's first kick. */
static SporeStepResult step(const SporeDynamics *dynamics, const SporeSolverFields *fields, SporeHistory *history,
                            double h, const double *q0, const double *v0, double *q1, double *v1, double *scratch) {
  assert(h > 0 && q0 != q1 && v0 != v1);
  assert(history->a);
  void *data = dynamics->data;
  size_t n = 3 * dynamics->block_count;
  double *force = scratch, *half = force + n, *change = half + n, *predicted = change + n;
  SporeStepResult result = {.converged = true, .force_evaluations = 1};
  if (history->step_s > 0) {
    memcpy(force, history->a, n * sizeof *force);
  } else {
    dynamics->body_force(data, q0, v0, force);
    result.force_evaluations++;
  }
  dynamics->set_time(data, 0);
  dynamics->term_force(data, q0, v0, force);
  memset(change, 0, n * sizeof *change);
  dynamics->kick(data, force, 0.5 * h, change);
  for (size_t i = 0; i < n; i++) half[i] = v0[i] + change[i];
  dynamics->drift(data, q0, half, h, q1, v1);
  memcpy(predicted, v1, n * sizeof *v1);
  dynamics->carry(data, change, q1, predicted);
  dynamics->body_force(data, q1, predicted, force);
  memcpy(history->a, force, n * sizeof *force);
  history->step_s = h;
  dynamics->set_time(data, h);
  dynamics->term_force(data, q1, predicted, force);
  dynamics->set_mass(data, q1);
  dynamics->kick(data, force, 0.5 * h, v1);
  return result;
}

const SporeIntegrator spore_verlet = {
    .name = "verlet",
    .doc = N_("Second order, one force evaluation a step; conserves energy well over any time, but needs small steps "
              "where it is stiff. For particles."),
    .remembers = true,
    .swings = true,
    .stable_square = 4,
    .stable_damping = 4,
    .shift = 0.5,
    .scratch = 3 * 4,
    .step = step,
};
