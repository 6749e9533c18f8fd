/* Linear combinations of points, for mapping.c. */
#ifndef SPORE_SIM_MAPPING_KERNELS_H
#define SPORE_SIM_MAPPING_KERNELS_H

#include "core/math/simd.h"
#include "core/body/mapping.h"

/* combined: 3 a point of the linear mapping, of values, 3 a block; in the order of the row. */
SPORE_DECLARE_KERNEL(void, spore_mapping_combine, const SporeMapping *mapping, const double *values, double *combined);

#endif
