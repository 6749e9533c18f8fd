/* A pin holds blocks of a body still (Dirichlet): their velocity is zero. */
#ifndef SPORE_CONSTRAINT_PIN_H
#define SPORE_CONSTRAINT_PIN_H

#include <stddef.h>
#include <stdint.h>

#include "core/math/vec3.h"

/* Sets held[i] to 1 for each point (count x 3, m) within `radius` of `centre`; returns how many it found. */
size_t spore_pin_select(const double *points, size_t count, SporeVec3 centre, double radius, uint8_t *held);
/* Takes away the components of the held blocks: velocities, residuals and forces alike. */
void spore_pin_filter(const uint32_t *held_blocks, size_t held_count, double *vector);

#endif
