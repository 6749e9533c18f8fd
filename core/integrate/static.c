/* Balance of forces in place of motion. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/text.h"
#include "core/integrate/stage.h"
#include "core/nonlinear/line_search.h"

#define LOAD_STEPS_MAXIMUM 16
#define PARTS_EFFORT 4          /* of the iterations that the load as a whole may take */
#define PSEUDO_STEP_MAXIMUM 1e5 /* of h: beyond it inertia is nothing beside stiffness */
#define GROWTH_MINIMUM 3.0
#define GROWTH_MAXIMUM 100.0
#define SHRINKING 0.5
#define LINEAR_TOLERANCE 1e-3

/* Balance of forces, f(q) = 0, by Newton's method, damped in two ways: a line search, and the inertia of a pseudo-step
 * H that grows as the residual falls (pseudo-transient continuation; Kelley and Keyes 1998). Where a load is too large
 * for that it comes in parts: f(q) = (1 - s) f(q0), s from 0 to 1. Each iteration moves q = drift(base, x, h) with r =
 * H^2/h (f - (1 - s) f0) and A = M + H^2 K + H^2/h D. */
typedef struct Balance {
  const SporeDynamics *dynamics;
  double h, pseudo_step, load;
  double *base, *moved;         /* where it has got to, and the sum of x that took it there: a velocity */
  double *q, *v, *start, *work; /* start: f at q0 */
} Balance;

static double scale(const Balance *balance) { return balance->pseudo_step * balance->pseudo_step / balance->h; }

static void residual(void *data, const double *x, double *r) {
  Balance *balance = data;
  const SporeDynamics *dynamics = balance->dynamics;
  size_t n = 3 * dynamics->block_count;
  dynamics->drift(dynamics->data, balance->base, x, balance->h, balance->q, balance->v);
  for (size_t i = 0; i < n; i++) balance->v[i] = balance->moved[i] + x[i];
  dynamics->force(dynamics->data, balance->q, balance->v, r);
  for (size_t i = 0; i < n; i++) r[i] = scale(balance) * (r[i] - (1 - balance->load) * balance->start[i]);
}

/* Goes on from where x leads. */
static void move(Balance *balance, const double *x) {
  const SporeDynamics *dynamics = balance->dynamics;
  dynamics->drift(dynamics->data, balance->base, x, balance->h, balance->base, balance->v);
  for (size_t i = 0; i < 3 * dynamics->block_count; i++) balance->moved[i] += x[i];
  dynamics->set_mass(dynamics->data, balance->base);
}

static double dual_norm(void *data, const double *r) {
  Balance *balance = data;
  size_t n = 3 * balance->dynamics->block_count;
  memset(balance->work, 0, n * sizeof(double));
  balance->dynamics->kick(balance->dynamics->data, r, 1, balance->work);
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += r[i] * balance->work[i];
  return sqrt(sum);
}

/* The pseudo-step H after a step of the line search: H grows as the residual falls, and shrinks where the step was
 * cut. */
static void change_pseudo_step(Balance *balance, double length, double before, double after) {
  assert(length > 0);
  double factor = length < 1 ? SHRINKING : fmin(fmax(before / after, GROWTH_MINIMUM), GROWTH_MAXIMUM);
  balance->pseudo_step = fmin(balance->pseudo_step * factor, PSEUDO_STEP_MAXIMUM * balance->h);
}

/* Over all parts of the load. */
static size_t most_iterations(const SporeSolverFields *fields) {
  return PARTS_EFFORT * (size_t)fields->newton_iterations;
}

/* To balance at one load, from `base`. False: not reached. scratch: rest, d, r, trial, trial_r, and those of the linear
 * solver. */
