/* Corotational tetrahedra moved all at once by a matrix that stays: what the method position_based asks of them.
 *
 * Where nodes have come to x without them, with masses M and h seconds after the step began, the elements move them by
 *   x += A^-1 h^2 f(x, (x - x0)/h),   A = M + h^2 sum over elements of V k b b^T,
 * with the gradients b of the corners' weights and k no less than any stiffness of the law: 2 mu in
 * shear, where the frame of the element stands still, and up to 2 mu + 3 lambda in volume. That is one round of
 * projective dynamics (S. Bouaziz et al., "Projective dynamics: fusing constraint projections for fast simulation", ACM
 * Trans. Graph. 33, 2014) written as the first step of a quasi-Newton method (T. Liu, S. Bouaziz and L. Kavan,
 * "Quasi-Newton methods for real-time simulation of hyperelastic materials", ACM Trans. Graph. 36, 2017). A depends on
 * masses, held nodes, stiffness and h alone and is factorised when one of them changes; as a step and its halves take
 * turns, factors of two h are kept. */
#ifndef SPORE_MODELS_TETRAHEDRA_PREFACTORED_H
#define SPORE_MODELS_TETRAHEDRA_PREFACTORED_H

#include "core/linalg/point_cholesky.h"
#include "models/tetrahedra/tetrahedra.h"

#define SPORE_PREFACTORED_PART 0.55 /* SporeModelSweep.part */

typedef struct SporePrefactor {
  double h, stiffness; /* what it was made for, s and Pa; h 0: none */
  double *weight;      /* inverse masses; 0: held */
  SporePointFactor factor;
  uint64_t used; /* the last use, counted */
} SporePrefactor;

enum { SPORE_PREFACTORS = 2 };

typedef struct SporePrefactored {
  SporeBlockMatrix matrix; /* its pattern counts */
  SporePointPattern pattern;
  SporePrefactor kept[SPORE_PREFACTORS];
  uint64_t uses;
  double *numbers;         /* of A, one for each block of the matrix */
  double *q, *v, *f, *row; /* 3 a node, and 4 a place of the pattern */
} SporePrefactored;

/* Takes the matrix, also where it fails. False: no memory, or cancelled; to be cleared all the same. */
bool spore_prefactored_create(SporePrefactored *prefactored, SporeBlockMatrix *matrix, const SporeCancel *cancel);
void spore_prefactored_clear(SporePrefactored *prefactored);
/* The elements have changed. */
void spore_prefactored_forget(SporePrefactored *prefactored);
/* A factor for the sweep; NULL: cancelled, or A is not positive definite. Allocates nothing. */
SporePrefactor *spore_prefactored_find(SporePrefactored *prefactored, const SporeTetrahedra *tetrahedra,
                                       SporeElasticity elasticity, const SporeSweep *at);
/* Places and speeds of the nodes of the sweep, to q and v; clears f. */
void spore_prefactored_load(SporePrefactored *prefactored, const SporeSweep *at);
/* Moves the nodes by what the forces f make of them. */
void spore_prefactored_move(SporePrefactored *prefactored, const SporePrefactor *factor, const SporeSweep *at);

#endif
