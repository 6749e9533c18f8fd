/* A step as SOFA's default scenes take it: implicit Euler linearised once, solved by plain conjugate gradients that
 * stop after a number of iterations whether they are done or not. To see what its quoted times bought. */
#ifndef SPORE_BENCH_SOFA_STEP_H
#define SPORE_BENCH_SOFA_STEP_H

#include "core/body/model.h"

#define SOFA_ITERATIONS 25
#define SOFA_TOLERANCE 1e-9

/* Moves a nodal model from q, v (in place) by `steps` steps of h seconds; blocks with held[i] != 0 stay. Returns the
 * mean relative residual that the solves ended with. */
double sofa_run(const SporeModel *model, SporeVec3 gravity, const uint8_t *held, double h, unsigned steps,
                size_t iterations, double *q, double *v);

#endif
