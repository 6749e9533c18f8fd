/* Dense work on one supernode: elimination, rounding, and both halves of a solution. */
#include "core/linalg/cholesky_kernels.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define PARTS (SPORE_LANES / SPORE_WIDTH)
#define DOWN(row) ((row) / SPORE_LANES * SPORE_LANES)
#define ASKED_COLUMNS                                                                                                  \
  48 /* a multiple of 6. Fewer columns are done so soon that asking between them is not worth it                       \
      */

/* Asked where a group of columns begins. */
static bool is_ended(const SporeCancel *cancel, size_t column) {
  return column % ASKED_COLUMNS == 0 && spore_cancel_asked(cancel);
}

/* Sums over k of a(i, k) b(j, k), for `vectors` vectors of rows i and `columns` columns j. a: column k at k lda; b: the
 * j of a k next to each other, at k ldb. */
SPORE_INLINE void sum_products(int vectors, int columns, size_t depth, const double *a, size_t lda, const double *b,
                               size_t ldb, SporeVd sum[6][2]) {
  for (int j = 0; j < columns; j++)
    for (int p = 0; p < vectors; p++) sum[j][p] = (SporeVd){0};
  for (size_t k = 0; k < depth; k++, a += lda, b += ldb) {
    SporeVd rows[2];
    for (int p = 0; p < vectors; p++) rows[p] = spore_vd_load(a + p * SPORE_WIDTH);
    for (int j = 0; j < columns; j++)
      for (int p = 0; p < vectors; p++) sum[j][p] += rows[p] * b[j];
  }
}

SPORE_INLINE void subtract_tile(int vectors, int columns, size_t depth, const double *a, size_t lda, const double *b,
                                size_t ldb, bool from_zero, double *c, size_t ldc) {
  SporeVd sum[6][2];
  sum_products(vectors, columns, depth, a, lda, b, ldb, sum);
  for (int j = 0; j < columns; j++)
    for (int p = 0; p < vectors; p++) {
      double *place = c + (size_t)j * ldc + p * SPORE_WIDTH;
      spore_vd_store(place, from_zero ? -sum[j][p] : spore_vd_load(place) - sum[j][p]);
    }
}

/* c -= a b^T, or c = -a b^T, for the rows from `first`, a multiple of the lanes, to `end`, and three or six columns. */
SPORE_INLINE void subtract_rows(int columns, size_t first, size_t end, size_t depth, const double *a, size_t lda,
                                const double *b, size_t ldb, bool from_zero, double *c, size_t ldc) {
  size_t i = first;
  for (; i + 2 * SPORE_WIDTH <= end; i += 2 * SPORE_WIDTH)
    subtract_tile(2, columns, depth, a + i, lda, b, ldb, from_zero, c + i, ldc);
  if (i < end) subtract_tile(1, columns, depth, a + i, lda, b, ldb, from_zero, c + i, ldc);
}

/* The Cholesky factor of the 3x3 block on the diagonal: l00, l10, l20, l11, l21, l22. */
static bool factorise_block(const double *t, size_t ld, double l[6]) {
  if (!(t[0] > 0)) return false;
  l[0] = sqrt(t[0]), l[1] = t[1] / l[0], l[2] = t[2] / l[0];
  double d1 = t[ld + 1] - l[1] * l[1];
  if (!(d1 > 0)) return false;
  l[3] = sqrt(d1), l[4] = (t[ld + 2] - l[2] * l[1]) / l[3];
  double d2 = t[2 * ld + 2] - l[2] * l[2] - l[4] * l[4];
  if (!(d2 > 0) || !isfinite(l[0] + l[3] + d2)) return false;
  l[5] = sqrt(d2);
  return true;
}

/* Cholesky's factor of the triangle in t, but its diagonal blocks inverted already. */
SPORE_INLINE bool factorise_triangle(size_t columns, size_t ld, double *t, const SporeCancel *cancel) {
  for (size_t j = 0; j < columns; j += 3) {
    double *c = t + j * ld, l[6];
    if (is_ended(cancel, j)) return false;
    if (j > 0) subtract_rows(3, DOWN(j), ld, j, t, ld, t + j, ld, false, c, ld);
    if (!factorise_block(c + j, ld, l)) return false;
    double i0 = 1 / l[0], i1 = 1 / l[3], i2 = 1 / l[5];
    for (size_t i = DOWN(j + 3); i < ld; i += SPORE_WIDTH) {
      SporeVd x = spore_vd_load(c + i) * i0, y = (spore_vd_load(c + ld + i) - x * l[1]) * i1;
      SporeVd z = (spore_vd_load(c + 2 * ld + i) - x * l[2] - y * l[4]) * i2;
      spore_vd_store(c + i, x), spore_vd_store(c + ld + i, y), spore_vd_store(c + 2 * ld + i, z);
    }
    double *d = c + j;
    d[0] = i0, d[1] = -l[1] * i0 * i1, d[2] = -(l[2] * i0 + l[4] * d[1]) * i2;
    d[ld] = 0, d[ld + 1] = i1, d[ld + 2] = -l[4] * i1 * i2;
    d[2 * ld] = d[2 * ld + 1] = 0, d[2 * ld + 2] = i2;
  }
  return true;
}

