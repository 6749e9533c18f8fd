/* Both halves of a solution by one supernode, for as many right-hand sides as there are lanes. */
#include <assert.h>
#include <string.h>

#include "core/linalg/cholesky_kernels.h"

#define PARTS (SPORE_LANES / SPORE_WIDTH)
#define TALLEST 6 /* rows that are summed up together */

/* Sums over k of a(i, k) x(k), for `height` rows i. Steps of i and k in a; x(k): the lanes of a row. */
SPORE_INLINE void sum_rows(int height, size_t depth, const void *a, bool rounded, size_t at, size_t step_i,
                           size_t step_k, const double *x, SporeVd sum[TALLEST][PARTS]) {
  for (int i = 0; i < height; i++)
    for (int p = 0; p < PARTS; p++) sum[i][p] = (SporeVd){0};
  for (size_t k = 0; k < depth; k++, at += step_k, x += SPORE_LANES) {
    SporeVd row[PARTS];
    for (int p = 0; p < PARTS; p++) row[p] = spore_vd_load(x + p * SPORE_WIDTH);
    for (size_t i = 0; i < (size_t)height; i++) {
      double entry = rounded ? (double)((const float *)a)[at + i * step_i] : ((const double *)a)[at + i * step_i];
      for (int p = 0; p < PARTS; p++) sum[i][p] += row[p] * entry;
    }
  }
}

SPORE_INLINE void store_rows(int height, SporeVd sum[TALLEST][PARTS], double *y) {
  for (int i = 0; i < height; i++)
    for (int p = 0; p < PARTS; p++) spore_vd_store(y + i * SPORE_LANES + p * SPORE_WIDTH, sum[i][p]);
}

SPORE_INLINE void multiply_rows(int height, size_t i, size_t depth, size_t ld, const void *a, bool rounded,
                                const double *x, double *y) {
  SporeVd sum[TALLEST][PARTS];
  sum_rows(height, depth, a, rounded, i, 1, ld, x, sum);
  store_rows(height, sum, y + i * SPORE_LANES);
}

/* y = a x; lower: a is a lower triangle. */
SPORE_INLINE void multiply(size_t rows, size_t columns, size_t ld, const void *a, bool rounded, bool lower,
                           const double *x, double *y) {
  size_t i = 0;
  for (; i + TALLEST <= rows; i += TALLEST)
    multiply_rows(TALLEST, i, lower ? i + TALLEST : columns, ld, a, rounded, x, y);
  if (i < rows) multiply_rows(3, i, columns, ld, a, rounded, x, y);
}

SPORE_INLINE void dot_columns(int height, size_t j, size_t from, size_t rows, size_t ld, const void *a, bool rounded,
                              const double *x, double *y) {
  SporeVd sum[TALLEST][PARTS];
  sum_rows(height, rows - from, a, rounded, j * ld + from, ld, 1, x + from * SPORE_LANES, sum);
  store_rows(height, sum, y + j * SPORE_LANES);
}

/* y = a^T x; lower: a is a lower triangle. */
SPORE_INLINE void multiply_transposed(size_t rows, size_t columns, size_t ld, const void *a, bool rounded, bool lower,
                                      const double *x, double *y) {
  size_t j = 0;
  for (; j + TALLEST <= columns; j += TALLEST) dot_columns(TALLEST, j, lower ? j : 0, rows, ld, a, rounded, x, y);
  if (j < columns) dot_columns(3, j, lower ? j : 0, rows, ld, a, rounded, x, y);
}

SPORE_INLINE void forward(size_t columns, size_t rows, const void *t, const void *b, bool rounded, double *x,
                          double *below, double *work) {
  multiply(columns, columns, spore_cholesky_pad(columns), t, rounded, true, x, work);
  memcpy(x, work, columns * SPORE_LANES * sizeof *x);
  multiply(rows, columns, spore_cholesky_pad(rows), b, rounded, false, work, below);
}

void SPORE_LEVEL_NAME(spore_cholesky_forward_many)(size_t columns, size_t rows, const void *t, const void *b,
                                                   bool rounded, double *x, double *below, double *work) {
  assert(columns > 0 && columns % 3 == 0 && rows % 3 == 0);
  assert(x != work && (rows == 0 || below != work));
  if (rounded) forward(columns, rows, t, b, true, x, below, work);
  else forward(columns, rows, t, b, false, x, below, work);
}

SPORE_INLINE void backward(size_t columns, size_t rows, const void *t, const void *b, bool rounded, double *x,
                           const double *below, double *work) {
  multiply_transposed(rows, columns, spore_cholesky_pad(rows), b, rounded, false, below, work);
  for (size_t k = 0; k < columns * SPORE_LANES; k++) work[k] = x[k] - work[k];
  multiply_transposed(columns, columns, spore_cholesky_pad(columns), t, rounded, true, work, x);
}

void SPORE_LEVEL_NAME(spore_cholesky_backward_many)(size_t columns, size_t rows, const void *t, const void *b,
                                                    bool rounded, double *x, const double *below, double *work) {
  assert(columns > 0 && columns % 3 == 0 && rows % 3 == 0);
  assert(x != work && (rows == 0 || below != work));
  if (rounded) backward(columns, rows, t, b, true, x, below, work);
  else backward(columns, rows, t, b, false, x, below, work);
}
