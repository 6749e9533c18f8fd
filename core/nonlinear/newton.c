/* Newton's method with inexact linear solutions, a line search and a watchdog.
 *
 * Where it creeps, three things help that cost too much, or may lead astray, elsewhere: the whole of -dr/dx in place of
 * A where forces depend on others, or bodies bear much; what the last iterations tell (differences.h); and all that
 * buckles, as long as that leads downhill. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/math/vector.h"
#include "core/nonlinear/convergence.h"
#include "core/nonlinear/differences.h"
#include "core/nonlinear/line_search.h"
#include "core/nonlinear/trust.h"

#define LOOSEST 0.03
#define CREEPS 0.3   /* an iteration that leaves more of the residual wants the whole Jacobian */
#define STUCK 0.5    /* of the residual: so much an iteration leaves that gained nothing to speak of */
#define STUCK_MOST 2 /* such iterations in a row: then A itself lacks something */
#define GAIN 0.9     /* of the residual: what a step by differences leaves at most, or it is not taken */

/* Forcing term: how exactly the linear system needs solving. First roughly, then as the residual falls (Eisenstat and
 * Walker 1996, choice 2), never more exactly than the answer asks for. */
static double forcing_term(double norm, double previous, double target) {
  double eta = previous > 0 ? 0.9 * (norm / previous) * (norm / previous) : LOOSEST;
  return fmin(fmax(eta, 0.1 * target / norm), LOOSEST);
}

/* Where trust was given: point, direction, residual. See core/nonlinear/trust.h. */
typedef struct Mark {
  double *x, *d, *r;
} Mark;

/* What the method does where it creeps. */
typedef struct Creep {
  bool whole;   /* directions by the whole Jacobian. A alone leads from afar to the answer that has gained no energy */
  bool plain;   /* but for the next, by A: the last led nowhere */
  bool all;     /* the current linearisation is that of all that may buckle */
  size_t stuck; /* iterations in a row */
  bool met;     /* the differences know g */
  double *g;    /* step before the differences were taken into account */
  SporeDifferences differences;
} Creep;

typedef struct Newton {
  const SporeSystem *system;
  const SporeNonlinearOptions *options;
  double *x, *r;                       /* the caller's: point, and residual there */
  double *d;                           /* direction */
  double *trial, *trial_r, trial_norm; /* x + length d, the residual there and its norm */
  double *from;                        /* where x was before the last step */
  double *best;                        /* x of the least residual */
  double previous, near;               /* norm before the last step; see spore_convergence_near */
  Mark mark;
  SporeTrust trust;
  Creep creep;
  SporeConvergence test;
  SporeNonlinearResult result;
} Newton;

/* False: there is none, or the solver took more than it may. */
static bool find_direction(Newton *newton) {
  const SporeSystem *system = newton->system;
  SporeNonlinearResult *result = &newton->result;
  const SporeConvergence *test = &newton->test;
  double tolerance = forcing_term(test->norm, newton->previous, test->tolerance * test->scale_r);
  bool whole = newton->creep.whole && !newton->creep.plain;
  SporeLinearResult linear = whole && system->solve_whole
                                 ? system->solve_whole(system->data, newton->r, tolerance, newton->d)
                                 : system->solve(system->data, newton->r, tolerance, newton->d);
  result->linear_iterations += linear.iterations;
  result->unsolved += linear.status != SPORE_LINEAR_CONVERGED;
  result->indefinite |= linear.status == SPORE_LINEAR_INDEFINITE;
  size_t patience = newton->options->linear_patience;
  bool impatient = patience > 0 && result->linear_iterations >= patience;
  if (linear.status == SPORE_LINEAR_TOO_MANY && impatient) return false;
  return linear.status != SPORE_LINEAR_BREAKDOWN;
}

/* Whether no direction leads anywhere: a step that asks for what cannot be would take all iterations that it may, and
 * each of them many linear ones. */
static bool is_hopeless(const Newton *newton) {
  size_t patience = newton->options->patience, most = (patience > 0 ? patience : 1) * SPORE_HOPELESS_WORK;
  return newton->result.linear_iterations > most && newton->test.least > SPORE_HOPELESS * newton->test.scale_r;
}

/* Where the last step began; NULL: there was none. */
static const double *before(const Newton *newton) { return newton->result.iterations > 0 ? newton->from : NULL; }

