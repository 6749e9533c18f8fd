/* Vectors of doubles as wide as the instruction set, and kernels compiled once for each set.
 *
 * A file that includes this header is compiled several times with other instruction sets (the build's list is
 * `kernels` in a room's meson.build). It defines each function that others call as SPORE_LEVEL_NAME(name); a header
 * declares all levels of it with SPORE_DECLARE_KERNEL, and the caller writes SPORE_KERNEL(name)(...).
 *
 * Every level has to compute the same bits. Data lie in groups of SPORE_LANES; a kernel works through a group in
 * SPORE_LANES / SPORE_WIDTH parts, lanes do not depend on each other, and what is summed over lanes goes through
 * spore_lanes_sum. Nothing here is approximate and nothing is contracted. */
#ifndef SPORE_MATH_SIMD_H
#define SPORE_MATH_SIMD_H

#include <stddef.h>
#include <stdint.h>

#include "core/base/cpu.h"

#define SPORE_LANES 8 /* doubles of the widest set: data are laid out for it on every machine */

#if SPORE_KERNEL_LEVELS > 1
#define SPORE_DECLARE_KERNEL(type, name, ...)                                                                          \
  type name##_baseline(__VA_ARGS__);                                                                                   \
  type name##_avx2(__VA_ARGS__);                                                                                       \
  type name##_avx512(__VA_ARGS__);                                                                                     \
  static type (*const name##_by_level[])(__VA_ARGS__)                                                                  \
      __attribute__((unused)) = {name##_baseline, name##_avx2, name##_avx512}
#else
#define SPORE_DECLARE_KERNEL(type, name, ...)                                                                          \
  type name##_baseline(__VA_ARGS__);                                                                                   \
  static type (*const name##_by_level[])(__VA_ARGS__) __attribute__((unused)) = {name##_baseline}
#endif
#define SPORE_KERNEL(name) name##_by_level[spore_cpu_level()]

#ifdef SPORE_LEVEL /* in a kernel file */

#define SPORE_JOIN_LEVEL(name, level) name##_##level
#define SPORE_NAME_LEVEL(name, level) SPORE_JOIN_LEVEL(name, level)
#define SPORE_LEVEL_NAME(name) SPORE_NAME_LEVEL(name, SPORE_LEVEL)

#if defined(__AVX512F__) && defined(__AVX512VL__)
#define SPORE_WIDTH 8
#include <immintrin.h>
#elif defined(__AVX2__)
#define SPORE_WIDTH 4
#include <immintrin.h>
#else
#define SPORE_WIDTH 2
#if defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif
#endif

#ifdef __clang__
#pragma clang diagnostic ignored "-Wunused-function"
#else
#pragma GCC diagnostic ignored "-Wunused-function"
#endif

typedef double SporeVd __attribute__((vector_size(8 * SPORE_WIDTH)));
typedef int64_t SporeVl __attribute__((vector_size(8 * SPORE_WIDTH))); /* of a comparison: 0 or -1 a lane */
typedef double SporeVdUnaligned __attribute__((vector_size(8 * SPORE_WIDTH), aligned(8), may_alias));

#define SPORE_INLINE static inline __attribute__((always_inline))

SPORE_INLINE SporeVd spore_vd_load(const double *p) { return *(const SporeVdUnaligned *)p; }
SPORE_INLINE void spore_vd_store(double *p, SporeVd a) { *(SporeVdUnaligned *)p = a; }
SPORE_INLINE SporeVd spore_vd_all(double a) { return a - (SporeVd){0}; }
/* Where mask: a, elsewhere b. */
SPORE_INLINE SporeVd spore_vd_select(SporeVl mask, SporeVd a, SporeVd b) {
#if SPORE_WIDTH == 8
  return (SporeVd)_mm512_mask_blend_pd(_mm512_movepi64_mask((__m512i)mask), (__m512d)b, (__m512d)a);
#elif SPORE_WIDTH == 4
  return (SporeVd)_mm256_blendv_pd((__m256d)b, (__m256d)a, (__m256d)mask);
#else
  return (SporeVd)(((SporeVl)a & mask) | ((SporeVl)b & ~mask));
#endif
}
/* The second where either is not a number. */
SPORE_INLINE SporeVd spore_vd_max(SporeVd a, SporeVd b) {
#if SPORE_WIDTH == 8
  return (SporeVd)_mm512_max_pd((__m512d)a, (__m512d)b);
#elif SPORE_WIDTH == 4
  return (SporeVd)_mm256_max_pd((__m256d)a, (__m256d)b);
#elif defined(__SSE2__)
  return (SporeVd)_mm_max_pd((__m128d)a, (__m128d)b);
#else
  return spore_vd_select(a > b, a, b);
#endif
}
SPORE_INLINE SporeVd spore_vd_min(SporeVd a, SporeVd b) {
#if SPORE_WIDTH == 8
  return (SporeVd)_mm512_min_pd((__m512d)a, (__m512d)b);
#elif SPORE_WIDTH == 4
  return (SporeVd)_mm256_min_pd((__m256d)a, (__m256d)b);
#elif defined(__SSE2__)
  return (SporeVd)_mm_min_pd((__m128d)a, (__m128d)b);
#else
  return spore_vd_select(a < b, a, b);
#endif
}
SPORE_INLINE SporeVd spore_vd_abs(SporeVd a) { return (SporeVd)((SporeVl)a & INT64_MAX); }
SPORE_INLINE SporeVd spore_vd_sqrt(SporeVd a) {
#if SPORE_WIDTH == 8
  return (SporeVd)_mm512_sqrt_pd((__m512d)a);
#elif SPORE_WIDTH == 4
  return (SporeVd)_mm256_sqrt_pd((__m256d)a);
#elif defined(__SSE2__)
  return (SporeVd)_mm_sqrt_pd((__m128d)a);
#elif defined(__aarch64__)
  return (SporeVd)vsqrtq_f64((float64x2_t)a);
#else
  return (SporeVd){__builtin_sqrt(a[0]), __builtin_sqrt(a[1])};
#endif
}
/* Whether mask is set in some lane. */
SPORE_INLINE int spore_vl_any(SporeVl mask) {
#if SPORE_WIDTH == 8
  return _mm512_movepi64_mask((__m512i)mask) != 0;
#elif SPORE_WIDTH == 4
  return _mm256_movemask_pd((__m256d)mask) != 0;
#else
  return (mask[0] | mask[1]) != 0;
#endif
}

/* Sum of SPORE_LANES doubles, in pairs: always in this order. */
SPORE_INLINE double spore_lanes_sum(const double *lanes) {
  return ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) + ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]));
}

