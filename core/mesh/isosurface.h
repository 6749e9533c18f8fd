/* The surface on which a field vanishes. */
#ifndef SPORE_MESH_ISOSURFACE_H
#define SPORE_MESH_ISOSURFACE_H

#include "core/base/progress.h"
#include "core/mesh/mesh.h"

/* Field at a place, m: negative inside, and nowhere steeper than 1, as distances are. */
typedef double (*SporeDistanceField)(void *data, SporeVec3 place);

/* Cubes of side `step` (m) from `lower` to at least `upper`, outside of which the field is positive, are cut into six
 * tetrahedra each, alike on both sides of each face. Those in which the surface between the crossed edges is farther
 * than `tolerance` (m; HUGE_VAL: none) from where the field vanishes are bisected, with their neighbours, to a 64th of
 * the step at least (Maubach 1995), and points of them are moved onto the surface where it passes near. One vertex
 * where the field vanishes on each crossed edge, and at each point that was moved there: closed, outward, and without
 * intersections with itself. Where the field is farther from 0 than a block of cubes is wide, it is not looked
 * at there. *mesh is empty where nothing is inside. Refused: more than 1e9 cubes. False also: no memory, or
 * cancelled. */
bool spore_isosurface(const double lower[3], const double upper[3], double step, double tolerance,
                      SporeDistanceField field, void *data, SporeTriangleMesh *mesh, const SporeProgress *progress,
                      SporeError *error);

#endif
