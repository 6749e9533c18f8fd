/* Dense work on one supernode of a sparse Cholesky factor. Matrices are column-major, and their columns are padded with
 * zeros to whole groups of lanes: spore_cholesky_pad(rows) apart. Columns and rows come in threes. */
#ifndef SPORE_LINALG_CHOLESKY_KERNELS_H
#define SPORE_LINALG_CHOLESKY_KERNELS_H

#include <stdbool.h>

#include "core/base/cancel.h"
#include "core/math/simd.h"

static inline size_t spore_cholesky_pad(size_t rows) { return (rows + SPORE_LANES - 1) / SPORE_LANES * SPORE_LANES; }

/* Eliminates the columns of a front. t: columns x columns, the lower triangle of A11 in, L11^-1 out, zeros above its
 * diagonal. b: rows x columns, A21 in, L21 = A21 L11^-T out. u: rows x rows, the lower triangle of -L21 L21^T
 * out; above its diagonal it is undefined. work: 3 columns. False where a pivot is not positive, and where `cancel`
 * ended the work. */
SPORE_DECLARE_KERNEL(bool, spore_cholesky_eliminate, size_t columns, size_t rows, double *t, double *b, double *u,
                     double *work, const SporeCancel *cancel);
/* Rounds `count` numbers, a multiple of the lanes, to single precision. */
SPORE_DECLARE_KERNEL(void, spore_cholesky_round, size_t count, const double *from, float *to);
/* x = L11^-1 x, below = L21 x. t and b are doubles, or floats where they were rounded. below: rows, padded; work:
 * columns, padded. */
SPORE_DECLARE_KERNEL(void, spore_cholesky_forward, size_t columns, size_t rows, const void *t, const void *b,
                     bool rounded, double *x, double *below, double *work);
/* x = L11^-T (x - L21^T below); below is padded with zeros. work: columns, padded. */
SPORE_DECLARE_KERNEL(void, spore_cholesky_backward, size_t columns, size_t rows, const void *t, const void *b,
                     bool rounded, double *x, const double *below, double *work);
/* The same for SPORE_LANES vectors: the lanes of a row lie next to each other. below: rows; work: columns. */
SPORE_DECLARE_KERNEL(void, spore_cholesky_forward_many, size_t columns, size_t rows, const void *t, const void *b,
                     bool rounded, double *x, double *below, double *work);
SPORE_DECLARE_KERNEL(void, spore_cholesky_backward_many, size_t columns, size_t rows, const void *t, const void *b,
                     bool rounded, double *x, const double *below, double *work);

#endif
