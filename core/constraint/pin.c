/* Choosing held points, clearing the entries of held blocks, and what holding control points does to a line. */
#include "core/constraint/pin.h"

#include <assert.h>

size_t spore_pin_select(const double *points, size_t count, SporeVec3 centre, double radius, uint8_t *held) {
  assert(count == 0 || (points && held));
  assert(radius >= 0);
  size_t found = 0;
  for (size_t i = 0; i < count; i++) {
    if (spore_vec3_distance(spore_vec3_load(points + 3 * i), centre) > radius) continue;
    held[i] = 1;
    found++;
  }
  return found;
}

void spore_pin_filter(const uint32_t *held_blocks, size_t held_count, double *vector) {
  assert(held_count == 0 || (held_blocks && vector));
  for (size_t i = 0; i < held_count; i++) spore_vec3_store(vector + 3 * (size_t)held_blocks[i], (SporeVec3){0, 0, 0});
}

#define BEYOND_STILL 0.29 /* spans */

bool spore_pin_clamp(SporeSplineKnots knots, size_t first, size_t last, int side, double *parameter) {
  assert(parameter && (side == 1 || side == -1));
  size_t count = knots.span_count + 3;
  assert(first <= last && last < count);
  if (side > 0 ? last + 1 == count : first == 0) return false;
  size_t held = last - first + 1;
  bool at_start = side > 0 && first == 0, at_end = side < 0 && last + 1 == count;
  if (held == 2 && (at_start || at_end)) {
    *parameter = at_start ? 0 : spore_spline_end(knots);
    return true;
  }
  if (held < 3) return false;
  /* Side 1: spans up to number last - 3 are still. Side -1: spans from number first on are. */
  if (side > 0) *parameter = spore_spline_break(knots, last - 2) + BEYOND_STILL * spore_spline_width(knots, last - 2);
  else *parameter = spore_spline_break(knots, first) - BEYOND_STILL * spore_spline_width(knots, first - 1);
  return true;
}
