/* Balance of forces in place of motion. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/text.h"
#include "core/integrate/stage.h"
#include "core/math/vector.h"
#include "core/nonlinear/line_search.h"
#include "core/nonlinear/trust.h"

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
 * Where something may buckle, K is the whole stiffness, which is negative there. H is so small that A is positive
 * definite all the same: then each iteration goes down in energy, as a body without inertia would move, away from a
 * balance that is not stable and to the one that the load leads to; near a stable balance H is large, and convergence
 * is that of Newton's method. With the negative part left out of A it would be slow wherever something is compressed.
 *
 * Elsewhere the first attempt has H so long that there is no inertia, and takes full steps on trust; the next one
 * begins with a short H. */
typedef struct Balance {
  const SporeDynamics *dynamics;
  const SporeSolverFields *fields;
  double h, pseudo_step;
  double wanted;          /* norm of the load, N / kg^1/2 */
  size_t iterations_most; /* of the step so far, at which the attempt ends */
  double *base, *moved;   /* where it has got to, and the sum of x that took it there: a velocity */
  double *q, *v, *work;
  double *from; /* where it was before the last iteration */
  bool came;    /* by an iteration, from there */
} Balance;

/* Newton's method in one attempt. */
typedef struct Search {
  SporeSystem system;
  double *rest, *d, *r; /* zeros: where it is; the step; the residual there */
  double *trial, *trial_r, *linear;
  double norm, after; /* of the residual where it is, and at the trial */
  bool stirs;         /* the last iteration left more than half of the residual: along what is stiff that is rounding */
  SporeTrust trust;
  double *base, *moved, *trusted; /* where trust was given, and the step that was taken on it */
} Search;

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
  memcpy(balance->from, balance->base, dynamics->q_count * sizeof *balance->from);
  balance->came = true;
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
    dynamics->linearise(dynamics->data, balance->base, balance->came ? balance->from : NULL, balance->moved,
                        c2 / balance->h, c2);
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

static double kinetic_length(const Balance *balance, const double *d) {
  balance->dynamics->mass_multiply(balance->dynamics->data, d, balance->work);
  return sqrt(spore_vector_dot(3 * balance->dynamics->block_count, d, balance->work));
}

static void give_trust(const Balance *balance, Search *search, double step) {
  size_t n = search->system.count;
  spore_trust_give(&search->trust, step, search->norm);
  memcpy(search->base, balance->base, balance->dynamics->q_count * sizeof *search->base);
  memcpy(search->moved, balance->moved, n * sizeof *search->moved);
  memcpy(search->trusted, search->d, n * sizeof *search->trusted);
}

/* Back to where trust was given. */
static void take_trust(Search *search, Balance *balance, size_t *evaluations) {
  const SporeDynamics *dynamics = balance->dynamics;
  size_t n = search->system.count;
  search->trust.given = false;
  search->trust.failures++;
  search->norm = search->trust.norm;
  memcpy(balance->base, search->base, dynamics->q_count * sizeof *search->base);
  memcpy(balance->moved, search->moved, n * sizeof *search->moved);
  memcpy(search->d, search->trusted, n * sizeof *search->d);
  dynamics->set_mass(dynamics->data, balance->base);
  residual(balance, search->rest, search->r);
  ++*evaluations;
}

/* Whether full steps may be trusted: not where forces set in and end, nor where the nearest balance is wanted. */
static bool may_trust(const Balance *balance, const Search *search) {
  return !balance->dynamics->switches && !balance->dynamics->buckles && search->trust.failures < SPORE_TRUST_FAILURES;
}

/* A step along d, to the trial: the full one where that halves the residual or deserves trust, else one along the line.
 * Returns its length, or 0 where no length helps. */
static double take_step(Balance *balance, Search *search, size_t *evaluations) {
  size_t n = search->system.count;
  SporeTrust *trust = &search->trust;
  memcpy(search->trial, search->d, n * sizeof *search->trial);
  residual(balance, search->trial, search->trial_r);
  ++*evaluations;
  search->after = dual_norm(balance, search->trial_r);
  double step = kinetic_length(balance, search->d);
  if (search->after <= 0.5 * (trust->given ? trust->norm : search->norm)) {
    trust->given = false;
    return 1;
  }
  if (trust->given && spore_trust_is_promising(trust, step, search->after)) return 1;
  bool tried = !trust->given;
  if (trust->given) {
    take_trust(search, balance, evaluations);
  } else if (may_trust(balance, search) && isfinite(search->after) &&
             spore_vector_dot(n, search->trial_r, search->d) < 0) {
    give_trust(balance, search, step);
    return 1;
  }
  return spore_line_search(&search->system, search->rest, search->d, search->r, search->norm, tried, 0, search->trial,
                           search->trial_r, &search->after, evaluations);
}

