/* The one stage that every implicit method is made of: find v with
 *   M (v - va) = c f(drift(qa, v, c), v)
 * M being that at qa. Its Jacobian is M + c D + c^2 K. Implicit Euler has c = h, the midpoint rule h/2, BDF2 2h/3,
 * TR-BDF2 (1 - 1/sqrt 2) h twice. */
#ifndef SPORE_INTEGRATE_STAGE_H
#define SPORE_INTEGRATE_STAGE_H

#include "core/integrate/integrator.h"
#include "core/linalg/bicgstab.h"
#include "core/nonlinear/system.h"

/* Vectors of 3 block_count: q and from, of at most 4/3 of one rounded up to 2; v, force, work; r. */
#define SPORE_STAGE_SCRATCH (8 + SPORE_BICGSTAB_SCRATCH + SPORE_BROYDEN_SCRATCH)

/* v (written) is the velocity at qa; drift from there. qa and va are not changed. change: what v - va may be near, for
 * a better start than va; NULL: not known. */
SporeStepResult spore_stage_solve(const SporeDynamics *dynamics, const SporeSolverFields *fields, double c,
                                  const double *qa, const double *va, const double *change, double *v, double *scratch);

#endif
