/* Four doubles at a time, in GCC's vectors: what the methods of this folder share so that none of them is slow for want
 * of it. Nodes are kept as (x, y, z, 1/mass); four of them turned over are four vectors of coordinates. */
#ifndef SPORE_BENCH_FIELD_LANES_H
#define SPORE_BENCH_FIELD_LANES_H

#include <math.h>
#include <stdint.h>

enum { LANES = 4 };
typedef double Lanes __attribute__((vector_size(32)));
typedef int64_t LanesBits __attribute__((vector_size(32)));
typedef struct Lanes3 {
  Lanes x, y, z;
} Lanes3;

static inline Lanes lanes(double a) { return (Lanes){a, a, a, a}; }

static inline Lanes lanes_sqrt(Lanes a) {
  for (int i = 0; i < LANES; i++) a[i] = sqrt(a[i]);
  return a;
}

static inline Lanes lanes_choose(LanesBits where, Lanes a, Lanes b) {
  return (Lanes)(((LanesBits)a & where) | ((LanesBits)b & ~where));
}

/* log of positive normal numbers: exponent apart, the rest by the series of artanh. */
static inline Lanes lanes_log(Lanes a) {
  const LanesBits mantissa = {0xfffffffffffff, 0xfffffffffffff, 0xfffffffffffff, 0xfffffffffffff};
  LanesBits bits = (LanesBits)a, exponent = (bits >> 52) - 1023;
  Lanes m = (Lanes)((bits & mantissa) | (LanesBits)lanes(1));
  LanesBits large = m > M_SQRT2;
  m = lanes_choose(large, 0.5 * m, m);
  exponent -= large; /* true is -1 */
  Lanes e = (Lanes)(exponent + 0x4338000000000000) - 6755399441055744.0;
  Lanes s = (m - 1) / (m + 1), t = s * s, sum = lanes(1. / 19);
  for (int k = 17; k > 0; k -= 2) sum = sum * t + 1. / k;
  return e * M_LN2 + 2 * s * sum;
}

static inline void lanes_turn(Lanes r[4]) {
  const LanesBits low = {0, 4, 2, 6}, high = {1, 5, 3, 7}, first = {0, 1, 4, 5}, second = {2, 3, 6, 7};
  Lanes a = __builtin_shuffle(r[0], r[1], low), b = __builtin_shuffle(r[0], r[1], high);
  Lanes c = __builtin_shuffle(r[2], r[3], low), d = __builtin_shuffle(r[2], r[3], high);
  r[0] = __builtin_shuffle(a, c, first), r[1] = __builtin_shuffle(b, d, first);
  r[2] = __builtin_shuffle(a, c, second), r[3] = __builtin_shuffle(b, d, second);
}

/* Four nodes; *last: their fourth components, or NULL. */
static inline Lanes3 lanes_load(const Lanes *nodes, const uint32_t index[4], Lanes *last) {
  Lanes r[4] = {nodes[index[0]], nodes[index[1]], nodes[index[2]], nodes[index[3]]};
  lanes_turn(r);
  if (last) *last = r[3];
  return (Lanes3){r[0], r[1], r[2]};
}
/* Adds to four nodes, one after the other: they may be the same. Fourth components stay. */
static inline void lanes_add(Lanes *nodes, const uint32_t index[4], Lanes3 a) {
  Lanes r[4] = {a.x, a.y, a.z, lanes(0)};
  lanes_turn(r);
  for (int i = 0; i < 4; i++) nodes[index[i]] += r[i];
}

static inline Lanes3 lanes3_minus(Lanes3 a, Lanes3 b) { return (Lanes3){a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline Lanes3 lanes3_plus(Lanes3 a, Lanes3 b) { return (Lanes3){a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline Lanes3 lanes3_scale(Lanes s, Lanes3 a) { return (Lanes3){s * a.x, s * a.y, s * a.z}; }
static inline Lanes lanes3_dot(Lanes3 a, Lanes3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline Lanes3 lanes3_cross(Lanes3 a, Lanes3 b) {
  return (Lanes3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* Matrices by columns: m e_k = m.c[k]. */
typedef struct Lanes33 {
  Lanes3 c[3];
} Lanes33;

static inline Lanes3 lanes33_times(const Lanes33 *m, Lanes3 a) {
  return lanes3_plus(lanes3_plus(lanes3_scale(a.x, m->c[0]), lanes3_scale(a.y, m->c[1])), lanes3_scale(a.z, m->c[2]));
}
static inline Lanes33 lanes33_cofactor(const Lanes33 *m) {
  return (Lanes33){{lanes3_cross(m->c[1], m->c[2]), lanes3_cross(m->c[2], m->c[0]), lanes3_cross(m->c[0], m->c[1])}};
}
static inline Lanes lanes33_square(const Lanes33 *m) {
  return lanes3_dot(m->c[0], m->c[0]) + lanes3_dot(m->c[1], m->c[1]) + lanes3_dot(m->c[2], m->c[2]);
}
/* Sum of d_k times the transpose of b_k. */
static inline Lanes33 lanes33_of(const Lanes3 d[3], const Lanes3 b[3]) {
  Lanes33 m;
  for (int e = 0; e < 3; e++) {
    Lanes w[3] = {e == 0   ? b[0].x
                  : e == 1 ? b[0].y
                           : b[0].z,
                  e == 0   ? b[1].x
                  : e == 1 ? b[1].y
                           : b[1].z,
                  e == 0   ? b[2].x
                  : e == 1 ? b[2].y
                           : b[2].z};
    m.c[e] = lanes3_plus(lanes3_plus(lanes3_scale(w[0], d[0]), lanes3_scale(w[1], d[1])), lanes3_scale(w[2], d[2]));
  }
  return m;
}

#endif
