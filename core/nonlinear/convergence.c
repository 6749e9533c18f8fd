#include "core/nonlinear/convergence.h"

#include <assert.h>
#include <math.h>

bool spore_convergence_begin(SporeConvergence *test, const SporeSystem *system, const SporeNonlinearOptions *options,
                             double norm, SporeNonlinearResult *result) {
  assert(options->tolerance > 0);
  assert(system->scale_r >= 0 && system->scale_x >= 0);
  *test = (SporeConvergence){options->tolerance, fmax(norm, system->scale_r), norm};
  result->finite = isfinite(norm);
  /* A is no less than the matrix of `dot`, so the change that is still missing is at most the norm; where something
   * buckles it may be more, and that is what so small a disturbance would do. Only the load that the system names
   * counts here: beside the residual itself any guess would do. */
  result->converged = norm <= options->tolerance * fmin(system->scale_r, system->scale_x);
  result->residual = norm == 0 ? 0 : result->finite ? norm / test->scale_r : INFINITY;
  return result->finite;
}

/* A residual down to rounding counts as solved only where that is this part of what there was to solve: where rounding
 * is as large as the load itself, nothing has been computed, and it must be said. Where nothing loads the system, as in
 * a body at rest that nothing pulls or touches, rounding is all there is. */
#define ROUNDING_OF_LOAD 0.1

static bool within_load(const SporeConvergence *test) { return test->norm <= ROUNDING_OF_LOAD * test->scale_r; }

static bool accept_rounding(const SporeConvergence *test, const SporeSystem *system, const double *x,
                            SporeNonlinearResult *result) {
  bool loaded = system->scale_r > 0 || !system->load || system->load(system->data, x) > 0;
  if (!loaded) result->residual = 0;
  return !loaded || within_load(test);
}

bool spore_convergence_rounding(const SporeConvergence *test, const SporeSystem *system, const double *x,
                                SporeNonlinearResult *result) {
  assert(system->rounding);
  if (test->norm > system->rounding(system->data, x, false)) return false;
  result->converged = accept_rounding(test, system, x, result);
  return true;
}

void spore_convergence_end(const SporeConvergence *test, const SporeSystem *system, const double *x,
                           SporeNonlinearResult *result) {
  if (result->converged || result->linearisations == 0) return;
  if (test->norm <= system->rounding(system->data, x, true))
    result->converged = accept_rounding(test, system, x, result);
}

void spore_convergence_step(SporeConvergence *test, const SporeSystem *system, const double *x, const double *d,
                            double length, double norm, SporeNonlinearResult *result) {
  assert(length > 0);
  double before = test->norm;
  test->norm = norm;
  result->iterations++;
  result->residual = norm == 0 ? 0 : norm / test->scale_r;
  result->converged = false;
  bool small = norm <= test->tolerance * test->scale_r;
  if (!small && !within_load(test)) return;
  /* What is still missing: the change made, times how much the residual shrank with it. */
  double change = length * sqrt(system->dot(system->data, d, d));
  double size = fmax(sqrt(system->dot(system->data, x, x)), system->scale_x);
  double missing = before > 0 ? change * fmin(norm / before, 1) : 0;
  if (missing > test->tolerance * size) return;
  /* Along what is very stiff, rounding is more than the tolerance, and more iterations would only stir it. */
  result->converged = small || norm <= system->rounding(system->data, x, true);
}
