/* The test for convergence. */
#include "core/nonlinear/convergence.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define STALLS_ABOVE 0.5 /* of the least residual so far: an iteration that leaves more has gained nothing */
#define STALLS 2         /* such iterations: the residual has ceased to fall */
#define FAILURE 0.1      /* of the load: a residual above is no matter of rounding, and other attempts may do better */

bool spore_convergence_begin(SporeConvergence *test, const SporeSystem *system, const SporeNonlinearOptions *options,
                             double norm, SporeNonlinearResult *result) {
  assert(options->tolerance > 0);
  assert(system->scale_r >= 0 && system->scale_x >= 0);
  double load = fmax(norm, fmax(system->scale_r, system->least));
  if (options->load > 0) load = fmin(load, options->load);
  *test = (SporeConvergence){.tolerance = options->tolerance, .scale_r = load, .norm = norm, .least = norm};
  result->finite = isfinite(norm);
  result->load = test->scale_r;
  /* A is no less than the matrix of `dot`, so the change that is still missing is at most the norm; where something
   * buckles it may be more, and that is what so small a disturbance would do. Only the load that the system names
   * counts here: beside the residual itself any guess would do. */
  result->converged = norm <= options->tolerance * fmax(fmin(system->scale_r, system->scale_x), system->least);
  result->residual = norm == 0 ? 0 : result->finite ? norm / test->scale_r : INFINITY;
  return result->finite;
}

/* Where nothing loads the system, as in a body at rest that nothing pulls or touches, there is nothing but rounding. */
static bool is_loaded(const SporeSystem *system, const double *x) {
  return system->scale_r > 0 || !system->load || system->load(system->data, x) > 0;
}

/* Down to rounding nothing is left to gain, so that the iteration ends as one that converged. Whether the residual is
 * within the tolerance, too, is for its reader. */
static void end_at_rounding(const SporeSystem *system, const double *x, SporeNonlinearResult *result) {
  if (!is_loaded(system, x)) result->residual = 0;
  result->converged = true;
}

/* By an estimate from above, along the stiff axes. */
static bool is_near_rounding(const SporeConvergence *test, const SporeSystem *system, const double *x) {
  if (test->norm > FAILURE * test->scale_r && is_loaded(system, x)) return false;
  return test->norm <= system->rounding(system->data, x, true);
}

bool spore_convergence_rounding(const SporeConvergence *test, const SporeSystem *system, const double *x,
                                SporeNonlinearResult *result) {
  assert(system->rounding);
  if (test->norm > system->rounding(system->data, x, false)) return false;
  if (test->stalls < STALLS && is_loaded(system, x)) return false;
  end_at_rounding(system, x, result);
  return true;
}

void spore_convergence_end(const SporeConvergence *test, const SporeSystem *system, const double *x,
                           SporeNonlinearResult *result) {
  if (result->converged || result->linearisations == 0) return;
  if (is_near_rounding(test, system, x)) end_at_rounding(system, x, result);
}

/* Along what is very stiff, rounding may be more than the tolerance. It is estimated from above, so that a residual
 * below it counts as rounding only where it has ceased to fall. Iterations may lead far away and back in between. */
static bool has_stalled(SporeConvergence *test, const SporeSystem *system, const double *x) {
  bool falls = test->norm <= STALLS_ABOVE * test->least;
  test->least = fmin(test->least, test->norm);
  if (falls) test->stalls = 0;
  else if (is_near_rounding(test, system, x)) test->stalls++;
  return test->stalls >= STALLS;
}

void spore_convergence_step(SporeConvergence *test, const SporeSystem *system, const double *x, const double *d,
                            double length, double norm, SporeNonlinearResult *result) {
  assert(length > 0);
  double before = test->norm;
  test->norm = norm;
  result->iterations++;
  result->residual = norm == 0 ? 0 : norm / test->scale_r;
  result->converged = false;
  bool small = norm <= test->tolerance * test->scale_r, stalled = has_stalled(test, system, x);
  if (!small && !stalled) return;
  /* What is still missing: the change made, times how much the residual shrank with it. */
  double change = length * sqrt(system->dot(system->data, d, d));
  double size = fmax(sqrt(system->dot(system->data, x, x)), fmax(system->scale_x, system->least));
  double missing = before > 0 ? change * fmin(norm / before, 1) : 0;
  result->converged = !small || missing <= test->tolerance * size;
}

void spore_convergence_return(SporeConvergence *test, size_t n, const double *to, double norm, double *x,
                              SporeNonlinearResult *result) {
  assert(to != x || n == 0);
  memcpy(x, to, n * sizeof *x);
  test->norm = norm;
  result->residual = norm == 0 ? 0 : norm / test->scale_r;
}
