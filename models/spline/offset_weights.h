/* Weights by which control points reproduce a point that lies beside the line or sheet that they span. */
#ifndef SPORE_MODELS_SPLINE_OFFSET_WEIGHTS_H
#define SPORE_MODELS_SPLINE_OFFSET_WEIGHTS_H

#include <stddef.h>

#include "core/math/vec3.h"

#define SPORE_OFFSET_WEIGHTS_MOST 100 /* sum of absolute weights that carry an offset */
#define SPORE_OFFSET_WEIGHTS_LIGHT 4  /* as many that are no reason to take more points */

/* Adds weights of sum 0 on `count` points (x y z each) that together make `offset`: of all such weights the least by
 * squares. Components of the offset up to `nothing` (m) are left out. Returns the sum of the absolute weights; infinite
 * where the points lie on a line or plane that the offset leaves. `work`: count doubles. */
double spore_offset_weights(const double *points, size_t count, SporeVec3 offset, double nothing, double *weight,
                            double *work);

/* Length of the diagonal of the box around the points, m. */
double spore_points_size(const double *points, size_t count);

#endif
