/* Balance of forces in place of motion. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/text.h"
#include "core/math/vector.h"
#include "core/integrate/stage.h"
#include "core/nonlinear/line_search.h"
#include "core/nonlinear/trust.h"

#define LOAD_STEPS_MAXIMUM 16
#define PARTS_EFFORT 4          /* of the iterations that the load as a whole may take */
#define PSEUDO_STEP_MAXIMUM 1e5 /* of h: beyond it inertia is nothing beside stiffness */
#define GROWTH_MINIMUM 3.0
#define GROWTH_MAXIMUM 100.0
#define SHRINKING 0.5
#define LINEAR_TOLERANCE 1e-3

/* Balance of forces, f(q) = 0, by Newton's method, damped in two ways: a line search, and the inertia of a pseudo-step
 * H that grows as the residual falls (pseudo-transient continuation; Kelley and Keyes 1998). The first attempt has H so
 * long that there is no inertia; the next begin with a short H. Where a load is too large for that it comes in parts:
 * f(q) = (1 - s) f(q0), s from 0 to 1. Each iteration moves q = drift(base, x, h) with r = H^2/h (f - (1 - s) f0) and A
 * = M + H^2 K + H^2/h D. */
typedef struct Balance {
  const SporeDynamics *dynamics;
  double h, pseudo_step, load;
  double *base, *moved;         /* where it has got to, and the sum of x that took it there: a velocity */
  double *q, *v, *start, *work; /* start: f at q0 */
  double *from;                 /* where it was before the last iteration */
  bool came;                    /* by an iteration with this load, from there */
} Balance;

/* Newton's method at one load. */
typedef struct Search {
  SporeSystem system;
  double *rest, *d, *r; /* zeros: where it is; the step; the residual there */
  double *trial, *trial_r;
  double norm, after; /* of the residual where it is, and at the trial */
  SporeTrust trust;
  double *base, *moved, *trusted; /* where trust was given, and the step that was taken on it */
} Search;

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

/* The pseudo-step H after a step of the line search: H grows as the residual falls, and shrinks where the step was
 * cut. */
static void change_pseudo_step(Balance *balance, double length, double before, double after) {
  assert(length > 0);
  double factor = length < 1 ? SHRINKING : fmin(fmax(before / after, GROWTH_MINIMUM), GROWTH_MAXIMUM);
  balance->pseudo_step = fmin(balance->pseudo_step * factor, PSEUDO_STEP_MAXIMUM * balance->h);
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
  } else if (!balance->dynamics->switches && trust->failures < SPORE_TRUST_FAILURES && isfinite(search->after) &&
             spore_vector_dot(n, search->trial_r, search->d) < 0) {
    give_trust(balance, search, step);
    return 1;
  }
  return spore_line_search(&search->system, search->rest, search->d, search->r, search->norm, tried, 0, search->trial,
                           search->trial_r, &search->after, evaluations);
}

/* Over all parts of the load. */
static size_t most_iterations(const SporeSolverFields *fields) {
  return PARTS_EFFORT * (size_t)fields->newton_iterations;
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
  memset(search.rest, 0, n * sizeof *search.rest);
  return search;
}

/* To balance at one load, from `base`. False: not reached. scratch: the search's, and that of the linear solver. */
static bool balance_load(Balance *balance, const SporeSolverFields *fields, double wanted, double *scratch,
                         SporeStepResult *result) {
  assert(balance->pseudo_step > 0 && balance->load > 0 && balance->load <= 1);
  const SporeDynamics *dynamics = balance->dynamics;
  size_t n = 3 * dynamics->block_count;
  Search search = begin_search(balance, scratch);
  double *linear = search.trusted + n;
  SporeLinearOperator operator= {dynamics->data, n, dynamics->multiply, dynamics->precondition, dynamics->cancel};
  bool stirs = false; /* the last iteration left more than half of the residual: along what is stiff that is rounding */
  balance->came = false;
  for (int64_t i = 0;; i++) {
    residual(balance, search.rest, search.r);
    result->force_evaluations++;
    search.norm = dual_norm(balance, search.r);
    result->residual = wanted > 0 ? search.norm / scale(balance) / wanted : search.norm;
    if (!isfinite(search.norm) || spore_cancel_asked(dynamics->cancel)) return false;
    if (search.norm <= fields->tolerance * wanted * scale(balance)) return true;
    if (i == fields->newton_iterations || result->newton_iterations == most_iterations(fields)) break;
    double c2 = balance->pseudo_step * balance->pseudo_step;
    dynamics->linearise(dynamics->data, balance->q, balance->came ? balance->from : NULL, balance->moved,
                        c2 / balance->h, c2);
    result->linearisations++;
    if (search.norm <= dynamics->rounding(dynamics->data, balance->h, stirs)) return true;
    SporeLinearResult solved =
        spore_pcg(&operator, search.r, LINEAR_TOLERANCE, (size_t)fields->linear_iterations, search.d, linear);
    result->newton_iterations++;
    result->linear_iterations += solved.iterations;
    result->unsolved += solved.status != SPORE_LINEAR_CONVERGED;
    double length = take_step(balance, &search, &result->force_evaluations);
    if (length == 0) break;
    stirs = !(search.after <= 0.5 * search.norm);
    move(balance, search.trial);
    if (!search.trust.given) change_pseudo_step(balance, length, search.norm, search.after);
  }
  /* Whether the residual is down to rounding, by the last linearisation. */
  return result->linearisations > 0 && search.norm <= dynamics->rounding(dynamics->data, balance->h, true);
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
  balance.from = balance.moved + n;
  double *work = balance.from + 2 * n,
         pseudo_step = history->step_s > 0 ? fmax(history->step_s, h) : PSEUDO_STEP_MAXIMUM * h;
  memset(balance.moved, 0, n * sizeof *balance.moved);
  dynamics->force(dynamics->data, q0, balance.moved, balance.start);
  double wanted = fmax(dual_norm(&balance, balance.start), dynamics->gravity_momentum);
  SporeStepResult result = {.force_evaluations = 1};
  for (int parts = 1; parts <= LOAD_STEPS_MAXIMUM && !result.converged;) {
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
    if (pseudo_step == h) parts *= 2;
    pseudo_step = h; /* boldly first, then with care */
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
    .scratch = 3 * (19 + SPORE_STAGE_SCRATCH),
    .step = step,
};
