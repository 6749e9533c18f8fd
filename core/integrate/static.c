/* Balance of forces in place of motion. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/text.h"
#include "core/integrate/stage.h"
#include "core/nonlinear/line_search.h"

#define EFFORT 16               /* of the iterations of a step, as the doc of newton_iterations says */
#define PSEUDO_STEP_MAXIMUM 1e5 /* of h: beyond it inertia is nothing beside stiffness */
#define GROWTH_MINIMUM 3.0
#define GROWTH_MAXIMUM 100.0
#define SHRINKING 0.5
/* Where the matrix is indefinite H is at most BUCKLING_STEP h, which most that buckles bears, and then half, again and
 * again. */
#define BUCKLING_STEP 4.0
#define INDEFINITE_SHRINKING 0.5
#define INDEFINITE_MOST 40
#define LINEAR_TOLERANCE 1e-3

/* Balance of forces, f(q) = 0, by Newton's method, damped in two ways: a line search, and the inertia of a pseudo-step
 * H that grows as the residual falls (pseudo-transient continuation; Kelley and Keyes 1998). Each iteration moves q =
 * drift(base, x, h) with r = H^2/h f and A = M + H^2 K + H^2/h D.
 *
 * K is the whole stiffness, which is negative where something buckles. H is so small that A is positive definite all
 * the same: then each iteration goes down in energy, as a body without inertia would move, away from a balance that is
 * not stable and to the one that the load leads to; near a stable balance H is large, and convergence is that of
 * Newton's method. With the negative part left out of A it would be slow wherever something is compressed. */
typedef struct Balance {
  const SporeDynamics *dynamics;
  const SporeSolverFields *fields;
  double h, pseudo_step;
  double wanted;        /* norm of the load, N / kg^1/2 */
  double *base, *moved; /* where it has got to, and the sum of x that took it there: a velocity */
  double *q, *v, *work;
} Balance;

static double scale(const Balance *balance) { return balance->pseudo_step * balance->pseudo_step / balance->h; }

static void force_after(Balance *balance, const double *x, double *f) {
  const SporeDynamics *dynamics = balance->dynamics;
  dynamics->drift(dynamics->data, balance->base, x, balance->h, balance->q, balance->v);
  for (size_t i = 0; i < 3 * dynamics->block_count; i++) balance->v[i] = balance->moved[i] + x[i];
  dynamics->force(dynamics->data, balance->q, balance->v, f);
}

