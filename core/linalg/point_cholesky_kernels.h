/* Solutions by a factor that acts on all coordinates alike: see point_cholesky.h. */
#ifndef SPORE_LINALG_POINT_CHOLESKY_KERNELS_H
#define SPORE_LINALG_POINT_CHOLESKY_KERNELS_H

#include "core/linalg/point_cholesky.h"
#include "core/math/simd.h"

SPORE_DECLARE_KERNEL(void, spore_point_solve_rows, const SporePointFactor *factor, const SporePointPattern *pattern,
                     double *rows);

#endif
