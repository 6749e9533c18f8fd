/* Adding 3x3 blocks, computed one a lane, to a block matrix; for kernel files. */
#ifndef SPORE_MODELS_COMMON_BLOCK_ROWS_H
#define SPORE_MODELS_COMMON_BLOCK_ROWS_H

#include <assert.h>

#include "core/math/simd.h"

typedef double SporeFour __attribute__((vector_size(32), aligned(8), may_alias));

/* block += the block of lane i, of which rows[r] holds row r as spore_vd3_store_rows writes it: three numbers
 * and a zero, which falls on the next row's first number; all is loaded before and stored in order. */
SPORE_INLINE void spore_block_add_rows(double *block, double rows[3][4 * SPORE_WIDTH], size_t i) {
  assert(i < SPORE_WIDTH);
  SporeFour first = *(SporeFour *)block + *(const SporeFour *)(rows[0] + 4 * i);
  SporeFour second = *(SporeFour *)(block + 3) + *(const SporeFour *)(rows[1] + 4 * i);
  double third[3];
  for (int k = 0; k < 3; k++) third[k] = block[6 + k] + rows[2][4 * i + (size_t)k];
  *(SporeFour *)block = first;
  *(SporeFour *)(block + 3) = second;
  for (int k = 0; k < 3; k++) block[6 + k] = third[k];
}

#endif
