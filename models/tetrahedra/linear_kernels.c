#include <assert.h>

#include "core/math/mat3.h"
#include "core/math/simd_matrix.h"
#include "models/common/block_rows.h"
#include "models/tetrahedra/linear_solid.h"

SPORE_INLINE SporeVd33 turned(const SporeVd33 *rotation, const SporeVd33 *block, const SporeVd33 *back) {
  SporeVd33 half = spore_vd33_multiply(rotation, block);
  return spore_vd33_multiply(&half, back);
}

void SPORE_LEVEL_NAME(spore_linear_turn)(size_t count, const double *blocks, SporeMat3 rotation, SporeMat3 back,
                                         double *matrix) {
  assert(blocks != matrix || count == 0);
  uint32_t thrice[SPORE_WIDTH];
  SporeVd33 left, right, block;
  double rows[3][4 * SPORE_WIDTH];
  for (int i = 0; i < SPORE_WIDTH; i++) thrice[i] = 3 * (uint32_t)i;
  SPORE_UNROLL for (int e = 0; e < 9; e++) left.m[e] = spore_vd_all(rotation.m[e]),
                                           right.m[e] = spore_vd_all(back.m[e]);
  size_t k = 0;
  for (; k + SPORE_WIDTH <= count; k += SPORE_WIDTH) {
    SPORE_UNROLL for (int r = 0; r < 3; r++) {
      SporeVd3 row = spore_vd3_gather(blocks + 9 * k + 3 * (size_t)r, thrice);
      block.m[3 * r] = row.x, block.m[3 * r + 1] = row.y, block.m[3 * r + 2] = row.z;
    }
    block = turned(&left, &block, &right);
    SPORE_UNROLL for (int r = 0; r < 3; r++) spore_vd3_store_rows(rows[r], spore_vd33_row(&block, r));
    for (size_t i = 0; i < SPORE_WIDTH; i++) spore_block_add_rows(matrix + 9 * (k + i), rows, i);
  }
  for (; k < count; k++) { /* in the same order, or the levels would differ */
    SporeMat3 one;
    for (int e = 0; e < 9; e++) one.m[e] = blocks[9 * k + (size_t)e];
    one = spore_mat3_multiply(spore_mat3_multiply(rotation, one), back);
    for (int e = 0; e < 9; e++) matrix[9 * k + (size_t)e] += one.m[e];
  }
}
