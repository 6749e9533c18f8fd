/* Sampled distance between two surfaces. */
#ifndef SPORE_GENERATE_SURFACE_DISTANCE_H
#define SPORE_GENERATE_SURFACE_DISTANCE_H

#include "core/base/progress.h"
#include "core/mesh/mesh.h"

/* Points (samples x 3) spread evenly over the area: one each equal share of it, placed in its triangle by the R2
 * sequence (Roberts 2018). The same mesh gives the same points. triangles (samples): which each lies in; may be NULL.
 */
void spore_surface_samples(const SporeTriangleMesh *mesh, size_t samples, double *points, uint32_t *triangles);

/* Hausdorff distance (m), both ways, at `samples` points spread evenly over the area of each. The same meshes give the
 * same number. False: no memory, or cancelled. */
bool spore_surface_distance(const SporeTriangleMesh *a, const SporeTriangleMesh *b, size_t samples, double *distance,
                            const SporeProgress *progress, SporeError *error);

#endif
