#include "core/linalg/block_band_kernels.h"

#include <assert.h>
#include <float.h>

#define SIZE 12 /* numbers of a block: three columns of four */
#define RING 4  /* columns back that are remembered: SPORE_BAND_WIDEST and one */

/* Three numbers and a zero: a column of a block, or a block's part of a vector. */
typedef double Four __attribute__((vector_size(32)));
typedef double FourUnaligned __attribute__((vector_size(32), aligned(8), may_alias));
#define FOUR(p) (*(FourUnaligned *)(p))

/* A column's blocks below the diagonal, Y = A21 U^-T and X = Y D^-1 with S = U D U^T. */
typedef struct Column {
  double x[SPORE_BAND_WIDEST + 1][SIZE], y[SPORE_BAND_WIDEST + 1][SIZE]; /* by the distance from the diagonal */
} Column;

typedef struct Factoring {
  const SporeBlockBand *band;
  const SporeBlockMatrix *matrix;
  const double *diagonal;
  const uint8_t *held;
  Column top[RING], bottom[RING]; /* by their place from their end */
  bool good;
} Factoring;

/* A block of the matrix, by columns. */
SPORE_INLINE void load(const Factoring *f, size_t column, size_t i, Four p[3]) {
  assert(column < f->band->block_count && i <= f->band->width);
  static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const SporeBandEntry *entry = &f->band->entries[column * (f->band->width + 1) + i];
  bool held = f->held && (f->held[entry->row] || f->held[f->band->order[column]]);
  if (entry->block == UINT32_MAX || (held && i > 0)) {
    p[0] = p[1] = p[2] = (Four){0};
    return;
  }
  const double *block = f->matrix->values + 9 * (size_t)entry->block;
  if (i == 0 && f->diagonal) block = f->diagonal + 9 * (size_t)entry->row;
  if (i == 0 && held) block = identity;
  for (int e = 0; e < 3; e++) p[e] = (Four){block[3 * e], block[3 * e + 1], block[3 * e + 2], 0};
}

/* p -= X Y^T */
SPORE_INLINE void subtract(Four p[3], const double *x, const double *y) {
  for (int k = 0; k < 3; k++) {
    Four column = FOUR(x + 4 * k);
    for (int e = 0; e < 3; e++) p[e] -= column * y[4 * k + e];
  }
}

/* Eliminates a column, p, what is left of its blocks 0..below. */
SPORE_INLINE void eliminate(Factoring *f, size_t below, size_t column, Four p[][3], Column *kept) {
  assert(below <= f->band->width && column < f->band->block_count);
  double *values = f->band->values + column * (f->band->width + 1) * SIZE;
  double a10 = p[0][0][1], a20 = p[0][0][2], d0 = p[0][0][0], r0 = 1 / d0, l10 = a10 * r0, l20 = a20 * r0;
  double d1 = p[0][1][1] - l10 * a10, r1 = 1 / d1, a21 = p[0][1][2] - l20 * a10, l21 = a21 * r1;
  double d2 = p[0][2][2] - l20 * a20 - l21 * a21, r2 = 1 / d2;
  double t20 = l21 * l10 - l20; /* U^-1 = [1; -l10 1; t20 -l21 1] */
  f->good = f->good && d0 > 0 && d1 > 0 && d2 > 0 && d0 + d1 + d2 <= DBL_MAX;
  for (size_t i = 1; i <= below; i++) {
    Four y0 = p[i][0], y1 = p[i][1] - l10 * y0, y2 = p[i][2] - l20 * y0 - l21 * y1;
    Four x0 = y0 * r0, x1 = y1 * r1, x2 = y2 * r2;
    double *x = kept->x[i], *y = kept->y[i], *l = values + i * SIZE;
    FOUR(y) = y0, FOUR(y + 4) = y1, FOUR(y + 8) = y2;
    FOUR(x) = x0, FOUR(x + 4) = x1, FOUR(x + 8) = x2;
    FOUR(l) = x0 - l10 * x1 + t20 * x2, FOUR(l + 4) = x1 - l21 * x2, FOUR(l + 8) = x2;
  }
  double s01 = -l10 * r1 - t20 * l21 * r2, s02 = t20 * r2, s12 = -l21 * r2;
  FOUR(values) = (Four){r0 + l10 * l10 * r1 + t20 * t20 * r2, s01, s02, 0};
  FOUR(values + 4) = (Four){s01, r1 + l21 * l21 * r2, s12, 0};
  FOUR(values + 8) = (Four){s02, s12, r2, 0};
}

