#include <math.h>
#include <string.h>

#include "core/nonlinear/convergence.h"
#include "core/nonlinear/line_search.h"

#define LOOSEST 0.03

/* Forcing term: how exactly the linear system needs solving. First roughly, then as the residual falls (Eisenstat and
 * Walker 1996, choice 2), never more exactly than the answer asks for. */
static double forcing_term(double norm, double previous, double target) {
  double eta = previous > 0 ? 0.9 * (norm / previous) * (norm / previous) : LOOSEST;
  return fmin(fmax(eta, 0.1 * target / norm), LOOSEST);
}

SporeNonlinearResult spore_newton(const SporeSystem *system, const SporeNonlinearOptions *options, double *x, double *r,
                                  double *scratch) {
  size_t n = system->count;
  double *d = scratch, *trial = scratch + n, *trial_r = scratch + 2 * n;
  SporeNonlinearResult result = {0};
  SporeConvergence test;
  if (!spore_convergence_begin(&test, system, options, system->norm(system->data, r), &result)) return result;
  double previous = 0;
  while (!result.converged && result.iterations < options->iterations) {
    system->linearise(system->data, x);
    result.linearisations++;
    /* A residual no greater than rounding may still be more than that: one more iteration takes away what is left. */
    bool last = spore_convergence_rounding(&test, system, x, &result), solved = result.converged;
    if (last && result.iterations == 0) break;
    SporeLinearResult linear =
        system->solve(system->data, r, forcing_term(test.norm, previous, options->tolerance * test.scale_r), d);
    result.linear_iterations += linear.iterations;
    result.unsolved += linear.status != SPORE_LINEAR_CONVERGED;
    result.indefinite |= linear.status == SPORE_LINEAR_INDEFINITE;
    if (linear.status == SPORE_LINEAR_BREAKDOWN) break;
    double trial_norm;
    double length = spore_line_search(system, x, d, r, test.norm, trial, trial_r, &trial_norm, &result.evaluations);
    if (length == 0) break;
    memcpy(x, trial, n * sizeof *x);
    memcpy(r, trial_r, n * sizeof *r);
    previous = test.norm;
    spore_convergence_step(&test, system, x, d, length, trial_norm, &result);
    result.converged |= solved;
    if (last) break;
  }
  spore_convergence_end(&test, system, x, &result);
  return result;
}
