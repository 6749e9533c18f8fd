/* Sampled distance between two surfaces. */
#ifndef SPORE_GENERATE_SURFACE_DISTANCE_H
#define SPORE_GENERATE_SURFACE_DISTANCE_H

#include "core/base/progress.h"
#include "core/mesh/mesh.h"

/* Hausdorff distance (m), both ways, at `samples` points spread evenly over the area of each. The same meshes give the
 * same number. False: no memory, or cancelled. */
bool spore_surface_distance(const SporeTriangleMesh *a, const SporeTriangleMesh *b, size_t samples, double *distance,
                            const SporeProgress *progress, SporeError *error);

#endif