/* The same of a group in its parts, without a way through memory. */
SPORE_INLINE double spore_parts_sum(const SporeVd parts[SPORE_LANES / SPORE_WIDTH]) {
#if SPORE_WIDTH == 8
  __m256d half = _mm256_add_pd(_mm512_castpd512_pd256((__m512d)parts[0]), _mm512_extractf64x4_pd((__m512d)parts[0], 1));
  __m128d pair = _mm_add_pd(_mm256_castpd256_pd128(half), _mm256_extractf128_pd(half, 1));
  return pair[0] + pair[1];
#elif SPORE_WIDTH == 4
  __m256d half = (__m256d)(parts[0] + parts[1]);
  __m128d pair = _mm_add_pd(_mm256_castpd256_pd128(half), _mm256_extractf128_pd(half, 1));
  return pair[0] + pair[1];
#else
  SporeVd pair = (parts[0] + parts[2]) + (parts[1] + parts[3]);
  return pair[0] + pair[1];
#endif
}

/* Three vectors: points or the like, one a lane. */
typedef struct SporeVd3 {
  SporeVd x, y, z;
} SporeVd3;

#if SPORE_WIDTH == 8
/* Three of the four doubles at p; the fourth is not touched. */
SPORE_INLINE __m256d spore_load_three(const double *p) { return _mm256_maskz_loadu_pd(7, p); }
#elif SPORE_WIDTH == 4
SPORE_INLINE __m256d spore_load_three(const double *p) {
  return _mm256_maskload_pd(p, _mm256_setr_epi64x(-1, -1, -1, 0));
}
#endif

