/* The test for convergence shared by the nonlinear solvers: residual and next change, or rounding. */
#ifndef SPORE_NONLINEAR_CONVERGENCE_H
#define SPORE_NONLINEAR_CONVERGENCE_H

#include "core/nonlinear/system.h"

typedef struct SporeConvergence {
  double tolerance, scale_r, norm;
  double least;  /* norm so far */
  size_t stalls; /* iterations since then that gained nothing, with a residual near rounding */
} SporeConvergence;

/* Residual norm below which the residual is a gradient to go far by; farther from the answer it is none, since bodies
 * turn. By the load that the system names, where it names one. */
static inline double spore_convergence_near(const SporeConvergence *test, const SporeSystem *system) {
  return 0.1 * (system->scale_r > 0 ? system->scale_r : test->scale_r);
}

/* With the residual norm at the guess: fills the test; false, and result->finite with it, where it is not finite.
 * A guess as good as any answer is convergence already: a residual within tolerance of scale_r, and of scale_x. */
bool spore_convergence_begin(SporeConvergence *test, const SporeSystem *system, const SporeNonlinearOptions *options,
                             double norm, SporeNonlinearResult *result);
/* True when the residual is down to rounding and does not fall any more, so that nothing is left to gain: the iteration
 * has converged then. Needs a current linearisation. */
bool spore_convergence_rounding(const SporeConvergence *test, const SporeSystem *system, const double *x,
                                SporeNonlinearResult *result);
/* At the end: a residual down to rounding along the stiff axes counts as convergence too. */
void spore_convergence_end(const SporeConvergence *test, const SporeSystem *system, const double *x,
                           SporeNonlinearResult *result);
/* After x moved by length * d to a residual of norm `norm`: counts the iteration and tests. */
void spore_convergence_step(SporeConvergence *test, const SporeSystem *system, const double *x, const double *d,
                            double length, double norm, SporeNonlinearResult *result);
/* Goes back to the point `to`, where the residual's norm was `norm`. x, to: n doubles. */
void spore_convergence_return(SporeConvergence *test, size_t n, const double *to, double norm, double *x,
                              SporeNonlinearResult *result);

#endif
