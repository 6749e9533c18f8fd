/* Points that follow the vertices of a surface. */
#ifndef SPORE_MODELS_COMMON_SURFACE_MAP_H
#define SPORE_MODELS_COMMON_SURFACE_MAP_H

#include "core/mesh/mesh.h"
#include "core/body/mapping.h"

/* A point on a vertex follows that vertex; points that are the vertices in their order make an identity mapping. A
 * point on a triangle follows its corners by barycentric weights. A point off the surface follows the nearest triangle
 * and one more vertex: the four make a tetrahedron that carries it affinely. That vertex is chosen so that the sum of
 * the absolute weights is least, then by nearness. Where even the best sum passes 100 the surface is flat there and
 * cannot carry the point: an offset up to 1e-6 of the surface's size is dropped, a greater one refused.
 * slack (m): up to it an offset is dropped as soon as its sum passes 4.
 *
 * core: place of a node within the body that comes after those of the surface, which carries points off the surface
 * instead of one more vertex wherever the sum is at most 4 with it and the nearest triangle, or else with it and the
 * triangle that makes the sum least; NULL: there is none. A matrix that couples the core with every vertex has room for
 * what hangs on such a point. */
bool spore_surface_map(const SporeTriangleMesh *mesh, const SporeVec3 *core, const double *points, size_t count,
                       const SporeCancel *cancel, double slack, SporeMapping *mapping, SporeError *error);

#endif
