/* Directions of springs, for kernel files. */
#ifndef SPORE_MODELS_NET_SPRINGS_LINES_H
#define SPORE_MODELS_NET_SPRINGS_LINES_H

#include "core/math/simd.h"
#include "core/math/vec3.h"

/* Below this part of the rest length a spring has no direction of its own. */
#define SPORE_SHORT_SPRING 1e-9

/* Directions of springs that have none: the direction at rest, at a length that loses nothing to rounding. The springs
 * lead from the nodes `to` to the nodes `from`. */
static __attribute__((noinline)) SporeVd3 spore_lines_at_rest(const double *rest, const uint32_t *from,
                                                              const uint32_t *to, SporeVd length, SporeVd3 line,
                                                              SporeVl is_short) {
  for (int i = 0; i < SPORE_WIDTH; i++) {
    if (!is_short[i]) continue;
    SporeVec3 a = spore_vec3_load(rest + 3 * (size_t)from[i]), b = spore_vec3_load(rest + 3 * (size_t)to[i]);
    SporeVec3 along = spore_vec3_normalise(spore_vec3_sub(a, b), (SporeVec3){0, 0, 0});
    along = spore_vec3_scale(SPORE_SHORT_SPRING * length[i], along);
    line.x[i] = along.x, line.y[i] = along.y, line.z[i] = along.z;
  }
  return line;
}

/* The line, or the line at rest where the line is too short; *square: the square of its length, above 0. */
SPORE_INLINE SporeVd3 spore_line_not_short(const double *rest, const uint32_t *from, const uint32_t *to, SporeVd3 line,
                                           SporeVd length, SporeVd *square) {
  *square = spore_vd3_dot(line, line);
  SporeVl is_short = *square < SPORE_SHORT_SPRING * SPORE_SHORT_SPRING * length * length;
  if (__builtin_expect(spore_vl_any(is_short), 0)) {
    line = spore_lines_at_rest(rest, from, to, length, line, is_short);
    *square = spore_vd3_dot(line, line);
  }
  *square += 1e-300;
  return line;
}

#endif
