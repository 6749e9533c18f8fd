/* Thermal motion of particles: how fast they go beside the others around them, and a push or a drag on that alone. */
#ifndef SPORE_MODELS_PARTICLES_THERMAL_MOTION_H
#define SPORE_MODELS_PARTICLES_THERMAL_MOTION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct SporeThermalCell {
  uint64_t stamp; /* of the evaluation that it was used in last */
  int64_t place[3];
  double velocity[3]; /* sum of its particles, then their mean, m/s */
  uint32_t count;
} SporeThermalCell;

/* Cubes in space with the particles in them, found by a hash of their place. */
typedef struct SporeThermalMotion {
  double size; /* m, of a cube */
  size_t particle_count, cell_count, mask;
  size_t degrees; /* of freedom of thermal motion, as found */
  uint64_t stamp;
  SporeThermalCell *cells;
  uint32_t *cell_of; /* of each particle */
} SporeThermalMotion;

/* size: of the cubes, m. False: no memory. */
bool spore_thermal_motion_init(SporeThermalMotion *motion, size_t particle_count, double size);
void spore_thermal_motion_clear(SporeThermalMotion *motion);

/* Puts particles (q and v: particle_count x 3, m and m/s, finite) into their cubes. period: of space along each axis,
 * m; 0: none. Returns the mean of the squared thermal velocity of a particle along one axis, m^2/s^2, that is
 * temperature over mass; 0 where no two particles share a cube. Thermal is the velocity beside the mean one of the
 * cube; as the mean is of the same particles, a cube of n counts n - 1 of them. */
double spore_thermal_motion_find(SporeThermalMotion *motion, const double *q, const double *v, const double period[3]);
/* f += rate * thermal velocity of each particle, as found; rate: kg/s. The force on the particles of a cube is none in
 * sum, so that the flow goes on. */
void spore_thermal_motion_push(const SporeThermalMotion *motion, const double *v, double rate, double *f);

#endif
