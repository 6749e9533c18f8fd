/* Declarations shared by the files about a solid. */
#ifndef SPORE_GENERATE_COMMON_SOLID_H
#define SPORE_GENERATE_COMMON_SOLID_H

#include "core/generate/common/common.h"

/* A random point of the cells at `share` of their volume; false: the point is not in the solid. */
bool spore_solid_try(const SporeSolid *solid, double share, SporeRandom *random, double p[3]);

#endif
