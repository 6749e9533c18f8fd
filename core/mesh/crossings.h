/* Where a surface goes through itself. */
#ifndef SPORE_MESH_CROSSINGS_H
#define SPORE_MESH_CROSSINGS_H

#include "core/mesh/mesh.h"

/* *count: pairs of triangles of which an edge of one goes through the other; edges that both share a corner with do not
 * count, nor do triangles that fold onto each other in a plane. crossing: for each triangle, whether it is in such a
 * pair; NULL: not asked for. False: no memory. */
bool spore_triangle_mesh_crossings(const SporeTriangleMesh *mesh, size_t *count, bool *crossing);

#endif