/* The whole inverse, from the last columns to the first: T21 = -T22 L21 T11. */
SPORE_INLINE bool invert_triangle(size_t columns, size_t ld, double *t, double *work, const SporeCancel *cancel) {
  for (size_t j = columns; j > 0;) {
    j -= 3;
    if (j > 0 && is_ended(cancel, j)) return false;
    double *c = t + j * ld, d[9], *below = c + j + 3;
    size_t depth = columns - j - 3;
    for (int e = 0; e < 9; e++) d[e] = c[j + (size_t)(e / 3) * ld + (size_t)(e % 3)];
    for (size_t k = 0; k < depth; k++) {
      double x = below[k], y = below[ld + k], z = below[2 * ld + k];
      work[3 * k] = -(x * d[0] + y * d[1] + z * d[2]);
      work[3 * k + 1] = -(y * d[4] + z * d[5]);
      work[3 * k + 2] = -(z * d[8]);
    }
    for (size_t i = DOWN(j + 3); i < ld && depth > 0; i += SPORE_WIDTH) {
      SporeVd sum[6][2];
      sum_products(1, 3, depth, t + (j + 3) * ld + i, ld, work, 3, sum);
      for (size_t e = 0; e < 3; e++) spore_vd_store(c + e * ld + i, sum[e][0]);
    }
    for (size_t e = 0; e < 3; e++) memset(c + e * ld, 0, j * sizeof *c);
    for (int e = 0; e < 9; e++) c[j + (size_t)(e / 3) * ld + (size_t)(e % 3)] = d[e];
  }
  return true;
}

/* b = b t^T in place: the columns of a tile come from those up to it, so the last goes first. */
SPORE_INLINE void apply_tile(int vectors, int width, size_t j, const double *t, size_t ldt, double *b, size_t ldb) {
  SporeVd sum[6][2];
  sum_products(vectors, width, j + (size_t)width, b, ldb, t + j, ldt, sum);
  for (int e = 0; e < width; e++)
    for (int p = 0; p < vectors; p++) spore_vd_store(b + (j + (size_t)e) * ldb + p * SPORE_WIDTH, sum[e][p]);
}

SPORE_INLINE void apply_columns(int vectors, size_t columns, const double *t, size_t ldt, double *b, size_t ldb) {
  size_t j = columns;
  if (columns % 6) apply_tile(vectors, 3, j -= 3, t, ldt, b, ldb);
  while (j > 0) apply_tile(vectors, 6, j -= 6, t, ldt, b, ldb);
}

bool SPORE_LEVEL_NAME(spore_cholesky_eliminate)(size_t columns, size_t rows, double *t, double *b, double *u,
                                                double *work, const SporeCancel *cancel) {
  assert(columns > 0 && columns % 3 == 0 && rows % 3 == 0);
  assert(t && work && (rows == 0 || (b && u)));
  size_t ldt = spore_cholesky_pad(columns), ld = spore_cholesky_pad(rows), i = 0, j = 0;
  const SporeCancel *between = columns > ASKED_COLUMNS ? cancel : NULL;
  if (!factorise_triangle(columns, ldt, t, cancel) || !invert_triangle(columns, ldt, t, work, cancel)) return false;
  for (; i + 2 * SPORE_WIDTH <= ld; i += 2 * SPORE_WIDTH) {
    if (spore_cancel_asked(between)) return false;
    apply_columns(2, columns, t, ldt, b + i, ld);
  }
  if (i < ld) apply_columns(1, columns, t, ldt, b + i, ld);
  for (; j + 6 <= rows; j += 6) {
    if (spore_cancel_asked(between)) return false;
    subtract_rows(6, DOWN(j), ld, columns, b, ld, b + j, ld, true, u + j * ld, ld);
  }
  if (j < rows) subtract_rows(3, DOWN(j), ld, columns, b, ld, b + j, ld, true, u + j * ld, ld);
  return true;
}