/* The column `at` blocks from its end, where `column` columns were eliminated before that end was begun with. */
SPORE_INLINE void eliminate_from_end(Factoring *f, size_t width, size_t at, size_t before, Column ring[RING]) {
  Four p[SPORE_BAND_WIDEST + 1][3];
  for (size_t i = 0; i <= width; i++) load(f, before + at, i, p[i]);
  for (size_t k = width; k > 0; k--) {
    if (at < k) continue;
    const Column *column = &ring[(at - k) % RING];
    for (size_t i = 0; i + k <= width; i++) subtract(p[i], column->x[k + i], column->y[k]);
  }
  eliminate(f, width, before + at, p, &ring[at % RING]);
}

/* The q-th of those between: what both ends and those before it take from it. */
SPORE_INLINE void eliminate_between(Factoring *f, size_t width, size_t q) {
  const SporeBlockBand *band = f->band;
  size_t between = band->block_count - band->top - band->bottom, at = band->top + q;
  size_t back = band->bottom + between - 1 - q; /* its place from the other end */
  Four p[SPORE_BAND_WIDEST + 1][3];
  for (size_t i = 0; q + i < between; i++) {
    load(f, band->top + band->bottom + q, i, p[i]);
    for (size_t k = width; k > 0; k--)
      if (at >= k && i + k <= width) {
        const Column *column = &f->top[(at - k) % RING];
        subtract(p[i], column->x[k + i], column->y[k]);
      }
    for (size_t k = width; k > i; k--)
      if (back >= k && back - k < band->bottom) {
        const Column *column = &f->bottom[(back - k) % RING];
        subtract(p[i], column->x[k - i], column->y[k]);
      }
  }
  eliminate(f, between - 1 - q, band->top + band->bottom + q, p, &f->top[at % RING]);
}

SPORE_INLINE bool factorise(Factoring *f, size_t width) {
  const SporeBlockBand *band = f->band;
  for (size_t at = 0; at < band->top; at++) {
    eliminate_from_end(f, width, at, 0, f->top);
    if (at < band->bottom) eliminate_from_end(f, width, at, band->top, f->bottom);
  }
  for (size_t q = 0; band->top + band->bottom + q < band->block_count; q++) eliminate_between(f, width, q);
  return f->good;
}

bool SPORE_LEVEL_NAME(spore_band_factorise)(const SporeBlockBand *band, const SporeBlockMatrix *matrix,
                                            const double *diagonal, const uint8_t *held) {
  assert(band->width >= 1 && band->width <= SPORE_BAND_WIDEST);
  assert(band->top + band->bottom <= band->block_count);
  Factoring f = {.band = band, .matrix = matrix, .diagonal = diagonal, .held = held, .good = true};
  return band->width == 1 ? factorise(&f, 1) : band->width == 2 ? factorise(&f, 2) : factorise(&f, 3);
}

/* y -= block x */
SPORE_INLINE void subtract_from(Four *y, const double *block, const double *x) {
  for (int k = 0; k < 3; k++) *y -= FOUR(block + 4 * k) * x[k];
}

SPORE_INLINE void forward_from_end(const SporeBlockBand *band, size_t width, size_t at, size_t before) {
  size_t column = before + at;
  double *y = band->work + 4 * column;
  Four sum = FOUR(y);
  for (size_t k = width; k > 0; k--)
    if (at >= k) subtract_from(&sum, band->values + ((column - k) * (width + 1) + k) * SIZE, y - 4 * k);
  FOUR(y) = sum;
}

