/* Thermal motion of particles, cube by cube. */
#include "models/particles/thermal_motion.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"

bool spore_thermal_motion_init(SporeThermalMotion *motion, size_t particle_count, double size) {
  assert(size > 0);
  *motion = (SporeThermalMotion){.size = size, .particle_count = particle_count, .cell_count = 8};
  while (motion->cell_count < 2 * particle_count) motion->cell_count *= 2;
  motion->mask = motion->cell_count - 1;
  motion->cells = SPORE_NEW_ARRAY(SporeThermalCell, motion->cell_count);
  motion->cell_of = SPORE_NEW_ARRAY(uint32_t, particle_count);
  return motion->cells && motion->cell_of;
}

void spore_thermal_motion_clear(SporeThermalMotion *motion) {
  spore_free(motion->cells);
  spore_free(motion->cell_of);
  *motion = (SporeThermalMotion){.size = 0};
}

/* Far enough for every scene, and within what a whole number holds. */
static int64_t place_along(double x, double size) { return (int64_t)fmax(fmin(floor(x / size), 1e15), -1e15); }

/* The cube at the place; an empty one where none was met in this evaluation. There are twice as many as particles. */
static uint32_t cell_at(SporeThermalMotion *motion, const int64_t place[3]) {
  uint64_t hash = (uint64_t)place[0] * 0x9e3779b97f4a7c15u ^ (uint64_t)place[1] * 0xc2b2ae3d27d4eb4fu ^
                  (uint64_t)place[2] * 0x165667b19e3779f9u;
  for (size_t i = (size_t)(hash >> 32) & motion->mask;; i = (i + 1) & motion->mask) {
    SporeThermalCell *cell = &motion->cells[i];
    if (cell->stamp != motion->stamp) {
      *cell = (SporeThermalCell){.stamp = motion->stamp, .place = {place[0], place[1], place[2]}};
      return (uint32_t)i;
    }
    if (memcmp(cell->place, place, sizeof cell->place) == 0) return (uint32_t)i;
  }
}

double spore_thermal_motion_find(SporeThermalMotion *motion, const double *q, const double *v, const double period[3]) {
  size_t met = 0;
  double square = 0;
  motion->stamp++;
  for (size_t i = 0; i < motion->particle_count; i++) {
    int64_t place[3];
    for (size_t k = 0; k < 3; k++) {
      double x = q[3 * i + k];
      if (period[k] > 0) x -= period[k] * floor(x / period[k]);
      place[k] = place_along(x, motion->size);
    }
    SporeThermalCell *cell = &motion->cells[motion->cell_of[i] = cell_at(motion, place)];
    met += cell->count++ == 0;
    for (size_t k = 0; k < 3; k++) cell->velocity[k] += (v[3 * i + k] - cell->velocity[k]) / cell->count;
  }
  for (size_t i = 0; i < 3 * motion->particle_count; i++) {
    double thermal = v[i] - motion->cells[motion->cell_of[i / 3]].velocity[i % 3];
    square += thermal * thermal;
  }
  motion->degrees = 3 * (motion->particle_count - met);
  return motion->degrees > 0 ? square / (double)motion->degrees : 0;
}

void spore_thermal_motion_push(const SporeThermalMotion *motion, const double *v, double rate, double *f) {
  for (size_t i = 0; i < 3 * motion->particle_count; i++)
    f[i] += rate * (v[i] - motion->cells[motion->cell_of[i / 3]].velocity[i % 3]);
}