/* Floats of a vector: a group of lanes, or half of one. */
#define FLOATS (SPORE_WIDTH == 2 ? 4 : SPORE_LANES)
#define WIDE (FLOATS / SPORE_WIDTH)

typedef float Floats __attribute__((vector_size(4 * FLOATS)));
typedef float FloatsUnaligned __attribute__((vector_size(4 * FLOATS), aligned(4), may_alias));

SPORE_INLINE Floats load_floats(const void *a, size_t i) { return *(const FloatsUnaligned *)((const float *)a + i); }
SPORE_INLINE Floats all_floats(double a) { return (float)a - (Floats){0}; }

/* In an instruction or two: a conversion of vectors in general is several. */
SPORE_INLINE void widen(Floats a, SporeVd wide[WIDE]) {
#if SPORE_WIDTH == 8
  wide[0] = (SporeVd)_mm512_cvtps_pd((__m256)a);
#elif SPORE_WIDTH == 4
  wide[0] = (SporeVd)_mm256_cvtps_pd(_mm256_castps256_ps128((__m256)a));
  wide[1] = (SporeVd)_mm256_cvtps_pd(_mm256_extractf128_ps((__m256)a, 1));
#else
  wide[0] = (SporeVd){a[0], a[1]};
  wide[1] = (SporeVd){a[2], a[3]};
#endif
}
SPORE_INLINE Floats narrow(const double *a) {
#if SPORE_WIDTH == 8
  return (Floats)_mm512_cvtpd_ps(_mm512_loadu_pd(a));
#elif SPORE_WIDTH == 4
  return (Floats)_mm256_set_m128(_mm256_cvtpd_ps(_mm256_loadu_pd(a + 4)), _mm256_cvtpd_ps(_mm256_loadu_pd(a)));
#else
  return (Floats){(float)a[0], (float)a[1], (float)a[2], (float)a[3]};
#endif
}

void SPORE_LEVEL_NAME(spore_cholesky_round)(size_t count, const double *from, float *to) {
  assert(count % SPORE_LANES == 0);
  for (size_t i = 0; i < count; i += FLOATS) *(FloatsUnaligned *)(to + i) = narrow(from + i);
}

/* What both ways of storing a factor share: y = a x, or y += a x, for the rows from `first` to `ld` and some columns,
 * down the columns, as they lie in memory. */
SPORE_INLINE void multiply_doubles(int columns, size_t first, size_t ld, const double *a, bool add, const double *x,
                                   double *y) {
  for (size_t i = first; i < ld; i += SPORE_WIDTH) {
    SporeVd sum = spore_vd_load(a + i) * x[0];
    for (size_t j = 1; j < (size_t)columns; j++) sum += spore_vd_load(a + j * ld + i) * x[j];
    spore_vd_store(y + i, add ? spore_vd_load(y + i) + sum : sum);
  }
}

/* Products are as exact as the factor; their sums over more columns are doubles. */
SPORE_INLINE void multiply_floats(int columns, size_t first, size_t ld, const float *a, bool add, const double *x,
                                  double *y) {
  Floats weight[6];
  for (size_t j = 0; j < (size_t)columns; j++) weight[j] = all_floats(x[j]);
  for (size_t i = first; i < ld; i += FLOATS) {
    Floats sum = load_floats(a, i) * weight[0];
    for (size_t j = 1; j < (size_t)columns; j++) sum += load_floats(a, j * ld + i) * weight[j];
    SporeVd wide[WIDE];
    widen(sum, wide);
    for (size_t p = 0; p < WIDE; p++) {
      double *place = y + i + p * SPORE_WIDTH;
      spore_vd_store(place, add ? spore_vd_load(place) + wide[p] : wide[p]);
    }
  }
}

SPORE_INLINE void multiply_columns(int columns, size_t first, size_t ld, const void *a, size_t column, bool rounded,
                                   bool add, const double *x, double *y) {
  if (rounded) multiply_floats(columns, first, ld, (const float *)a + column * ld, add, x, y);
  else multiply_doubles(columns, first, ld, (const double *)a + column * ld, add, x, y);
}

