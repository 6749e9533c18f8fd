#include "core/math/vector.h"

#include <string.h>

#define PARTS (SPORE_LANES / SPORE_WIDTH)

/* The last n < SPORE_LANES entries, zeros behind them. */
SPORE_INLINE void load_rest(double rest[SPORE_LANES], const double *x, size_t n) {
  memset(rest, 0, SPORE_LANES * sizeof *rest);
  memcpy(rest, x, n * sizeof *rest);
}

SPORE_INLINE void add_products(SporeVd sum[PARTS], const double *a, const double *b) {
  for (int p = 0; p < PARTS; p++) sum[p] += spore_vd_load(a + p * SPORE_WIDTH) * spore_vd_load(b + p * SPORE_WIDTH);
}

/* Four groups of sums: as many as the adder's latency asks for. */
double SPORE_LEVEL_NAME(spore_vector_dot)(size_t n, const double *a, const double *b) {
  SporeVd sum[4][PARTS] = {0};
  size_t i = 0;
  for (; i + 4 * SPORE_LANES <= n; i += 4 * SPORE_LANES)
    for (size_t k = 0; k < 4; k++) add_products(sum[k], a + i + k * SPORE_LANES, b + i + k * SPORE_LANES);
  for (; i + SPORE_LANES <= n; i += SPORE_LANES) add_products(sum[0], a + i, b + i);
  double rest_a[SPORE_LANES], rest_b[SPORE_LANES], lanes[SPORE_LANES];
  load_rest(rest_a, a + i, n - i);
  load_rest(rest_b, b + i, n - i);
  add_products(sum[1], rest_a, rest_b);
  for (int p = 0; p < PARTS; p++)
    spore_vd_store(lanes + p * SPORE_WIDTH, (sum[0][p] + sum[1][p]) + (sum[2][p] + sum[3][p]));
  return spore_lanes_sum(lanes);
}

void SPORE_LEVEL_NAME(spore_vector_add_scaled)(size_t n, double *y, double s, const double *x) {
  size_t i = 0;
  for (; i + SPORE_WIDTH <= n; i += SPORE_WIDTH) spore_vd_store(y + i, spore_vd_load(y + i) + s * spore_vd_load(x + i));
  for (; i < n; i++) y[i] += s * x[i];
}

void SPORE_LEVEL_NAME(spore_vector_scale_add)(size_t n, double *y, double s, const double *x) {
  size_t i = 0;
  for (; i + SPORE_WIDTH <= n; i += SPORE_WIDTH) spore_vd_store(y + i, s * spore_vd_load(y + i) + spore_vd_load(x + i));
  for (; i < n; i++) y[i] = s * y[i] + x[i];
}

bool SPORE_LEVEL_NAME(spore_vector_within)(size_t n, const double *x, double bound) {
  SporeVl good = (SporeVl){0} - 1;
  size_t i = 0;
  for (; i + SPORE_WIDTH <= n; i += SPORE_WIDTH) good &= spore_vd_abs(spore_vd_load(x + i)) <= spore_vd_all(bound);
  bool rest = true;
  for (; i < n; i++) rest = rest && __builtin_fabs(x[i]) <= bound;
  return rest && !spore_vl_any(~good);
}
