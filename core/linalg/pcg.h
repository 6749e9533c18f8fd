/* Preconditioned conjugate gradients for A x = b, A symmetric positive definite and known by its products alone. */
#ifndef SPORE_LINALG_PCG_H
#define SPORE_LINALG_PCG_H

#include <stdbool.h>
#include <stddef.h>

#include "core/base/cancel.h"

/* When a solution that goes slowly is given up for a better preconditioner. */
typedef struct SporePatience {
  size_t least; /* iterations that are taken in any case; 0: the solution is not given up */
  size_t more;  /* most iterations that may then be left, by the rate so far, and most that are taken then */
} SporePatience;

typedef struct SporeLinearOperator {
  void *data;
  size_t count;                                                 /* unknowns */
  void (*multiply)(void *data, const double *x, double *y);     /* y = A x */
  void (*precondition)(void *data, const double *r, double *z); /* z = P^-1 r, P positive definite */
  const SporeCancel *cancel; /* asked in each iteration; NULL: the work is not ended early */
  SporePatience patience;    /* a solution that is given up has the status SPORE_LINEAR_TOO_MANY */
} SporeLinearOperator;

typedef enum SporeLinearStatus {
  SPORE_LINEAR_CONVERGED,
  SPORE_LINEAR_TOO_MANY,   /* iterations spent; x is the best so far */
  SPORE_LINEAR_INDEFINITE, /* a direction p with p.Ap <= 0 or r.P^-1 r < 0 was met; x is what was reached before it */
  SPORE_LINEAR_BREAKDOWN   /* a number was not finite, or the work was cancelled; x is zero */
} SporeLinearStatus;

typedef struct SporeLinearResult {
  SporeLinearStatus status;
  size_t iterations;
  double residual; /* sqrt(r.P^-1 r / b.P^-1 b) at the end: it has no unit, so blocks of any unit count alike */
} SporeLinearResult;

/* Whether a solution is given up that got to the relative residual `residual` in so many iterations. */
bool spore_patience_ends(const SporePatience *patience, size_t iterations, double residual, double tolerance);

/* Vectors of `count` doubles that spore_pcg works in. */
#define SPORE_PCG_SCRATCH 4

/* Starts from x = 0 and stops at the relative residual `tolerance`. scratch: SPORE_PCG_SCRATCH x count doubles. Where
 * the very first direction is indefinite, x is that direction P^-1 b: still one of descent. */
SporeLinearResult spore_pcg(const SporeLinearOperator *operator, const double * b, double tolerance, size_t iterations,
                            double *x, double *scratch);

#endif