/* y = a x; lower: a is a lower triangle. */
SPORE_INLINE void multiply(size_t columns, size_t ld, const void *a, bool rounded, const double *x, double *y,
                           bool lower) {
  size_t j = columns % 6;
  if (j > 0) multiply_columns(3, 0, ld, a, 0, rounded, false, x, y);
  else multiply_columns(6, 0, ld, a, 0, rounded, false, x, y), j = 6;
  for (; j < columns; j += 6) multiply_columns(6, lower ? DOWN(j) : 0, ld, a, j, rounded, true, x + j, y);
}

SPORE_INLINE void forward(size_t columns, size_t rows, const void *t, const void *b, bool rounded, double *x,
                          double *below, double *work) {
  multiply(columns, spore_cholesky_pad(columns), t, rounded, x, work, true);
  memcpy(x, work, columns * sizeof *x);
  multiply(columns, spore_cholesky_pad(rows), b, rounded, work, below, false);
}

void SPORE_LEVEL_NAME(spore_cholesky_forward)(size_t columns, size_t rows, const void *t, const void *b, bool rounded,
                                              double *x, double *below, double *work) {
  assert(columns > 0 && columns % 3 == 0 && rows % 3 == 0);
  assert(x != work && (rows == 0 || below != work));
  if (rounded) forward(columns, rows, t, b, true, x, below, work);
  else forward(columns, rows, t, b, false, x, below, work);
}

/* y_j = the sum over rows of a(i, j) x(i), for three or six columns. */
SPORE_INLINE void dot_doubles(int columns, size_t first, size_t ld, const double *a, const double *x, double *y) {
  SporeVd sum[6][PARTS] = {0};
  for (size_t i = first; i < ld; i += SPORE_LANES)
    for (size_t p = 0; p < PARTS; p++) {
      SporeVd part = spore_vd_load(x + i + p * SPORE_WIDTH);
      for (size_t j = 0; j < (size_t)columns; j++) sum[j][p] += spore_vd_load(a + j * ld + i + p * SPORE_WIDTH) * part;
    }
  for (int j = 0; j < columns; j++) y[j] = spore_parts_sum(sum[j]);
}

SPORE_INLINE void dot_floats(int columns, size_t first, size_t ld, const float *a, const double *x, double *y) {
  Floats sum[6][SPORE_LANES / FLOATS] = {0};
  for (size_t i = first; i < ld; i += SPORE_LANES)
    for (size_t p = 0; p < SPORE_LANES / FLOATS; p++) {
      Floats part = narrow(x + i + p * FLOATS);
      for (size_t j = 0; j < (size_t)columns; j++) sum[j][p] += load_floats(a, j * ld + i + p * FLOATS) * part;
    }
  for (int j = 0; j < columns; j++) {
    SporeVd parts[PARTS];
    for (size_t p = 0; p < SPORE_LANES / FLOATS; p++) widen(sum[j][p], parts + p * WIDE);
    y[j] = spore_parts_sum(parts);
  }
}

SPORE_INLINE void dot_tile(int columns, size_t first, size_t ld, const void *a, size_t column, bool rounded,
                           const double *x, double *y) {
  if (rounded) dot_floats(columns, first, ld, (const float *)a + column * ld, x, y);
  else dot_doubles(columns, first, ld, (const double *)a + column * ld, x, y);
}

SPORE_INLINE void multiply_transposed(size_t columns, size_t ld, const void *a, bool rounded, const double *x,
                                      double *y, bool lower) {
  size_t j = 0;
  for (; j + 6 <= columns; j += 6) dot_tile(6, lower ? DOWN(j) : 0, ld, a, j, rounded, x, y + j);
  if (j < columns) dot_tile(3, lower ? DOWN(j) : 0, ld, a, j, rounded, x, y + j);
}

SPORE_INLINE void backward(size_t columns, size_t rows, const void *t, const void *b, bool rounded, double *x,
                           const double *below, double *work) {
  size_t ldt = spore_cholesky_pad(columns);
  multiply_transposed(columns, spore_cholesky_pad(rows), b, rounded, below, work, false);
  for (size_t j = 0; j < columns; j++) work[j] = x[j] - work[j];
  for (size_t j = columns; j < ldt; j++) work[j] = 0;
  multiply_transposed(columns, ldt, t, rounded, work, x, true);
}

void SPORE_LEVEL_NAME(spore_cholesky_backward)(size_t columns, size_t rows, const void *t, const void *b, bool rounded,
                                               double *x, const double *below, double *work) {
  assert(columns > 0 && columns % 3 == 0 && rows % 3 == 0);
  assert(x != work && (rows == 0 || below != work));
  if (rounded) backward(columns, rows, t, b, true, x, below, work);
  else backward(columns, rows, t, b, false, x, below, work);
}
