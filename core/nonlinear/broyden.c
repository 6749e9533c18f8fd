/* Broyden's method with limited memory. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/math/vector.h"
#include "core/nonlinear/convergence.h"
#include "core/nonlinear/differences.h"
#include "core/nonlinear/line_search.h"

#define FRESH_CONTRACTION 0.3 /* what a new linearisation promises of an iteration */
#define SETTLED 2             /* iterations before the contraction is judged */
#define SHORT 0.3             /* Newton's step cut to less says that iterations with one linearisation will not do */

/* Newton takes over where Broyden stood, with the iterations that are left: those until now cost half as much. */
static SporeNonlinearResult hand_over(const SporeSystem *system, const SporeNonlinearOptions *options, double *x,
                                      double *r, double *scratch, SporeNonlinearResult so_far) {
  SporeNonlinearResult result = spore_newton(system, options, x, r, scratch);
  result.iterations += so_far.iterations;
  result.linear_iterations += so_far.linear_iterations;
  result.evaluations += so_far.evaluations;
  result.linearisations += so_far.linearisations;
  result.unsolved += so_far.unsolved;
  result.indefinite |= so_far.indefinite;
  return result;
}

static bool approximate(const SporeSystem *system, const double *r, double *g, SporeNonlinearResult *result) {
  SporeLinearResult linear = system->approximate(system->data, r, g);
  result->linear_iterations += linear.iterations;
  result->unsolved += linear.status != SPORE_LINEAR_CONVERGED;
  result->indefinite |= linear.status == SPORE_LINEAR_INDEFINITE;
  return linear.status != SPORE_LINEAR_BREAKDOWN;
}

/* Whether a new linearisation costs less than the iterations that it saves, by how the residual shrank in the last
 * `iterations` of them. */
static bool worth_linearising(const SporeSystem *system, double start, double norm, double target, size_t iterations) {
  if (iterations < SETTLED || !(norm > target)) return false;
  double rate = log(start / norm) / (double)iterations, missing = log(norm / target);
  if (rate <= 0) return true;
  return missing / rate > missing / -log(FRESH_CONTRACTION) + system->linearisation_cost(system->data);
}

SporeNonlinearResult spore_broyden(const SporeSystem *system, const SporeNonlinearOptions *options, double *x,
                                   double *r, double *scratch) {
  assert(system->approximate && system->weigh && system->reuse && system->linearisation_cost);
  assert(options->tolerance > 0);
  assert(x != r || system->count == 0);
  size_t n = system->count, since = 0;
  double *d = scratch, *trial = scratch + n, *trial_r = scratch + 2 * n;
  double *g = scratch + 3 * n, *best = scratch + 4 * n; /* best: x of the least residual */
  SporeDifferences differences;
  spore_differences_begin(&differences, system, scratch + 5 * n);
  SporeNonlinearResult result = {0};
  SporeConvergence test;
  if (!spore_convergence_begin(&test, system, options, system->norm(system->data, r), &result)) return result;
  if (result.converged) return result;
  memcpy(best, x, n * sizeof *x);
  bool fresh = !system->reuse(system->data, x);
  if (fresh) {
    system->linearise(system->data, x, NULL);
    result.linearisations++;
  }
  if (spore_convergence_rounding(&test, system, x, &result)) return result;
  double near = spore_convergence_near(&test, system), start = test.norm, target = test.tolerance * test.scale_r;
  while (!result.converged && result.iterations < options->iterations && !spore_cancel_asked(system->cancel)) {
    if (!approximate(system, r, g, &result)) break;
    spore_differences_meet(&differences, g);
    spore_differences_accelerate(&differences, g, d);
    double trial_norm = 0;
    double length =
        spore_line_search(system, x, d, r, test.norm, false, near, trial, trial_r, &trial_norm, &result.evaluations);
    if (length == 0 && differences.count > 0) {
      spore_differences_forget(&differences);
      length =
          spore_line_search(system, x, g, r, test.norm, false, near, trial, trial_r, &trial_norm, &result.evaluations);
      memcpy(d, g, n * sizeof *d);
    }
    if (fresh && since == 0 && length < SHORT) break;
    if (length > 0) {
      spore_differences_leave(&differences, g, length, d);
      memcpy(x, trial, n * sizeof *x);
      memcpy(r, trial_r, n * sizeof *r);
      spore_convergence_step(&test, system, x, d, length, trial_norm, &result);
      if (test.norm <= test.least) memcpy(best, x, n * sizeof *x);
      since++;
      if (result.converged) break;
    }
    if (length == 0 || worth_linearising(system, start, test.norm, target, since)) {
      system->linearise(system->data, x, NULL);
      result.linearisations++;
      if (spore_convergence_rounding(&test, system, x, &result)) break;
      spore_differences_forget(&differences);
      fresh = true;
      since = 0;
      start = test.norm;
    }
  }
  if (result.converged && test.norm > test.least) spore_convergence_return(&test, n, best, test.least, x, &result);
  if (result.converged || !result.finite) return result;
  SporeNonlinearOptions left = *options;
  left.iterations -= result.iterations / 2;
  left.linearised = fresh && since == 0;
  left.load = test.scale_r;
  return hand_over(system, &left, x, r, scratch, result);
}