static void residual(void *data, const double *x, double *r) {
  Balance *balance = data;
  force_after(balance, x, r);
  for (size_t i = 0; i < 3 * balance->dynamics->block_count; i++) r[i] *= scale(balance);
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

static void shrink_pseudo_step(Balance *balance) {
  balance->pseudo_step = fmin(INDEFINITE_SHRINKING * balance->pseudo_step, BUCKLING_STEP * balance->h);
}

/* The pseudo-step H after a step of the line search: H grows as the residual falls, and shrinks where the step was
 * cut. */
static void change_pseudo_step(Balance *balance, double length, double before, double after) {
  assert(length > 0);
  double factor = length < 1 ? SHRINKING : fmin(fmax(before / after, GROWTH_MINIMUM), GROWTH_MAXIMUM);
  balance->pseudo_step = fmin(balance->pseudo_step * factor, PSEUDO_STEP_MAXIMUM * balance->h);
}

/* Linearises where it has got to, with the largest pseudo-step that leaves the matrix definite. False: there is none.
 */
static bool linearise(Balance *balance, SporeStepResult *result) {
  assert(balance->pseudo_step > 0);
  const SporeDynamics *dynamics = balance->dynamics;
  for (int tries = 0; tries < INDEFINITE_MOST && !spore_cancel_asked(dynamics->cancel);
       tries++, shrink_pseudo_step(balance)) {
    double c2 = balance->pseudo_step * balance->pseudo_step;
    dynamics->linearise(dynamics->data, balance->base, NULL, balance->moved, c2 / balance->h, c2);
    result->linearisations++;
    if (dynamics->definite(dynamics->data)) return true;
  }
  return false;
}

/* By the whole of the Jacobian where friction slips. */
static SporeLinearResult solve(const Balance *balance, const double *r, double *d, double *scratch) {
  const SporeDynamics *dynamics = balance->dynamics;
  size_t most = (size_t)balance->fields->linear_iterations;
  SporeLinearOperator operator= {dynamics->data, 3 * dynamics->block_count, dynamics->multiply, dynamics->precondition,
                                 dynamics->cancel};
  if (dynamics->drags(dynamics->data)) {
    operator.multiply = dynamics->multiply_dragged;
    SporeLinearResult whole = spore_bicgstab(&operator, r, LINEAR_TOLERANCE, most / 2, d, scratch);
    if (whole.status == SPORE_LINEAR_CONVERGED) return whole;
    operator.multiply = dynamics->multiply;
  }
  return spore_pcg(&operator, r, LINEAR_TOLERANCE, most, d, scratch);
}

/* One iteration, from the force f at the base. */
static void iterate(Balance *balance, const double *rest, double *f, double *scratch, SporeStepResult *result) {
  size_t n = 3 * balance->dynamics->block_count;
  double *d = scratch, *trial = d + n, *trial_r = trial + n, *linear = trial_r + n;
  for (size_t i = 0; i < n; i++) f[i] *= scale(balance);
  SporeLinearResult solved = solve(balance, f, d, linear);
  result->linear_iterations += solved.iterations;
  result->unsolved += solved.status == SPORE_LINEAR_TOO_MANY || solved.status == SPORE_LINEAR_BREAKDOWN;
  SporeSystem system = {
      .data = balance, .count = n, .cancel = balance->dynamics->cancel, .residual = residual, .norm = dual_norm};
  double norm = dual_norm(balance, f), after = 0, length = 0;
  /* Terms that couple bodies are not in the factors, and may show only now that the matrix is not definite. */
  if (solved.status != SPORE_LINEAR_INDEFINITE)
    length = spore_line_search(&system, rest, d, f, norm, false, 0, trial, trial_r, &after, &result->force_evaluations);
  if (length == 0) {
    shrink_pseudo_step(balance);
    return;
  }
  move(balance, trial);
  change_pseudo_step(balance, length, norm, after);
}

/* False: not reached. scratch: rest, f, three of an iteration, and those of the linear solver. */
static bool balance_forces(Balance *balance, double *scratch, SporeStepResult *result) {
  const SporeDynamics *dynamics = balance->dynamics;
  const SporeSolverFields *fields = balance->fields;
  size_t n = 3 * dynamics->block_count;
  double *rest = scratch, *f = rest + n, *work = f + n, norm = 0;
  memset(rest, 0, n * sizeof *rest);
  for (;;) {
    force_after(balance, rest, f);
    result->force_evaluations++;
    norm = dual_norm(balance, f);
    result->residual = balance->wanted > 0 ? norm / balance->wanted : norm;
    if (!isfinite(norm) || spore_cancel_asked(dynamics->cancel)) return false;
    if (norm <= fields->tolerance * balance->wanted) return true;
    if (result->newton_iterations == EFFORT * (size_t)fields->newton_iterations || !linearise(balance, result)) break;
    if (norm * scale(balance) <= dynamics->rounding(dynamics->data, balance->h, false)) return true;
    iterate(balance, rest, f, work, result);
    result->newton_iterations++;
  }
  /* Whether the residual is down to rounding, by the last linearisation. */
  return result->linearisations > 0 && norm * scale(balance) <= dynamics->rounding(dynamics->data, balance->h, true);
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
  Balance balance = {.dynamics = dynamics, .fields = fields, .h = h};
  balance.base = scratch;
  balance.q = balance.base + 2 * n;
  balance.v = balance.q + 2 * n;
  balance.work = balance.v + n;
  balance.moved = balance.work + n;
  double *work = balance.moved + n;
  balance.pseudo_step = history->step_s > 0 ? fmax(history->step_s, h) : h;
  memset(balance.moved, 0, n * sizeof *balance.moved);
  memcpy(balance.base, q0, dynamics->q_count * sizeof *q0);
  dynamics->force(dynamics->data, q0, balance.moved, work);
  balance.wanted = fmax(dual_norm(&balance, work), dynamics->gravity_momentum);
  SporeStepResult result = {.force_evaluations = 1};
  result.converged = balance_forces(&balance, work, &result);
  dynamics->keep(dynamics->data, &(SporeEquation){.load = balance.wanted, .qa = balance.base, .v = balance.moved});
  history->step_s = result.converged ? balance.pseudo_step : 0;
  memcpy(q1, balance.base, dynamics->q_count * sizeof *q1);
  memcpy(v1, balance.moved, n * sizeof *v1);
  return result;
}

const SporeIntegrator spore_static = {
    .name = "static",
    .doc =
        N_("No inertia and no damping of its own: every step finds where forces balance. Where there are several "
           "such places, the one that the load leads to from the state before. For what is held, by a pin or a link, "
           "and moved slowly; what only contacts hold creeps."),
    .implicit = true,
    .remembers = true,
    .chooses_step = true,
    .damping = SPORE_DAMPING_FULL,
    .scratch = 3 * (12 + SPORE_STAGE_SCRATCH),
    .step = step,
};
