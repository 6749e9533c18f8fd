/* What the last iterations tell of a system, in the form that meets their differences all at once (Anderson's; H. Fang
 * and Y. Saad, "Two classes of multisecant methods for nonlinear acceleration", Numerical Linear Algebra with
 * Applications 16, 2009). Each iteration has a point x and a step g = A^-1 r there; of two such the differences of g
 * and of x + g are kept. As much of them is taken from the next g as leaves least of it. So a matrix A that lacks
 * something leads as fast as if it lacked nothing, in as few directions as there are differences. */
#ifndef SPORE_NONLINEAR_DIFFERENCES_H
#define SPORE_NONLINEAR_DIFFERENCES_H

#include "core/nonlinear/system.h"

/* In a ring. */
typedef struct SporeDifferences {
  const SporeSystem *system;
  size_t count, next; /* kept; place of the next */
  bool pending;       /* an iteration has begun the next one */
  double *change[SPORE_DIFFERENCES], *path[SPORE_DIFFERENCES];
  double *weights, *weights_before;                  /* M g, and of the g before */
  double gram[SPORE_DIFFERENCES][SPORE_DIFFERENCES]; /* inner products of the changes */
  double along[SPORE_DIFFERENCES];                   /* of the changes with the g before */
} SporeDifferences;

/* scratch: SPORE_DIFFERENCES_SCRATCH x count doubles, which it keeps. */
void spore_differences_begin(SporeDifferences *differences, const SporeSystem *system, double *scratch);
void spore_differences_forget(SporeDifferences *differences);
/* The next point has the step g: finishes the difference to the point before, if that had one. */
void spore_differences_meet(SporeDifferences *differences, const double *g);
/* d = g less what the differences explain of it; after they have met g. */
void spore_differences_accelerate(SporeDifferences *differences, const double *g, double *d);
/* x moved by `length` d from the point that had the step g. */
void spore_differences_leave(SporeDifferences *differences, const double *g, double length, const double *d);

#endif
