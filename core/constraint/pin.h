/* A pin holds blocks of a body still (Dirichlet): their velocity is zero. */
#ifndef SPORE_CONSTRAINT_PIN_H
#define SPORE_CONSTRAINT_PIN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/math/spline.h"
#include "core/math/vec3.h"

/* Sets held[i] to 1 for each point (count x 3, m) within `radius` of `centre`; returns how many it found. */
size_t spore_pin_select(const double *points, size_t count, SporeVec3 centre, double radius, uint8_t *held);
/* Takes away the components of the held blocks: velocities, residuals and forces alike. */
void spore_pin_filter(const uint32_t *held_blocks, size_t held_count, double *vector);

/* Where a cubic spline bends as if it were clamped, of which control points first .. last are held, on the side towards
 * its end (side 1) or its start (side -1): *parameter, of the line. A line is still where all four control points are
 * held that weigh on it; its curvature is held at that place too, so the clamp acts 0.29 spans farther out (Galerkin
 * solution of a clamped beam; 0.301 with 10 control points, 0.290 with 80). Two at an end of the line clamp it there.
 * False: the line can turn, since fewer are held; or the side has nothing that is free. */
bool spore_pin_clamp(SporeSplineKnots knots, size_t first, size_t last, int side, double *parameter);

#endif
