/* Forward and back through a factor that acts on all coordinates alike. */
#include "core/linalg/point_cholesky_kernels.h"

#include <assert.h>

#include "core/math/simd_matrix.h"

typedef double Row __attribute__((vector_size(32), aligned(8), may_alias));

SPORE_INLINE Row *row_at(double *rows, size_t place) { return (Row *)(void *)(rows + 4 * place); }

/* A group of columns: rows below all of them, and the columns' numbers there. */
typedef struct Group {
  size_t first, count;
  const uint32_t *row;
  const double *value[SPORE_POINT_GROUP];
} Group;

SPORE_INLINE Group group_at(const SporePointFactor *factor, const SporePointPattern *pattern, size_t g, size_t width) {
  size_t first = pattern->group[g], last = first + width - 1;
  Group group = {first, pattern->start[last + 1] - pattern->start[last], pattern->row + pattern->start[last], {NULL}};
  SPORE_UNROLL for (size_t k = 0; k < width; k++) group.value[k] =
      factor->value + pattern->start[first + k] + (width - 1 - k);
  return group;
}

/* The number of the group's column k in the row of its column l > k. */
SPORE_INLINE double within(const Group *group, size_t width, size_t k, size_t l) {
  return group->value[k][(ptrdiff_t)(l - width)];
}

SPORE_INLINE void forward(const SporePointFactor *factor, const SporePointPattern *pattern, double *rows, size_t g,
                          size_t width) {
  Group group = group_at(factor, pattern, g, width);
  Row x[SPORE_POINT_GROUP];
  SPORE_UNROLL for (size_t l = 0; l < width; l++) {
    Row own = *row_at(rows, group.first + l);
    SPORE_UNROLL for (size_t k = 0; k < l; k++) own -= within(&group, width, k, l) * x[k];
    *row_at(rows, group.first + l) = x[l] = own * factor->inverse[group.first + l];
  }
  for (size_t i = 0; i < group.count; i++) {
    Row *to = row_at(rows, group.row[i]), sum = *to;
    SPORE_UNROLL for (size_t k = 0; k < width; k++) sum -= group.value[k][i] * x[k];
    *to = sum;
  }
}

SPORE_INLINE void backward(const SporePointFactor *factor, const SporePointPattern *pattern, double *rows, size_t g,
                           size_t width) {
  Group group = group_at(factor, pattern, g, width);
  Row x[SPORE_POINT_GROUP];
  SPORE_UNROLL for (size_t k = 0; k < width; k++) x[k] = *row_at(rows, group.first + k);
  for (size_t i = 0; i < group.count; i++) {
    Row from = *row_at(rows, group.row[i]);
    SPORE_UNROLL for (size_t k = 0; k < width; k++) x[k] -= group.value[k][i] * from;
  }
  for (size_t l = width; l-- > 0;) {
    x[l] *= factor->inverse[group.first + l];
    *row_at(rows, group.first + l) = x[l];
    for (size_t k = 0; k < l; k++) x[k] -= within(&group, width, k, l) * x[l];
  }
}

void SPORE_LEVEL_NAME(spore_point_solve_rows)(const SporePointFactor *factor, const SporePointPattern *pattern,
                                              double *rows) {
  assert(pattern->count > 0);
  for (size_t g = 0; g < pattern->group_count; g++) {
    size_t width = pattern->group[g + 1] - pattern->group[g];
    if (width == 4) forward(factor, pattern, rows, g, 4);
    else if (width == 3) forward(factor, pattern, rows, g, 3);
    else if (width == 2) forward(factor, pattern, rows, g, 2);
    else forward(factor, pattern, rows, g, 1);
  }
  for (size_t g = pattern->group_count; g-- > 0;) {
    size_t width = pattern->group[g + 1] - pattern->group[g];
    if (width == 4) backward(factor, pattern, rows, g, 4);
    else if (width == 3) backward(factor, pattern, rows, g, 3);
    else if (width == 2) backward(factor, pattern, rows, g, 2);
    else backward(factor, pattern, rows, g, 1);
  }
}
