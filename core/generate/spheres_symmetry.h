/* Mirror planes of a solid. */
#ifndef SPORE_GENERATE_SPHERES_SYMMETRY_H
#define SPORE_GENERATE_SPHERES_SYMMETRY_H

#include "core/mesh/bvh.h"

#define SPORE_MIRRORS_MOST 3

/* Planes at right angles to each other, through one point. */
typedef struct SporeSymmetry {
  size_t count;
  SporeVec3 point, normal[SPORE_MIRRORS_MOST]; /* m, unit */
} SporeSymmetry;

/* Planes that map the surface onto itself, to a millionth of `diagonal` (m), of those that stand on a coordinate axis
 * or on a principal axis of the surface. bvh: of the mesh. */
void spore_symmetry_find(SporeSymmetry *symmetry, const SporeTriangleMesh *mesh, const SporeBvh *bvh, double diagonal);
/* The point, or its image, that lies on the side of all planes to which their normals point. */
SporeVec3 spore_symmetry_fold(const SporeSymmetry *symmetry, SporeVec3 p);
/* Moved onto the planes whose bits are set. */
SporeVec3 spore_symmetry_bind(const SporeSymmetry *symmetry, unsigned planes, SporeVec3 p);
/* Mirrored in the planes whose bits are set. */
SporeVec3 spore_symmetry_mirror(const SporeSymmetry *symmetry, unsigned planes, SporeVec3 p);

#endif
