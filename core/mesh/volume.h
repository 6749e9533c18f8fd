/* The volume within a surface, and whether there is an inside at all: a report of the surface, which counts its faults,
 * takes much longer. */
#ifndef SPORE_MESH_VOLUME_H
#define SPORE_MESH_VOLUME_H

#include "core/mesh/mesh.h"

/* m^3, as in the report: positive where the triangles look outward, without meaning where the surface is not closed. */
double spore_triangle_mesh_volume(const SporeTriangleMesh *mesh);
/* Whether each edge is passed as often one way as the other, so that no way leads around an edge to the back of a
 * triangle. Closed in the report is this, and two triangles at each edge. */
bool spore_triangle_mesh_has_inside(const SporeTriangleMesh *mesh);

#endif