static bool balance_load(Balance *balance, const SporeSolverFields *fields, double wanted, double *scratch,
                         SporeStepResult *result) {
  assert(balance->pseudo_step > 0 && balance->load > 0 && balance->load <= 1);
  const SporeDynamics *dynamics = balance->dynamics;
  size_t n = 3 * dynamics->block_count;
  double *rest = scratch, *d = rest + n, *r = d + n, *trial = r + n, *trial_r = trial + n, *linear = trial_r + n;
  SporeSystem system = {
      .data = balance, .count = n, .cancel = dynamics->cancel, .residual = residual, .norm = dual_norm};
  SporeLinearOperator operator= {dynamics->data, n, dynamics->multiply, dynamics->precondition, dynamics->cancel};
  double norm = 0;
  memset(rest, 0, n * sizeof *rest);
  for (int64_t i = 0;; i++) {
    residual(balance, rest, r);
    result->force_evaluations++;
    norm = dual_norm(balance, r);
    result->residual = wanted > 0 ? norm / scale(balance) / wanted : norm;
    if (!isfinite(norm) || spore_cancel_asked(dynamics->cancel)) return false;
    if (norm <= fields->tolerance * wanted * scale(balance)) return true;
    if (i == fields->newton_iterations || result->newton_iterations == most_iterations(fields)) break;
    double c2 = balance->pseudo_step * balance->pseudo_step;
    dynamics->linearise(dynamics->data, balance->q, NULL, balance->moved, c2 / balance->h, c2);
    result->linearisations++;
    if (norm <= dynamics->rounding(dynamics->data, balance->h, false)) return true;
    SporeLinearResult solved = spore_pcg(&operator, r, LINEAR_TOLERANCE, (size_t)fields->linear_iterations, d, linear);
    result->newton_iterations++;
    result->linear_iterations += solved.iterations;
    result->unsolved += solved.status != SPORE_LINEAR_CONVERGED;
    double after = 0, length = spore_line_search(&system, rest, d, r, norm, false, 0, trial, trial_r, &after,
                                                 &result->force_evaluations);
    if (length == 0) break;
    move(balance, trial);
    change_pseudo_step(balance, length, norm, after);
  }
  /* Whether the residual is down to rounding, by the last linearisation. */
  return result->linearisations > 0 && norm <= dynamics->rounding(dynamics->data, balance->h, true);
}

/* A body that nothing holds has no balance. It creeps: each step starts from rest and keeps the displacement of that
 * one step. */
static SporeStepResult creep(const SporeDynamics *dynamics, const SporeSolverFields *fields, double h, const double *q0,
                             double *q1, double *v1, double *scratch) {
  size_t n = 3 * dynamics->block_count;
  double *rest = scratch, *v = rest + n, *work = v + n;
  memset(rest, 0, n * sizeof *rest);
  SporeStepResult result = spore_stage_solve(dynamics, fields, h, q0, rest, NULL, v, work);
  dynamics->drift(dynamics->data, q0, v, h, q1, v1);
  return result;
}

static SporeStepResult step(const SporeDynamics *dynamics, const SporeSolverFields *fields, SporeHistory *history,
                            double h, const double *q0, const double *v0, double *q1, double *v1, double *scratch) {
  assert(h > 0);
  if (!dynamics->held) return creep(dynamics, fields, h, q0, q1, v1, scratch);
  size_t n = 3 * dynamics->block_count;
  Balance balance = {.dynamics = dynamics, .h = h};
  balance.base = scratch;
  balance.q = balance.base + 2 * n;
  balance.v = balance.q + 2 * n;
  balance.start = balance.v + n;
  balance.work = balance.start + n;
  balance.moved = balance.work + n;
  double *work = balance.moved + n, pseudo_step = history->step_s > 0 ? fmax(history->step_s, h) : h;
  memset(balance.moved, 0, n * sizeof *balance.moved);
  dynamics->force(dynamics->data, q0, balance.moved, balance.start);
  double wanted = fmax(dual_norm(&balance, balance.start), dynamics->gravity_momentum);
  SporeStepResult result = {.force_evaluations = 1};
  for (int parts = 1; parts <= LOAD_STEPS_MAXIMUM && !result.converged; parts *= 2) {
    if (result.newton_iterations == most_iterations(fields) || spore_cancel_asked(dynamics->cancel)) break;
    memcpy(balance.base, q0, dynamics->q_count * sizeof *q0);
    memset(balance.moved, 0, n * sizeof *balance.moved);
    dynamics->set_mass(dynamics->data, q0);
    balance.pseudo_step = pseudo_step;
    result.converged = true;
    for (int part = 1; part <= parts && result.converged; part++) {
      balance.load = (double)part / parts;
      result.converged = balance_load(&balance, fields, wanted, work, &result);
    }
    pseudo_step = h; /* what was learnt before does not hold here */
  }
  dynamics->keep(dynamics->data, &(SporeEquation){.load = wanted, .qa = balance.base, .v = balance.moved});
  history->step_s = result.converged ? balance.pseudo_step : 0;
  memcpy(q1, balance.base, dynamics->q_count * sizeof *q1);
  memcpy(v1, balance.moved, n * sizeof *v1);
  return result;
}

const SporeIntegrator spore_static = {
    .name = "static",
    .doc = N_("No inertia and no damping of its own: every step finds where forces balance. For what is held, by a pin "
              "or a link, and moved slowly; what only contacts hold creeps."),
    .implicit = true,
    .remembers = true,
    .chooses_step = true,
    .damping = SPORE_DAMPING_FULL,
    .scratch = 3 * (13 + SPORE_STAGE_SCRATCH),
    .step = step,
};
