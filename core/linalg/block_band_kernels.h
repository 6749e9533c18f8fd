/* Numbers of a factor near the diagonal: see block_band.h. */
#ifndef SPORE_LINALG_BLOCK_BAND_KERNELS_H
#define SPORE_LINALG_BLOCK_BAND_KERNELS_H

#include "core/linalg/block_band.h"
#include "core/math/simd.h"

SPORE_DECLARE_KERNEL(bool, spore_band_factorise, const SporeBlockBand *band, const SporeBlockMatrix *matrix,
                     const double *diagonal, const uint8_t *held);
SPORE_DECLARE_KERNEL(void, spore_band_solve, const SporeBlockBand *band, const double *b, double *x);

#endif
