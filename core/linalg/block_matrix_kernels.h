/* Kernels behind core/linalg/block_matrix.h. */
#ifndef SPORE_LINALG_BLOCK_MATRIX_KERNELS_H
#define SPORE_LINALG_BLOCK_MATRIX_KERNELS_H

#include "core/linalg/block_matrix.h"
#include "core/math/simd.h"

/* y += A x */
SPORE_DECLARE_KERNEL(void, spore_block_matrix_multiply, const SporeBlockMatrix *matrix, const double *x, double *y);

#endif