/* Lane i from x + 3 index[i], for SPORE_WIDTH lanes. */
SPORE_INLINE SporeVd3 spore_vd3_gather(const double *x, const uint32_t *index) {
#if SPORE_WIDTH == 8
  __m512d row[4], low, high, middle_low, middle_high;
  for (int i = 0; i < 4; i++)
    row[i] = _mm512_insertf64x4(_mm512_castpd256_pd512(spore_load_three(x + 3 * (size_t)index[i])),
                                spore_load_three(x + 3 * (size_t)index[i + 4]), 1);
  low = _mm512_unpacklo_pd(row[0], row[1]), high = _mm512_unpacklo_pd(row[2], row[3]);
  middle_low = _mm512_unpackhi_pd(row[0], row[1]), middle_high = _mm512_unpackhi_pd(row[2], row[3]);
  const __m512i first = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
  const __m512i third = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
  return (SporeVd3){(SporeVd)_mm512_permutex2var_pd(low, first, high),
                    (SporeVd)_mm512_permutex2var_pd(middle_low, first, middle_high),
                    (SporeVd)_mm512_permutex2var_pd(low, third, high)};
#elif SPORE_WIDTH == 4
  __m256d row[4];
  for (int i = 0; i < 4; i++) row[i] = spore_load_three(x + 3 * (size_t)index[i]);
  __m256d low = _mm256_unpacklo_pd(row[0], row[1]), high = _mm256_unpacklo_pd(row[2], row[3]);
  __m256d middle_low = _mm256_unpackhi_pd(row[0], row[1]), middle_high = _mm256_unpackhi_pd(row[2], row[3]);
  return (SporeVd3){(SporeVd)_mm256_permute2f128_pd(low, high, 0x20),
                    (SporeVd)_mm256_permute2f128_pd(middle_low, middle_high, 0x20),
                    (SporeVd)_mm256_permute2f128_pd(low, high, 0x31)};
#else
  const double *a = x + 3 * (size_t)index[0], *b = x + 3 * (size_t)index[1];
  return (SporeVd3){{a[0], b[0]}, {a[1], b[1]}, {a[2], b[2]}};
#endif
}

/* Lane i from x + 3 i: a run of points. */
SPORE_INLINE SporeVd3 spore_vd3_load(const double *x) {
#if SPORE_WIDTH == 8
  __m512d a = _mm512_loadu_pd(x), b = _mm512_loadu_pd(x + 8), c = _mm512_loadu_pd(x + 16);
  __m512d first = _mm512_permutex2var_pd(a, _mm512_setr_epi64(0, 3, 6, 9, 12, 15, 0, 0), b);
  __m512d second = _mm512_permutex2var_pd(a, _mm512_setr_epi64(1, 4, 7, 10, 13, 0, 0, 0), b);
  __m512d third = _mm512_permutex2var_pd(a, _mm512_setr_epi64(2, 5, 8, 11, 14, 0, 0, 0), b);
  return (SporeVd3){(SporeVd)_mm512_permutex2var_pd(first, _mm512_setr_epi64(0, 1, 2, 3, 4, 5, 10, 13), c),
                    (SporeVd)_mm512_permutex2var_pd(second, _mm512_setr_epi64(0, 1, 2, 3, 4, 8, 11, 14), c),
                    (SporeVd)_mm512_permutex2var_pd(third, _mm512_setr_epi64(0, 1, 2, 3, 4, 9, 12, 15), c)};
#elif SPORE_WIDTH == 4
  __m256d a = _mm256_loadu_pd(x), b = _mm256_loadu_pd(x + 4), c = _mm256_loadu_pd(x + 8);
  __m256d xy = _mm256_permute2f128_pd(a, b, 0x30), zx = _mm256_permute2f128_pd(a, c, 0x21);
  __m256d yz = _mm256_permute2f128_pd(b, c, 0x30);
  return (SporeVd3){(SporeVd)_mm256_shuffle_pd(xy, zx, 0xa), (SporeVd)_mm256_shuffle_pd(xy, yz, 0x5),
                    (SporeVd)_mm256_shuffle_pd(zx, yz, 0xa)};
#else
  return (SporeVd3){{x[0], x[3]}, {x[1], x[4]}, {x[2], x[5]}};
#endif
}

