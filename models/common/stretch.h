/* How far a deformation stretches. */
#ifndef SPORE_MODELS_COMMON_STRETCH_H
#define SPORE_MODELS_COMMON_STRETCH_H

#include "core/math/vec3.h"

/* The square of the largest stretch of a deformation whose gradient F has the columns f, if that is more than `most`,
 * else `most`: the largest eigenvalue of F^T F. Costs little where it is not more. */
double spore_stretch_square(const SporeVec3 f[3], double most);

#endif
