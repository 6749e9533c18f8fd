/* Vectors of any length, in the same order of additions on every machine. */
#ifndef SPORE_MATH_VECTOR_H
#define SPORE_MATH_VECTOR_H

#include <stdbool.h>

#include "core/math/simd.h"

/* Nodes on their way from x0, v0 through a step of h seconds: `part` of it is looked at. 3 entries a node. */
typedef struct SporeRowsStep {
  double part, h;
  const double *x0, *v0;
  double *x1, *v1; /* v1: at the end, as far as it is known */
} SporeRowsStep;

SPORE_DECLARE_KERNEL(void, spore_rows_predict, size_t nodes, double *rows, const SporeRowsStep *at,
                     const double *weight);
SPORE_DECLARE_KERNEL(void, spore_rows_follow, size_t nodes, const double *rows, const SporeRowsStep *at);
SPORE_DECLARE_KERNEL(double, spore_vector_dot, size_t n, const double *a, const double *b);
SPORE_DECLARE_KERNEL(void, spore_vector_add_scaled, size_t n, double *y, double s, const double *x);
SPORE_DECLARE_KERNEL(void, spore_vector_scale_add, size_t n, double *y, double s, const double *x);
SPORE_DECLARE_KERNEL(bool, spore_vector_within, size_t n, const double *x, double bound);
SPORE_DECLARE_KERNEL(void, spore_vector_move, size_t n, double *y, const double *x, double s, const double *z);
SPORE_DECLARE_KERNEL(void, spore_nodes_weigh, size_t nodes, double *y, const double *weight, const double *x);
SPORE_DECLARE_KERNEL(void, spore_nodes_kick, size_t nodes, double *y, double s, const double *x, const double *weight);
SPORE_DECLARE_KERNEL(double, spore_nodes_dual, size_t nodes, const double *x, const double *weight);
SPORE_DECLARE_KERNEL(void, spore_nodes_pull, size_t nodes, double *y, const double *weight, const double g[3]);

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
/* y = x + s z */
static inline void spore_vector_move(size_t n, double *y, const double *x, double s, const double *z) {
  SPORE_KERNEL(spore_vector_move)(n, y, x, s, z);
}

/* Vectors of three entries a node, and a weight a node. */
/* y = weight x */
static inline void spore_nodes_weigh(size_t nodes, double *y, const double *weight, const double *x) {
  SPORE_KERNEL(spore_nodes_weigh)(nodes, y, weight, x);
}
/* y += s x / weight */
static inline void spore_nodes_kick(size_t nodes, double *y, double s, const double *x, const double *weight) {
  SPORE_KERNEL(spore_nodes_kick)(nodes, y, s, x, weight);
}
/* Sum of x.x / weight; an entry of 0 adds nothing, whatever its weight. */
static inline double spore_nodes_dual(size_t nodes, const double *x, const double *weight) {
  return SPORE_KERNEL(spore_nodes_dual)(nodes, x, weight);
}
/* y += weight g, the same g for each */
static inline void spore_nodes_pull(size_t nodes, double *y, const double *weight, const double g[3]) {
  SPORE_KERNEL(spore_nodes_pull)(nodes, y, weight, g);
}

/* Rows of four entries a node: x0 + part h u, u = v0 + part (v1 - v0), and one over its weight. */
static inline void spore_rows_predict(size_t nodes, double *rows, const SporeRowsStep *at, const double *weight) {
  SPORE_KERNEL(spore_rows_predict)(nodes, rows, at, weight);
}
/* From rows that were moved since then: u = (row - x0) / (part h), x1 = x0 + h u, v1 = v0 + (u - v0) / part. */
static inline void spore_rows_follow(size_t nodes, const double *rows, const SporeRowsStep *at) {
  SPORE_KERNEL(spore_rows_follow)(nodes, rows, at);
}

#endif
