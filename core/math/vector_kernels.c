/* Sums and products of long vectors. */
#include "core/math/vector.h"

#include <assert.h>
#include <string.h>

#define PARTS (SPORE_LANES / SPORE_WIDTH)

/* The last n < SPORE_LANES entries, zeros behind them. */
SPORE_INLINE void load_rest(double rest[SPORE_LANES], const double *x, size_t n) {
  assert(n < SPORE_LANES);
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

void SPORE_LEVEL_NAME(spore_vector_move)(size_t n, double *y, const double *x, double s, const double *z) {
  size_t i = 0;
  for (; i + SPORE_WIDTH <= n; i += SPORE_WIDTH) spore_vd_store(y + i, spore_vd_load(x + i) + s * spore_vd_load(z + i));
  for (; i < n; i++) y[i] = x[i] + s * z[i];
}

/* The weights of SPORE_WIDTH nodes, each three times. */
SPORE_INLINE void spread_lanes(SporeVd weight, SporeVd spread[3]) {
#if SPORE_WIDTH == 8
  __m512d w = (__m512d)weight;
  spread[0] = (SporeVd)_mm512_permutexvar_pd(_mm512_setr_epi64(0, 0, 0, 1, 1, 1, 2, 2), w);
  spread[1] = (SporeVd)_mm512_permutexvar_pd(_mm512_setr_epi64(2, 3, 3, 3, 4, 4, 4, 5), w);
  spread[2] = (SporeVd)_mm512_permutexvar_pd(_mm512_setr_epi64(5, 5, 6, 6, 6, 7, 7, 7), w);
#elif SPORE_WIDTH == 4
  __m256d w = (__m256d)weight;
  spread[0] = (SporeVd)_mm256_permute4x64_pd(w, 0x40);
  spread[1] = (SporeVd)_mm256_permute4x64_pd(w, 0xa5);
  spread[2] = (SporeVd)_mm256_permute4x64_pd(w, 0xfe);
#else
  spread[0] = (SporeVd){weight[0], weight[0]};
  spread[1] = (SporeVd){weight[0], weight[1]};
  spread[2] = (SporeVd){weight[1], weight[1]};
#endif
}

SPORE_INLINE void spread(const double *weight, SporeVd spread[3]) { spread_lanes(spore_vd_load(weight), spread); }

void SPORE_LEVEL_NAME(spore_nodes_weigh)(size_t nodes, double *y, const double *weight, const double *x) {
  assert(y != weight || nodes == 0);
  size_t i = 0;
  for (; i + SPORE_WIDTH <= nodes; i += SPORE_WIDTH) {
    SporeVd w[3];
    spread(weight + i, w);
    for (size_t k = 0; k < 3; k++) {
      size_t at = 3 * i + k * SPORE_WIDTH;
      spore_vd_store(y + at, w[k] * spore_vd_load(x + at));
    }
  }
  for (size_t k = 3 * i; k < 3 * nodes; k++) y[k] = weight[k / 3] * x[k];
}

void SPORE_LEVEL_NAME(spore_nodes_kick)(size_t nodes, double *y, double s, const double *x, const double *weight) {
  assert(y != x || nodes == 0);
  size_t i = 0;
  for (; i + SPORE_WIDTH <= nodes; i += SPORE_WIDTH) {
    SporeVd w[3];
    spread_lanes(s / spore_vd_load(weight + i), w);
    for (size_t k = 0; k < 3; k++) {
      size_t at = 3 * i + k * SPORE_WIDTH;
      spore_vd_store(y + at, spore_vd_load(y + at) + spore_vd_load(x + at) * w[k]);
    }
  }
  for (size_t k = 3 * i; k < 3 * nodes; k++) y[k] += x[k] * (s / weight[k / 3]);
}

SPORE_INLINE SporeVd dual_of(SporeVd x, SporeVd weight) {
  return spore_vd_select(x == spore_vd_all(0), spore_vd_all(0), x * x / weight);
}

double SPORE_LEVEL_NAME(spore_nodes_dual)(size_t nodes, const double *x, const double *weight) {
  assert(nodes == 0 || (x && weight));
  SporeVd sum[PARTS] = {0};
  double lanes[SPORE_LANES], rest = 0;
  size_t i = 0;
  for (; i + SPORE_LANES <= nodes; i += SPORE_LANES)
    for (size_t p = 0; p < PARTS; p++) {
      SporeVd w[3];
      spread(weight + i + p * SPORE_WIDTH, w);
      for (size_t k = 0; k < 3; k++) {
        size_t part = 3 * p + k;
        sum[part % PARTS] += dual_of(spore_vd_load(x + 3 * i + part * SPORE_WIDTH), w[k]);
      }
    }
  for (size_t k = 3 * i; k < 3 * nodes; k++) rest += x[k] == 0 ? 0 : x[k] * x[k] / weight[k / 3];
  for (int p = 0; p < PARTS; p++) spore_vd_store(lanes + p * SPORE_WIDTH, sum[p]);
  return spore_lanes_sum(lanes) + rest;
}

void SPORE_LEVEL_NAME(spore_nodes_pull)(size_t nodes, double *y, const double *weight, const double g[3]) {
  double repeated[3 * SPORE_WIDTH];
  for (size_t k = 0; k < 3 * SPORE_WIDTH; k++) repeated[k] = g[k % 3];
  size_t i = 0;
  for (; i + SPORE_WIDTH <= nodes; i += SPORE_WIDTH) {
    SporeVd w[3];
    spread(weight + i, w);
    for (size_t k = 0; k < 3; k++) {
      size_t at = 3 * i + k * SPORE_WIDTH;
      spore_vd_store(y + at, spore_vd_load(y + at) + w[k] * spore_vd_load(repeated + k * SPORE_WIDTH));
    }
  }
  for (size_t k = 3 * i; k < 3 * nodes; k++) y[k] += weight[k / 3] * g[k % 3];
}

SPORE_INLINE SporeVd3 along(SporeVd3 x, double s, SporeVd3 y) {
  return (SporeVd3){x.x + s * y.x, x.y + s * y.y, x.z + s * y.z};
}

void SPORE_LEVEL_NAME(spore_rows_predict)(size_t nodes, double *rows, const SporeRowsStep *at, const double *weight) {
  double reach = at->part * at->h;
  size_t i = 0;
  for (; i + SPORE_WIDTH <= nodes; i += SPORE_WIDTH) {
    SporeVd3 v0 = spore_vd3_load(at->v0 + 3 * i), v = spore_vd3_load(at->v1 + 3 * i);
    SporeVd3 speed = along(v0, at->part, spore_vd3_sub(v, v0)),
             to = along(spore_vd3_load(at->x0 + 3 * i), reach, speed);
    spore_vd4_store(rows + 4 * i, (SporeVd4){to.x, to.y, to.z, 1 / spore_vd_load(weight + i)});
  }
  for (; i < nodes; i++) {
    for (size_t k = 3 * i; k < 3 * i + 3; k++)
      rows[4 * i + k % 3] = at->x0[k] + reach * (at->v0[k] + at->part * (at->v1[k] - at->v0[k]));
    rows[4 * i + 3] = 1 / weight[i];
  }
}

void SPORE_LEVEL_NAME(spore_rows_follow)(size_t nodes, const double *rows, const SporeRowsStep *at) {
  double reach = at->part * at->h, rate = 1 / reach, more = 1 / at->part;
  size_t i = 0;
  for (; i + SPORE_WIDTH <= nodes; i += SPORE_WIDTH) {
    SporeVd3 x0 = spore_vd3_load(at->x0 + 3 * i), v0 = spore_vd3_load(at->v0 + 3 * i);
    SporeVd3 speed = along(v0, at->part, spore_vd3_sub(spore_vd3_load(at->v1 + 3 * i), v0));
    SporeVd4 row = spore_vd4_load(rows + 4 * i);
    speed = along(speed, rate, spore_vd3_sub((SporeVd3){row.x, row.y, row.z}, along(x0, reach, speed)));
    spore_vd3_store(at->x1 + 3 * i, along(x0, at->h, speed));
    spore_vd3_store(at->v1 + 3 * i, along(v0, more, spore_vd3_sub(speed, v0)));
  }
  for (; i < nodes; i++)
    for (size_t k = 3 * i; k < 3 * i + 3; k++) {
      double x0 = at->x0[k], v0 = at->v0[k], speed = v0 + at->part * (at->v1[k] - v0);
      speed += rate * (rows[4 * i + k % 3] - (x0 + reach * speed));
      at->x1[k] = x0 + at->h * speed;
      at->v1[k] = v0 + more * (speed - v0);
    }
}
