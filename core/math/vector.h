/* Vectors of any length, in the same order of additions on every machine. */
#ifndef SPORE_MATH_VECTOR_H
#define SPORE_MATH_VECTOR_H

#include <stdbool.h>

#include "core/math/simd.h"

SPORE_DECLARE_KERNEL(double, spore_vector_dot, size_t n, const double *a, const double *b);
SPORE_DECLARE_KERNEL(void, spore_vector_add_scaled, size_t n, double *y, double s, const double *x);
SPORE_DECLARE_KERNEL(void, spore_vector_scale_add, size_t n, double *y, double s, const double *x);
SPORE_DECLARE_KERNEL(bool, spore_vector_within, size_t n, const double *x, double bound);

static inline double spore_vector_dot(size_t n, const double *a, const double *b) {
  return SPORE_KERNEL(spore_vector_dot)(n, a, b);
}
/* y += s x */
static inline void spore_vector_add_scaled(size_t n, double *y, double s, const double *x) {
  SPORE_KERNEL(spore_vector_add_scaled)(n, y, s, x);
}
/* y = s y + x */
static inline void spore_vector_scale_add(size_t n, double *y, double s, const double *x) {
  SPORE_KERNEL(spore_vector_scale_add)(n, y, s, x);
}
/* Whether every |x| <= bound; false where one is not a number. With DBL_MAX: whether all are finite. */
static inline bool spore_vector_within(size_t n, const double *x, double bound) {
  return SPORE_KERNEL(spore_vector_within)(n, x, bound);
}

#endif
