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