/* Lane i to x + 3 i. */
SPORE_INLINE void spore_vd3_store(double *x, SporeVd3 a) {
#if SPORE_WIDTH == 8
  __m512d first = _mm512_permutex2var_pd((__m512d)a.x, _mm512_setr_epi64(0, 8, 0, 1, 9, 0, 2, 10), (__m512d)a.y);
  __m512d second = _mm512_permutex2var_pd((__m512d)a.y, _mm512_setr_epi64(0, 11, 3, 0, 12, 4, 0, 13), (__m512d)a.x);
  __m512d third = _mm512_permutex2var_pd((__m512d)a.x, _mm512_setr_epi64(13, 0, 6, 14, 0, 7, 15, 0), (__m512d)a.y);
  _mm512_storeu_pd(x, _mm512_permutex2var_pd(first, _mm512_setr_epi64(0, 1, 8, 3, 4, 9, 6, 7), (__m512d)a.z));
  _mm512_storeu_pd(x + 8, _mm512_permutex2var_pd(second, _mm512_setr_epi64(10, 1, 2, 11, 4, 5, 12, 7), (__m512d)a.z));
  _mm512_storeu_pd(x + 16, _mm512_permutex2var_pd(third, _mm512_setr_epi64(0, 13, 2, 3, 14, 5, 6, 15), (__m512d)a.z));
#elif SPORE_WIDTH == 4
  __m256d xy = _mm256_shuffle_pd((__m256d)a.x, (__m256d)a.y, 0x0),
          zx = _mm256_shuffle_pd((__m256d)a.z, (__m256d)a.x, 0xa);
  __m256d yz = _mm256_shuffle_pd((__m256d)a.y, (__m256d)a.z, 0xf);
  _mm256_storeu_pd(x, _mm256_permute2f128_pd(xy, zx, 0x20));
  _mm256_storeu_pd(x + 4, _mm256_permute2f128_pd(yz, xy, 0x30));
  _mm256_storeu_pd(x + 8, _mm256_permute2f128_pd(zx, yz, 0x31));
#else
  for (int i = 0; i < 2; i++) x[3 * i] = a.x[i], x[3 * i + 1] = a.y[i], x[3 * i + 2] = a.z[i];
#endif
}

/* Lane i to rows + 4 i, behind it a zero. */
SPORE_INLINE void spore_vd3_store_rows(double *rows, SporeVd3 a) {
#if SPORE_WIDTH == 8
  const __m512d zero = _mm512_setzero_pd();
  __m512d xy_even = _mm512_unpacklo_pd((__m512d)a.x, (__m512d)a.y),
          xy_odd = _mm512_unpackhi_pd((__m512d)a.x, (__m512d)a.y);
  __m512d z_even = _mm512_unpacklo_pd((__m512d)a.z, zero), z_odd = _mm512_unpackhi_pd((__m512d)a.z, zero);
  const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11), high = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
  __m512d even_low = _mm512_permutex2var_pd(xy_even, low, z_even), odd_low = _mm512_permutex2var_pd(xy_odd, low, z_odd);
  __m512d even_high = _mm512_permutex2var_pd(xy_even, high, z_even);
  __m512d odd_high = _mm512_permutex2var_pd(xy_odd, high, z_odd);
  _mm512_storeu_pd(rows, _mm512_shuffle_f64x2(even_low, odd_low, 0x44));
  _mm512_storeu_pd(rows + 8, _mm512_shuffle_f64x2(even_low, odd_low, 0xee));
  _mm512_storeu_pd(rows + 16, _mm512_shuffle_f64x2(even_high, odd_high, 0x44));
  _mm512_storeu_pd(rows + 24, _mm512_shuffle_f64x2(even_high, odd_high, 0xee));
