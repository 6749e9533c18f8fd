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

static void move(size_t n, const double *x, const double *d, double *to) {
  assert(to != x || n == 0);
  memcpy(to, x, n * sizeof *to);
  spore_vector_add_scaled(n, to, 1, d);
}

/* False: there is none, or the solver took more than it may. */
static bool direction(const SporeSystem *system, const SporeNonlinearOptions *options, const SporeConvergence *test,
                      double previous, const double *r, bool whole, double *d, SporeNonlinearResult *result) {
  double tolerance = forcing_term(test->norm, previous, test->tolerance * test->scale_r);
  SporeLinearResult linear = whole && system->solve_whole ? system->solve_whole(system->data, r, tolerance, d)
                                                          : system->solve(system->data, r, tolerance, d);
  result->linear_iterations += linear.iterations;
  result->unsolved += linear.status != SPORE_LINEAR_CONVERGED;
  result->indefinite |= linear.status == SPORE_LINEAR_INDEFINITE;
  bool impatient = options->linear_patience > 0 && result->linear_iterations >= options->linear_patience;
  if (linear.status == SPORE_LINEAR_TOO_MANY && impatient) return false;
  return linear.status != SPORE_LINEAR_BREAKDOWN;
}

/* Whether no direction leads anywhere: a step that asks for what cannot be would take all iterations that it may, and
 * each of them many linear ones. */
static bool is_hopeless(const SporeNonlinearOptions *options, const SporeConvergence *test,
                        const SporeNonlinearResult *result) {
  size_t most = (options->patience > 0 ? options->patience : 1) * SPORE_HOPELESS_WORK;
  return result->linear_iterations > most && test->least > SPORE_HOPELESS * test->scale_r;
}

/* What the method does where it creeps. */
typedef struct Creep {
  bool whole;   /* directions by the whole Jacobian. A alone leads from afar to the answer that has gained no energy */
  bool all;     /* the current linearisation is that of all that may buckle */
  size_t stuck; /* iterations in a row */
  bool met;     /* the differences know g */
  double *g;    /* step before the differences were taken into account */
  SporeDifferences differences;
} Creep;

/* from: where the last step began, or NULL. */
static void linearise(const SporeSystem *system, Creep *creep, const double *x, const double *from,
                      SporeNonlinearResult *result) {
  creep->all = creep->stuck >= STUCK_MOST && system->switches && system->linearise_whole;
  if (creep->all) system->linearise_whole(system->data, x, from);
  else system->linearise(system->data, x, from);
  result->linearisations++;
}

/* Residual at x + d. */
static double evaluate(const SporeSystem *system, const double *x, const double *d, double *trial, double *trial_r,
                       SporeNonlinearResult *result) {
  move(system->count, x, d, trial);
  system->residual(system->data, trial, trial_r);
  result->evaluations++;
  return system->norm(system->data, trial_r);
}

/* Tries the step that the differences make of d; true: it is a good one, and now d, trial, trial_r and *trial_norm are
 * its. */
static bool accelerate(const SporeSystem *system, Creep *creep, const double *x, double norm, double *d, double *trial,
                       double *trial_r, double *trial_norm, SporeNonlinearResult *result) {
  size_t n = system->count;
  memcpy(creep->g, d, n * sizeof *d);
  spore_differences_meet(&creep->differences, creep->g);
  creep->met = true;
  if (creep->differences.count == 0) return false;
  spore_differences_accelerate(&creep->differences, creep->g, d);
  *trial_norm = evaluate(system, x, d, trial, trial_r, result);
  if (*trial_norm <= GAIN * norm) return true;
  memcpy(d, creep->g, n * sizeof *d);
  spore_differences_forget(&creep->differences);
  spore_differences_meet(&creep->differences, creep->g);
  return false;
}

