/* Weights by which control points carry a point that lies beside what they span as a line or a sheet. */
#ifndef SPORE_MODELS_SPLINE_CARRY_H
#define SPORE_MODELS_SPLINE_CARRY_H

#include <stddef.h>

#include "core/math/vec3.h"

#define SPORE_CARRY_AT_MOST 100 /* sum of absolute weights that carry an offset */
#define SPORE_CARRY_LIGHT 4     /* as many that are no reason to take more points */

/* Adds weights of sum 0 on `count` points (x y z each) that together make `offset`: the least by squares. Parts of the
 * offset up to `nothing` (m) are left out. Returns the sum of the absolute weights; infinite where the points lie on a
 * line or plane that the offset leaves. `work`: count doubles. */
double spore_carry_offset(const double *points, size_t count, SporeVec3 offset, double nothing, double *weight,
                          double *work);

/* Length of the diagonal of the box around the points, m. */
double spore_carry_size(const double *points, size_t count);

#endif