SPORE_INLINE void forward_between(const SporeBlockBand *band, size_t width, size_t q) {
  size_t between = band->block_count - band->top - band->bottom, both = band->top + band->bottom;
  size_t at = band->top + q, back = band->bottom + between - 1 - q;
  double *y = band->work;
  Four sum = FOUR(y + 4 * (both + q));
  for (size_t k = width; k > 0; k--) {
    size_t column = at - k < band->top ? at - k : at - k + band->bottom;
    if (at >= k) subtract_from(&sum, band->values + (column * (width + 1) + k) * SIZE, y + 4 * column);
  }
  for (size_t k = width; k > 0; k--) {
    size_t column = band->top + back - k;
    if (back >= k && back - k < band->bottom)
      subtract_from(&sum, band->values + (column * (width + 1) + k) * SIZE, y + 4 * column);
  }
  FOUR(y + 4 * (both + q)) = sum;
}

/* x = S^-1 y - the sum of L(i)^T x(i); below: where x(i) stands, by i. */
SPORE_INLINE void backward(const SporeBlockBand *band, size_t width, size_t column, size_t count,
                           const size_t below[SPORE_BAND_WIDEST + 1]) {
  const double *values = band->values + column * (width + 1) * SIZE;
  double *y = band->work + 4 * column;
  Four sum[3] = {{0}, {0}, {0}}, x = FOUR(values) * y[0] + FOUR(values + 4) * y[1] + FOUR(values + 8) * y[2];
  for (size_t i = count; i > 0; i--) {
    Four part = FOUR(band->work + 4 * below[i]);
    for (size_t e = 0; e < 3; e++) sum[e] += FOUR(values + i * SIZE + 4 * e) * part;
  }
  for (int e = 0; e < 3; e++) y[e] = x[e] - (sum[e][0] + sum[e][1] + sum[e][2]);
}

SPORE_INLINE void backward_from_end(const SporeBlockBand *band, size_t width, size_t at, size_t before, size_t end,
                                    bool turned) {
  size_t below[SPORE_BAND_WIDEST + 1], both = band->top + band->bottom, last = band->block_count - 1;
  for (size_t i = 1; i <= width; i++)
    below[i] = at + i < end ? before + at + i : turned ? last - (at + i - end) : both + (at + i - end);
  backward(band, width, before + at, width, below);
}

SPORE_INLINE void solve(const SporeBlockBand *band, size_t width) {
  size_t both = band->top + band->bottom, between = band->block_count - both;
  for (size_t at = 0; at < band->top; at++) {
    forward_from_end(band, width, at, 0);
    if (at < band->bottom) forward_from_end(band, width, at, band->top);
  }
  for (size_t q = 0; q < between; q++) forward_between(band, width, q);
  for (size_t q = between; q-- > 0;) {
    size_t below[SPORE_BAND_WIDEST + 1];
    for (size_t i = 1; q + i < between; i++) below[i] = both + q + i;
    backward(band, width, both + q, between - 1 - q, below);
  }
  for (size_t at = band->top; at-- > 0;) {
    backward_from_end(band, width, at, 0, band->top, false);
    if (at < band->bottom) backward_from_end(band, width, at, band->top, band->bottom, true);
  }
}

void SPORE_LEVEL_NAME(spore_band_solve)(const SporeBlockBand *band, const double *b, double *x) {
  assert(band->width >= 1 && band->width <= SPORE_BAND_WIDEST);
  assert(b && x);
  size_t n = band->block_count;
  double *y = band->work;
  for (size_t i = 0; i < n; i++) {
    const double *from = b + 3 * (size_t)band->order[i];
    FOUR(y + 4 * i) = (Four){from[0], from[1], from[2], 0};
  }
  if (band->width == 1) solve(band, 1);
  else if (band->width == 2) solve(band, 2);
  else solve(band, 3);
  for (size_t i = 0; i < n; i++)
    for (size_t e = 0; e < 3; e++) x[3 * (size_t)band->order[i] + e] = y[4 * i + e];
}
