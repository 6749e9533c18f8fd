/* Factor of a small dense matrix, and solutions by it. */
#include <assert.h>
#include <math.h>

#include "core/linalg/dense.h"

#define DOWN(column) ((column) / SPORE_LANES * SPORE_LANES)

static size_t largest_in_column(size_t n, size_t ld, const double *a, size_t k) {
  size_t found = k;
  for (size_t i = k + 1; i < n; i++)
    if (fabs(a[i * ld + k]) > fabs(a[found * ld + k])) found = i;
  return found;
}

static void exchange_rows(size_t ld, double *one, double *other) {
  for (size_t j = 0; j < ld; j++) {
    double kept = one[j];
    one[j] = other[j];
    other[j] = kept;
  }
}

/* row -= share * pivot, from the column behind the k-th on. */
SPORE_INLINE void take_away(size_t k, size_t ld, double share, const double *pivot, double *row) {
  size_t j = k + 1, groups = DOWN(k + SPORE_LANES);
  for (; j < groups; j++) row[j] -= share * pivot[j];
  for (; j < ld; j += SPORE_WIDTH)
    spore_vd_store(row + j, spore_vd_load(row + j) - spore_vd_load(pivot + j) * spore_vd_all(share));
}

bool SPORE_LEVEL_NAME(spore_dense_factorise)(size_t n, size_t ld, double *a, uint32_t *order) {
  assert(ld >= n && ld % SPORE_LANES == 0);
  for (size_t k = 0; k < n; k++) {
    size_t taken = largest_in_column(n, ld, a, k);
    order[k] = (uint32_t)taken;
    if (taken != k) exchange_rows(ld, a + k * ld, a + taken * ld);
    const double *pivot = a + k * ld;
    if (!(fabs(pivot[k]) > 0) || !isfinite(pivot[k])) return false;
    double inverse = 1 / pivot[k];
    for (size_t i = k + 1; i < n; i++) {
      double *row = a + i * ld;
      if (row[k] == 0) continue;
      row[k] *= inverse;
      take_away(k, ld, row[k], pivot, row);
    }
  }
  return true;
}

/* Sum of a(j) x(j) over j from `first` to `end`. */
SPORE_INLINE double sum_products(size_t first, size_t end, const double *a, const double *x) {
  SporeVd parts[SPORE_LANES / SPORE_WIDTH] = {0};
  double rest = 0;
  size_t j = first;
  for (; j + SPORE_LANES <= end; j += SPORE_LANES)
    for (size_t p = 0; p < SPORE_LANES / SPORE_WIDTH; p++)
      parts[p] += spore_vd_load(a + j + p * SPORE_WIDTH) * spore_vd_load(x + j + p * SPORE_WIDTH);
  for (; j < end; j++) rest += a[j] * x[j];
  return spore_parts_sum(parts) + rest;
}

void SPORE_LEVEL_NAME(spore_dense_solve)(size_t n, size_t ld, const double *a, const uint32_t *order, double *x) {
  assert(ld >= n && ld % SPORE_LANES == 0);
  for (size_t k = 0; k < n; k++) {
    double taken = x[order[k]];
    x[order[k]] = x[k];
    x[k] = taken;
  }
  for (size_t i = 0; i < n; i++) x[i] -= sum_products(0, i, a + i * ld, x);
  for (size_t i = n; i-- > 0;) x[i] = (x[i] - sum_products(i + 1, n, a + i * ld, x)) / a[i * ld + i];
}