#elif SPORE_WIDTH == 4
  const __m256d zero = _mm256_setzero_pd();
  __m256d xy_even = _mm256_unpacklo_pd((__m256d)a.x, (__m256d)a.y),
          xy_odd = _mm256_unpackhi_pd((__m256d)a.x, (__m256d)a.y);
  __m256d z_even = _mm256_unpacklo_pd((__m256d)a.z, zero), z_odd = _mm256_unpackhi_pd((__m256d)a.z, zero);
  _mm256_storeu_pd(rows, _mm256_permute2f128_pd(xy_even, z_even, 0x20));
  _mm256_storeu_pd(rows + 4, _mm256_permute2f128_pd(xy_odd, z_odd, 0x20));
  _mm256_storeu_pd(rows + 8, _mm256_permute2f128_pd(xy_even, z_even, 0x31));
  _mm256_storeu_pd(rows + 12, _mm256_permute2f128_pd(xy_odd, z_odd, 0x31));
#else
  for (int i = 0; i < 2; i++)
    rows[4 * i] = a.x[i], rows[4 * i + 1] = a.y[i], rows[4 * i + 2] = a.z[i], rows[4 * i + 3] = 0;
#endif
}

/* Four numbers a lane: points and a number that goes with each. */
typedef struct SporeVd4 {
  SporeVd x, y, z, w;
} SporeVd4;

#if SPORE_WIDTH >= 4
/* SPORE_WIDTH rows of four, as four vectors of one entry each. */
SPORE_INLINE SporeVd4 spore_rows_turn(const __m256d row[SPORE_WIDTH]) {
#if SPORE_WIDTH == 8
  __m512d both[4];
  for (int i = 0; i < 4; i++) both[i] = _mm512_insertf64x4(_mm512_castpd256_pd512(row[i]), row[i + 4], 1);
  __m512d low = _mm512_unpacklo_pd(both[0], both[1]), high = _mm512_unpacklo_pd(both[2], both[3]);
  __m512d odd_low = _mm512_unpackhi_pd(both[0], both[1]), odd_high = _mm512_unpackhi_pd(both[2], both[3]);
  const __m512i first = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13),
                third = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
  return (SporeVd4){
      (SporeVd)_mm512_permutex2var_pd(low, first, high), (SporeVd)_mm512_permutex2var_pd(odd_low, first, odd_high),
      (SporeVd)_mm512_permutex2var_pd(low, third, high), (SporeVd)_mm512_permutex2var_pd(odd_low, third, odd_high)};
#else
  __m256d low = _mm256_unpacklo_pd(row[0], row[1]), high = _mm256_unpacklo_pd(row[2], row[3]);
  __m256d odd_low = _mm256_unpackhi_pd(row[0], row[1]), odd_high = _mm256_unpackhi_pd(row[2], row[3]);
  return (SporeVd4){
      (SporeVd)_mm256_permute2f128_pd(low, high, 0x20), (SporeVd)_mm256_permute2f128_pd(odd_low, odd_high, 0x20),
      (SporeVd)_mm256_permute2f128_pd(low, high, 0x31), (SporeVd)_mm256_permute2f128_pd(odd_low, odd_high, 0x31)};
#endif
}

