/* The volume within a surface, by itself: a report of the surface, which says whether it is closed, takes longer. */
#ifndef SPORE_MESH_VOLUME_H
#define SPORE_MESH_VOLUME_H

#include "core/mesh/mesh.h"

/* m^3, as in the report: positive where the triangles look outward, without meaning where the surface is not closed. */
double spore_triangle_mesh_volume(const SporeTriangleMesh *mesh);

#endif
