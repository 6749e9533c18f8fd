#include "core/linalg/block_matrix_kernels.h"

#include <assert.h>

/* Of the nine numbers of a block, each times its number of x: the first eight in vectors, and the last. */
enum { PARTS = SPORE_LANES / SPORE_WIDTH };
typedef struct Sum {
  SporeVd first[PARTS];
  double last;
} Sum;

/* x0 x1 x2 x0 x1 x2 x0 x1 */
SPORE_INLINE void repeat(const double *x, SporeVd repeated[PARTS]) {
#if SPORE_WIDTH == 8
  __m512d three = _mm512_castpd256_pd512(spore_load_three(x));
  repeated[0] = (SporeVd)_mm512_permutexvar_pd(_mm512_setr_epi64(0, 1, 2, 0, 1, 2, 0, 1), three);
#elif SPORE_WIDTH == 4
  __m256d three = spore_load_three(x);
  repeated[0] = (SporeVd)_mm256_permute4x64_pd(three, 0x24);
  repeated[1] = (SporeVd)_mm256_permute4x64_pd(three, 0x49);
#else
  repeated[0] = repeated[3] = (SporeVd){x[0], x[1]};
  repeated[1] = (SporeVd){x[2], x[0]};
  repeated[2] = (SporeVd){x[1], x[2]};
#endif
}

SPORE_INLINE void add_products(Sum *sum, const double *block, const double *x) {
  SporeVd repeated[PARTS];
  repeat(x, repeated);
  for (int p = 0; p < PARTS; p++) sum->first[p] += spore_vd_load(block + p * SPORE_WIDTH) * repeated[p];
  sum->last += block[8] * x[2];
}

/* Two sums, so that one need not wait for the other's adder. */
void SPORE_LEVEL_NAME(spore_block_matrix_multiply)(const SporeBlockMatrix *matrix, const double *x, double *y) {
  assert(x != y || matrix->block_count == 0);
  for (size_t i = 0; i < matrix->block_count; i++) {
    Sum even = {0}, odd = {0};
    uint32_t k = matrix->row_start[i], end = matrix->row_start[i + 1];
    for (; k + 1 < end; k += 2) {
      add_products(&even, matrix->values + 9 * (size_t)k, x + 3 * (size_t)matrix->column[k]);
      add_products(&odd, matrix->values + 9 * (size_t)(k + 1), x + 3 * (size_t)matrix->column[k + 1]);
    }
    if (k < end) add_products(&even, matrix->values + 9 * (size_t)k, x + 3 * (size_t)matrix->column[k]);
    double sum[9];
    for (int p = 0; p < PARTS; p++) spore_vd_store(sum + p * SPORE_WIDTH, even.first[p] + odd.first[p]);
    sum[8] = even.last + odd.last;
    for (size_t r = 0; r < 3; r++) y[3 * i + r] += sum[3 * r] + sum[3 * r + 1] + sum[3 * r + 2];
  }
}