/* The way back. */
SPORE_INLINE void spore_rows_of(SporeVd4 a, __m256d row[SPORE_WIDTH]) {
#if SPORE_WIDTH == 8
  __m512d xy_even = _mm512_unpacklo_pd((__m512d)a.x, (__m512d)a.y),
          zw_even = _mm512_unpacklo_pd((__m512d)a.z, (__m512d)a.w);
  __m512d xy_odd = _mm512_unpackhi_pd((__m512d)a.x, (__m512d)a.y),
          zw_odd = _mm512_unpackhi_pd((__m512d)a.z, (__m512d)a.w);
  const __m512i first = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13),
                third = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
  const __m512d both[4] = {
      _mm512_permutex2var_pd(xy_even, first, zw_even), _mm512_permutex2var_pd(xy_odd, first, zw_odd),
      _mm512_permutex2var_pd(xy_even, third, zw_even), _mm512_permutex2var_pd(xy_odd, third, zw_odd)};
  for (int i = 0; i < 4; i++) row[i] = _mm512_castpd512_pd256(both[i]), row[i + 4] = _mm512_extractf64x4_pd(both[i], 1);
#else
  __m256d xy_even = _mm256_unpacklo_pd((__m256d)a.x, (__m256d)a.y),
          zw_even = _mm256_unpacklo_pd((__m256d)a.z, (__m256d)a.w);
  __m256d xy_odd = _mm256_unpackhi_pd((__m256d)a.x, (__m256d)a.y),
          zw_odd = _mm256_unpackhi_pd((__m256d)a.z, (__m256d)a.w);
  row[0] = _mm256_permute2f128_pd(xy_even, zw_even, 0x20), row[1] = _mm256_permute2f128_pd(xy_odd, zw_odd, 0x20);
  row[2] = _mm256_permute2f128_pd(xy_even, zw_even, 0x31), row[3] = _mm256_permute2f128_pd(xy_odd, zw_odd, 0x31);
#endif
}
#endif

/* Lane i from rows + 4 index[i]. */
SPORE_INLINE SporeVd4 spore_vd4_gather(const double *rows, const uint32_t *index) {
#if SPORE_WIDTH >= 4
  __m256d row[SPORE_WIDTH];
  for (int i = 0; i < SPORE_WIDTH; i++) row[i] = _mm256_loadu_pd(rows + 4 * (size_t)index[i]);
  return spore_rows_turn(row);
#else
  const double *a = rows + 4 * (size_t)index[0], *b = rows + 4 * (size_t)index[1];
  return (SporeVd4){{a[0], b[0]}, {a[1], b[1]}, {a[2], b[2]}, {a[3], b[3]}};
#endif
}

/* Lane i from rows + 4 i. */
SPORE_INLINE SporeVd4 spore_vd4_load(const double *rows) {
  uint32_t index[SPORE_WIDTH];
  for (uint32_t i = 0; i < SPORE_WIDTH; i++) index[i] = i;
  return spore_vd4_gather(rows, index);
}

/* Lane i to rows + 4 index[i], for the first `count` lanes. */
SPORE_INLINE void spore_vd4_scatter(double *rows, const uint32_t *index, size_t count, SporeVd4 a) {
#if SPORE_WIDTH >= 4
  __m256d row[SPORE_WIDTH];
  spore_rows_of(a, row);
  for (size_t i = 0; i < SPORE_WIDTH; i++)
    if (i < count) _mm256_storeu_pd(rows + 4 * (size_t)index[i], row[i]);
#else
  for (size_t i = 0; i < SPORE_WIDTH && i < count; i++) {
    double *row = rows + 4 * (size_t)index[i];
    row[0] = a.x[i], row[1] = a.y[i], row[2] = a.z[i], row[3] = a.w[i];
  }
#endif
}

/* Lane i to rows + 4 i. */
SPORE_INLINE void spore_vd4_store(double *rows, SporeVd4 a) {
  uint32_t index[SPORE_WIDTH];
  for (uint32_t i = 0; i < SPORE_WIDTH; i++) index[i] = i;
  spore_vd4_scatter(rows, index, SPORE_WIDTH, a);
}

SPORE_INLINE SporeVd3 spore_vd3_sub(SporeVd3 a, SporeVd3 b) { return (SporeVd3){a.x - b.x, a.y - b.y, a.z - b.z}; }
SPORE_INLINE SporeVd spore_vd3_dot(SporeVd3 a, SporeVd3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

#endif
#endif