static void linearise(Newton *newton) {
  const SporeSystem *system = newton->system;
  Creep *creep = &newton->creep;
  creep->all = creep->stuck >= STUCK_MOST && system->switches && system->linearise_whole;
  if (creep->all) system->linearise_whole(system->data, newton->x, before(newton));
  else system->linearise(system->data, newton->x, before(newton));
  newton->result.linearisations++;
}

/* The direction by the current linearisation, and by A where what buckles leads uphill. False: there is none. */
static bool point_down(Newton *newton) {
  const SporeSystem *system = newton->system;
  if (!find_direction(newton)) return false;
  if (!newton->creep.all || spore_vector_dot(system->count, newton->r, newton->d) > 0) return true;
  system->linearise(system->data, newton->x, before(newton));
  newton->result.linearisations++;
  return find_direction(newton);
}

/* The residual at x + d. */
static void evaluate(Newton *newton) {
  const SporeSystem *system = newton->system;
  size_t n = system->count;
  assert(newton->trial != newton->x || n == 0);
  memcpy(newton->trial, newton->x, n * sizeof *newton->trial);
  spore_vector_add_scaled(n, newton->trial, 1, newton->d);
  system->residual(system->data, newton->trial, newton->trial_r);
  newton->result.evaluations++;
  newton->trial_norm = system->norm(system->data, newton->trial_r);
}

/* Tries the step that the differences make of d; true: it is a good one, and now d and the trial are its. */
static bool accelerate(Newton *newton) {
  size_t n = newton->system->count;
  Creep *creep = &newton->creep;
  memcpy(creep->g, newton->d, n * sizeof *creep->g);
  spore_differences_meet(&creep->differences, creep->g);
  creep->met = true;
  if (creep->differences.count == 0) return false;
  spore_differences_accelerate(&creep->differences, creep->g, newton->d);
  evaluate(newton);
  if (newton->trial_norm <= GAIN * newton->test.norm) return true;
  memcpy(newton->d, creep->g, n * sizeof *creep->g);
  spore_differences_forget(&creep->differences);
  spore_differences_meet(&creep->differences, creep->g);
  return false;
}

/* Evaluates the full step, and says what it tells of the method's pace. True: the step is to be taken as it is. */
static bool try_step(Newton *newton) {
  const SporeSystem *system = newton->system;
  Creep *creep = &newton->creep;
  bool accelerated = false;
  creep->met = false;
  if (system->weigh && system->switches && creep->stuck >= STUCK_MOST) accelerated = accelerate(newton);
  else spore_differences_forget(&creep->differences);
  if (!accelerated) evaluate(newton);
  double norm = newton->test.norm, reached = newton->trial_norm;
  creep->whole |= !(reached <= CREEPS * norm);
  creep->stuck = reached > STUCK * norm ? creep->stuck + 1 : 0;
  return accelerated || reached <= 0.5 * (newton->trust.given ? newton->trust.norm : norm);
}

static double search(Newton *newton, bool tried, double near) {
  return spore_line_search(newton->system, newton->x, newton->d, newton->r, newton->test.norm, tried, near,
                           newton->trial, newton->trial_r, &newton->trial_norm, &newton->result.evaluations);
}

/* Trust was not made good: back, and along the line. */
static double go_back(Newton *newton) {
  size_t n = newton->system->count;
  newton->trust.given = false;
  newton->trust.failures++;
  memcpy(newton->x, newton->mark.x, n * sizeof *newton->x);
  memcpy(newton->r, newton->mark.r, n * sizeof *newton->r);
  memcpy(newton->d, newton->mark.d, n * sizeof *newton->d);
  newton->test.norm = newton->trust.norm;
  return search(newton, false, newton->near);
}

/* A step that increases the residual is taken on trust where it overshoots; else the line is searched. */
static double trust_or_search(Newton *newton, double step) {
  size_t n = newton->system->count;
  bool overshoots = spore_vector_dot(n, newton->trial_r, newton->d) < 0 && isfinite(newton->trial_norm);
  if (!newton->system->switches && overshoots && newton->trust.failures < SPORE_TRUST_FAILURES) {
    spore_trust_give(&newton->trust, step, newton->test.norm);
    memcpy(newton->mark.x, newton->x, n * sizeof *newton->x);
    memcpy(newton->mark.r, newton->r, n * sizeof *newton->r);
    memcpy(newton->mark.d, newton->d, n * sizeof *newton->d);
    return 1;
  }
  /* What buckles grows slowly, by steps of the same length, unless the search may go beyond them. */
  return search(newton, true, newton->creep.stuck >= STUCK_MOST ? HUGE_VAL : newton->near);
}

