/* Linearised terms, laid out for multiplying: y += J^T k J x, J the motion of end a relative to end b. Private to the
 * room. */
#ifndef SPORE_SIM_COUPLING_H
#define SPORE_SIM_COUPLING_H

#include "core/constraint/term.h"

typedef enum SporeCoupledKind { /* what an end hangs on */
                                SPORE_COUPLED_NOTHING,
                                SPORE_COUPLED_NODE,  /* one block */
                                SPORE_COUPLED_RIGID, /* a block and the rotation after it, by a lever */
                                SPORE_COUPLED_POINT  /* several blocks, by a mapping */
} SporeCoupledKind;

typedef struct SporeCoupledEnd {
  double lever[3];
  size_t v;            /* where its block, or its body, begins in the vectors, in doubles */
  const SporeEnd *end; /* of a point */
} SporeCoupledEnd;

typedef struct SporeCoupling {
  double k[6]; /* xx xy xz yy yz zz */
  SporeCoupledEnd a, b;
  unsigned char kind_a, kind_b; /* SporeCoupledKind */
} SporeCoupling;

/* The ends as they were at the term's last evaluation; k symmetric. `a` and `b` outlive the coupling. */
SporeCoupling spore_coupling(const SporeEnd *a, const SporeEnd *b, const SporeMat3 *k, const SporeSite *sites);
void spore_couplings_multiply(const SporeCoupling *couplings, size_t count, const double *x, double *y);
/* Adds the diagonal blocks of J^T k J: 9 doubles a block, so 3 for each double of x. */
void spore_couplings_diagonal(const SporeCoupling *couplings, size_t count, double *blocks);

#endif
