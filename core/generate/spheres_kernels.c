#include "core/generate/spheres_kernels.h"

#include <math.h>

#include "core/generate/spheres_parts.h"

#define LANES 16 /* of the widest set: what is known of so many points stays in registers */

/* Single precision will do: lengths are relative to the block. */
void SPORE_LEVEL_NAME(spore_field_block)(const SporeNearBalls *balls, const float *x, const float *y, const float *z,
                                         float *best, float *second, float *owner) {
  for (size_t first = 0; first < SPORE_BLOCK; first += LANES) {
    float most[LANES], next[LANES], whose[LANES];
    for (int k = 0; k < LANES; k++) most[k] = next[k] = -HUGE_VALF, whose[k] = 0;
    for (size_t i = 0; i < balls->count; i++) {
      float cx = balls->x[i], cy = balls->y[i], cz = balls->z[i], r = balls->r[i], number = balls->number[i];
      for (int k = 0; k < LANES; k++) {
        float dx = cx - x[first + k], dy = cy - y[first + k], dz = cz - z[first + k];
        float value = r - sqrtf(dx * dx + dy * dy + dz * dz), before = most[k];
        float lower = value < before ? value : before;
        next[k] = lower > next[k] ? lower : next[k];
        whose[k] = value > before ? number : whose[k];
        most[k] = value > before ? value : before;
      }
    }
    for (int k = 0; k < LANES; k++) best[first + k] = most[k], second[first + k] = next[k], owner[first + k] = whose[k];
  }
}
