/* Preconditioned stabilised biconjugate gradients (H. A. van der Vorst, SIAM Journal on Scientific and Statistical
 * Computing 13, 1992) for A x = b, where A is nearly symmetric positive definite, but not quite. */
#ifndef SPORE_LINALG_BICGSTAB_H
#define SPORE_LINALG_BICGSTAB_H

#include "core/linalg/pcg.h"

/* Vectors of `count` doubles that spore_bicgstab works in. */
#define SPORE_BICGSTAB_SCRATCH 8

/* As spore_pcg, from x = 0 to the same relative residual; an iteration takes two products. All inner products are those
 * of P, so that blocks of any unit count alike. Where it does not get there, or breaks down, the status is
 * SPORE_LINEAR_TOO_MANY or SPORE_LINEAR_BREAKDOWN, and x of no use. */
SporeLinearResult spore_bicgstab(const SporeLinearOperator *operator, const double * b, double tolerance,
                                 size_t iterations, double *x, double *scratch);

#endif