SporeNonlinearResult spore_newton(const SporeSystem *system, const SporeNonlinearOptions *options, double *x, double *r,
                                  double *scratch) {
  assert(system->residual && system->linearise && system->solve && system->norm && system->dot);
  assert(options->tolerance > 0);
  assert(x != r || system->count == 0);
  size_t n = system->count;
  double *d = scratch, *trial = scratch + n, *trial_r = scratch + 2 * n;
  Mark mark = {scratch + 3 * n, scratch + 4 * n, scratch + 5 * n};
  SporeTrust trust = {0};
  double *from = scratch + 6 * n; /* where x was before the last step */
  double *best = scratch + 7 * n; /* x of the least residual */
  Creep creep = {.g = scratch + 8 * n};
  SporeNonlinearResult result = {0};
  SporeConvergence test;
  if (!spore_convergence_begin(&test, system, options, system->norm(system->data, r), &result)) return result;
  if (system->weigh) spore_differences_begin(&creep.differences, system, scratch + 9 * n);
  memcpy(best, x, n * sizeof *x);
  double previous = 0, near = spore_convergence_near(&test, system);
  while (!result.converged && result.iterations < options->iterations && !is_hopeless(options, &test, &result) &&
         !spore_cancel_asked(system->cancel)) {
    const double *before = result.iterations > 0 ? from : NULL;
    if (before || !options->linearised) linearise(system, &creep, x, before, &result);
    /* A residual no greater than rounding may still be more than that: one more iteration takes away what is left. */
    bool last = spore_convergence_rounding(&test, system, x, &result), solved = result.converged;
    if (last && result.iterations == 0) break;
    if (!direction(system, options, &test, previous, r, creep.whole, d, &result)) break;
    if (creep.all && spore_vector_dot(n, r, d) <= 0) {
      /* What buckles leads uphill. */
      system->linearise(system->data, x, before);
      result.linearisations++;
      if (!direction(system, options, &test, previous, r, creep.whole, d, &result)) break;
    }
    double trial_norm, length = 1;
    bool accelerated = false;
    creep.met = false;
    if (system->weigh && system->switches && creep.stuck >= STUCK_MOST)
      accelerated = accelerate(system, &creep, x, test.norm, d, trial, trial_r, &trial_norm, &result);
    else spore_differences_forget(&creep.differences);
    if (!accelerated) trial_norm = evaluate(system, x, d, trial, trial_r, &result);
    bool good = trial_norm <= 0.5 * (trust.given ? trust.norm : test.norm);
    creep.whole |= !(trial_norm <= CREEPS * test.norm);
    creep.stuck = trial_norm > STUCK * test.norm ? creep.stuck + 1 : 0;
    double step = sqrt(system->dot(system->data, d, d));
    if (good || accelerated) {
      trust.given = false;
    } else if (trust.given && !spore_trust_is_promising(&trust, step, trial_norm)) {
      /* Not made good: back, and along the line. */
      trust.given = false;
      trust.failures++;
      memcpy(x, mark.x, n * sizeof *x);
      memcpy(r, mark.r, n * sizeof *r);
      memcpy(d, mark.d, n * sizeof *d);
      test.norm = trust.norm;
      length =
          spore_line_search(system, x, d, r, test.norm, false, near, trial, trial_r, &trial_norm, &result.evaluations);
    } else if (!trust.given) {
      bool overshoots = spore_vector_dot(n, trial_r, d) < 0 && isfinite(trial_norm);
      if (!system->switches && overshoots && trust.failures < SPORE_TRUST_FAILURES) {
        spore_trust_give(&trust, step, test.norm);
        memcpy(mark.x, x, n * sizeof *x);
        memcpy(mark.r, r, n * sizeof *r);
        memcpy(mark.d, d, n * sizeof *d);
      } else {
        /* What buckles grows slowly, by steps of the same length, unless the search may go beyond them. */
        double reach = creep.stuck >= STUCK_MOST ? HUGE_VAL : near;
        length = spore_line_search(system, x, d, r, test.norm, true, reach, trial, trial_r, &trial_norm,
                                   &result.evaluations);
      }
    }
    if (length == 0 && creep.all) {
      creep.stuck = 0; /* back to A, which leads down in any case */
      spore_differences_forget(&creep.differences);
      continue;
    }
    if (length == 0) break;
    if (creep.met) spore_differences_leave(&creep.differences, creep.g, length, d);
    memcpy(from, x, n * sizeof *from);
    memcpy(x, trial, n * sizeof *x);
    memcpy(r, trial_r, n * sizeof *r);
    previous = test.norm;
    spore_convergence_step(&test, system, x, d, length, trial_norm, &result);
    if (test.norm <= test.least) memcpy(best, x, n * sizeof *x);
    result.converged |= solved;
    if (last) break;
  }
  if (result.converged && test.norm > test.least) spore_convergence_return(&test, n, best, test.least, x, &result);
  else if (trust.given && !(test.norm < trust.norm)) spore_convergence_return(&test, n, mark.x, trust.norm, x, &result);
  spore_convergence_end(&test, system, x, &result);
  return result;
}
