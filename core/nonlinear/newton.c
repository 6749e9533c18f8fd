/* Newton's method with inexact linear solutions, a line search and a watchdog. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/math/vector.h"
#include "core/nonlinear/convergence.h"
#include "core/nonlinear/line_search.h"
#include "core/nonlinear/trust.h"

#define LOOSEST 0.03
#define CREEPS 0.3 /* an iteration that leaves more of the residual wants the whole Jacobian */

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
  SporeNonlinearResult result = {0};
  SporeConvergence test;
  if (!spore_convergence_begin(&test, system, options, system->norm(system->data, r), &result)) return result;
  bool whole = false; /* A alone leads from afar to the answer that has gained no energy, but near it may creep */
  memcpy(best, x, n * sizeof *x);
  double previous = 0, near = spore_convergence_near(&test, system);
  while (!result.converged && result.iterations < options->iterations && !spore_cancel_asked(system->cancel)) {
    if (result.iterations > 0 || !options->linearised) {
      system->linearise(system->data, x, result.iterations > 0 ? from : NULL);
      result.linearisations++;
    }
    /* A residual no greater than rounding may still be more than that: one more iteration takes away what is left. */
    bool last = spore_convergence_rounding(&test, system, x, &result), solved = result.converged;
    if (last && result.iterations == 0) break;
    if (!direction(system, options, &test, previous, r, whole, d, &result)) break;
    double trial_norm, length = 1;
    move(n, x, d, trial);
    system->residual(system->data, trial, trial_r);
    result.evaluations++;
    trial_norm = system->norm(system->data, trial_r);
    bool good = trial_norm <= 0.5 * (trust.given ? trust.norm : test.norm);
    whole |= !(trial_norm <= CREEPS * test.norm);
    double step = sqrt(system->dot(system->data, d, d));
    if (good) {
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
        length =
            spore_line_search(system, x, d, r, test.norm, true, near, trial, trial_r, &trial_norm, &result.evaluations);
      }
    }
    if (length == 0) break;
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