static Search begin_search(Balance *balance, double *scratch) {
  size_t n = 3 * balance->dynamics->block_count;
  Search search = {
      .system = {
          .data = balance, .count = n, .cancel = balance->dynamics->cancel, .residual = residual, .norm = dual_norm}};
  search.rest = scratch;
  search.d = search.rest + n;
  search.r = search.d + n;
  search.trial = search.r + n;
  search.trial_r = search.trial + n;
  search.base = search.trial_r + n;
  search.moved = search.base + 2 * n;
  search.trusted = search.moved + n;
  search.linear = search.trusted + n;
  memset(search.rest, 0, n * sizeof *search.rest);
  return search;
}

/* One iteration, from the residual where it is. False: it led nowhere. */
static bool iterate(Balance *balance, Search *search, SporeStepResult *result) {
  SporeLinearResult solved = solve(balance, search->r, search->d, search->linear);
  result->newton_iterations++;
  result->linear_iterations += solved.iterations;
  result->unsolved += solved.status == SPORE_LINEAR_TOO_MANY || solved.status == SPORE_LINEAR_BREAKDOWN;
  /* Terms that couple bodies are not in the factors, and may show only now that the matrix is not definite. */
  double length = 0;
  if (solved.status != SPORE_LINEAR_INDEFINITE) length = take_step(balance, search, &result->force_evaluations);
  if (length == 0) return false;
  search->stirs = !(search->after <= 0.5 * search->norm);
  move(balance, search->trial);
  if (!search->trust.given) change_pseudo_step(balance, length, search->norm, search->after);
  return true;
}

/* False: not reached. scratch: the search's, and that of the linear solver. */
static bool balance_forces(Balance *balance, double *scratch, SporeStepResult *result) {
  const SporeDynamics *dynamics = balance->dynamics;
  Search search = begin_search(balance, scratch);
  double norm = 0;
  for (;;) {
    force_after(balance, search.rest, search.r);
    result->force_evaluations++;
    norm = dual_norm(balance, search.r);
    result->residual = balance->wanted > 0 ? norm / balance->wanted : norm;
    if (!isfinite(norm) || spore_cancel_asked(dynamics->cancel)) return false;
    if (norm <= balance->fields->tolerance * balance->wanted) return true;
    if (result->newton_iterations >= balance->iterations_most || !linearise(balance, result)) break;
    search.norm = norm * scale(balance);
    if (search.norm <= dynamics->rounding(dynamics->data, balance->h, search.stirs)) return true;
    for (size_t i = 0; i < search.system.count; i++) search.r[i] *= scale(balance);
    if (!iterate(balance, &search, result)) {
      if (!dynamics->buckles) break;
      shrink_pseudo_step(balance);
    }
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

static void start_from(Balance *balance, const double *q0, double pseudo_step) {
  const SporeDynamics *dynamics = balance->dynamics;
  memcpy(balance->base, q0, dynamics->q_count * sizeof *q0);
  memset(balance->moved, 0, 3 * dynamics->block_count * sizeof *balance->moved);
  dynamics->set_mass(dynamics->data, q0);
  balance->pseudo_step = pseudo_step;
  balance->came = false;
}

static SporeStepResult step(const SporeDynamics *dynamics, const SporeSolverFields *fields, SporeHistory *history,
                            double h, const double *q0, const double *v0, double *q1, double *v1, double *scratch) {
  assert(h > 0);
  if (!dynamics->held) return creep(dynamics, fields, h, q0, q1, v1, scratch);
  size_t n = 3 * dynamics->block_count, most = EFFORT * (size_t)fields->newton_iterations;
  Balance balance = {.dynamics = dynamics, .fields = fields, .h = h};
  balance.base = scratch;
  balance.q = balance.base + 2 * n;
  balance.v = balance.q + 2 * n;
  balance.work = balance.v + n;
  balance.moved = balance.work + n;
  balance.from = balance.moved + n;
  double *work = balance.from + 2 * n;
  double first = history->step_s > 0 ? fmax(history->step_s, h) : dynamics->buckles ? h : PSEUDO_STEP_MAXIMUM * h;
  start_from(&balance, q0, first);
  dynamics->force(dynamics->data, q0, balance.moved, work);
  balance.wanted = fmax(dual_norm(&balance, work), dynamics->gravity_momentum);
  balance.iterations_most = dynamics->buckles ? most : (size_t)fields->newton_iterations;
  SporeStepResult result = {.force_evaluations = 1};
  result.converged = balance_forces(&balance, work, &result);
  if (!result.converged && !dynamics->buckles && !spore_cancel_asked(dynamics->cancel)) { /* now with care */
    start_from(&balance, q0, h);
    balance.iterations_most = most;
    result.converged = balance_forces(&balance, work, &result);
  }
  if (dynamics->keep)
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
    .scratch = 3 * (19 + SPORE_STAGE_SCRATCH),
    .step = step,
};