/* The length of the step along d that the trial then stands at; 0: no length helps. */
static double choose_length(Newton *newton) {
  bool good = try_step(newton);
  double step = sqrt(newton->system->dot(newton->system->data, newton->d, newton->d));
  if (good) newton->trust.given = false;
  else if (!newton->trust.given) return trust_or_search(newton, step);
  else if (!spore_trust_is_promising(&newton->trust, step, newton->trial_norm)) return go_back(newton);
  return 1;
}

static void take_step(Newton *newton, double length) {
  const SporeSystem *system = newton->system;
  Creep *creep = &newton->creep;
  size_t n = system->count;
  if (creep->met) spore_differences_leave(&creep->differences, creep->g, length, newton->d);
  memcpy(newton->from, newton->x, n * sizeof *newton->from);
  memcpy(newton->x, newton->trial, n * sizeof *newton->x);
  memcpy(newton->r, newton->trial_r, n * sizeof *newton->r);
  creep->plain = false;
  newton->previous = newton->test.norm;
  spore_convergence_step(&newton->test, system, newton->x, newton->d, length, newton->trial_norm, &newton->result);
  if (newton->test.norm <= newton->test.least) memcpy(newton->best, newton->x, n * sizeof *newton->best);
}

/* Where no length along the direction helps: back to A, which leads down in any case. False: it was A's. */
static bool fall_back(Creep *creep, bool switches) {
  if (creep->plain || !(creep->all || (creep->whole && switches))) return false;
  creep->plain = true;
  creep->stuck = 0;
  spore_differences_forget(&creep->differences);
  return true;
}

/* False: it was the last iteration. */
static bool iterate(Newton *newton) {
  const SporeSystem *system = newton->system;
  SporeNonlinearResult *result = &newton->result;
  if (before(newton) || !newton->options->linearised) linearise(newton);
  /* A residual no greater than rounding may still be more than that: one more iteration takes away what is left. */
  bool last = spore_convergence_rounding(&newton->test, system, newton->x, result), solved = result->converged;
  if (last && result->iterations == 0) return false;
  if (!point_down(newton)) return false;
  double length = choose_length(newton);
  if (length == 0) return fall_back(&newton->creep, system->switches);
  take_step(newton, length);
  result->converged |= solved;
  return !last;
}

static Newton lay_out(const SporeSystem *system, const SporeNonlinearOptions *options, double *x, double *r,
                      double *scratch) {
  size_t n = system->count;
  return (Newton){.system = system,
                  .options = options,
                  .x = x,
                  .r = r,
                  .d = scratch,
                  .trial = scratch + n,
                  .trial_r = scratch + 2 * n,
                  .mark = {scratch + 3 * n, scratch + 4 * n, scratch + 5 * n},
                  .from = scratch + 6 * n,
                  .best = scratch + 7 * n,
                  .creep = {.g = scratch + 8 * n}};
}

/* Goes back to the best point where the last is not it. */
static void end(Newton *newton) {
  const SporeSystem *system = newton->system;
  SporeConvergence *test = &newton->test;
  SporeNonlinearResult *result = &newton->result;
  size_t n = system->count;
  if (result->converged && test->norm > test->least)
    spore_convergence_return(test, n, newton->best, test->least, newton->x, result);
  else if (newton->trust.given && !(test->norm < newton->trust.norm))
    spore_convergence_return(test, n, newton->mark.x, newton->trust.norm, newton->x, result);
  spore_convergence_end(test, system, newton->x, result);
}

SporeNonlinearResult spore_newton(const SporeSystem *system, const SporeNonlinearOptions *options, double *x, double *r,
                                  double *scratch) {
  assert(system->residual && system->linearise && system->solve && system->norm && system->dot);
  assert(options->tolerance > 0);
  assert(x != r || system->count == 0);
  Newton newton = lay_out(system, options, x, r, scratch);
  SporeNonlinearResult *result = &newton.result;
  if (!spore_convergence_begin(&newton.test, system, options, system->norm(system->data, r), result)) return *result;
  if (system->weigh) spore_differences_begin(&newton.creep.differences, system, scratch + 9 * system->count);
  memcpy(newton.best, x, system->count * sizeof *x);
  newton.near = spore_convergence_near(&newton.test, system);
  bool goes_on = true;
  while (goes_on && !result->converged && result->iterations < options->iterations && !is_hopeless(&newton) &&
         !spore_cancel_asked(system->cancel))
    goes_on = iterate(&newton);
  end(&newton);
  return *result;
}
