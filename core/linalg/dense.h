/* Factor of a small dense matrix, which need not be symmetric: L U with rows exchanged for the largest pivot. */
#ifndef SPORE_LINALG_DENSE_H
#define SPORE_LINALG_DENSE_H

#include <stdbool.h>

#include "core/math/simd.h"

/* In place. a: n rows, `ld` doubles apart; ld is a multiple of the lanes, and what lies behind the n-th column is
 * finite; it is overwritten. order: n; the row that was taken for each pivot. False: a pivot is 0 or not finite. */
SPORE_DECLARE_KERNEL(bool, spore_dense_factorise, size_t n, size_t ld, double *a, uint32_t *order);
/* x = A^-1 x, by that factor. */
SPORE_DECLARE_KERNEL(void, spore_dense_solve, size_t n, size_t ld, const double *a, const uint32_t *order, double *x);

#endif
