/* Makes cells better in place: no library, any mesher's result. */
#ifndef SPORE_GENERATE_TETRAHEDRA_IMPROVE_H
#define SPORE_GENERATE_TETRAHEDRA_IMPROVE_H

#include "core/base/progress.h"
#include "core/mesh/bvh.h"

/* Raises the least quality of a cell (spore_tetrahedron_quality) as long as it is below `goal` and that helps: vertices
 * move to where the worst cell around them is best, edges and faces inside are exchanged, slivers on the boundary go.
 * Vertices of the boundary move on `surface` alone; NULL: not at all. labels (one a cell, from spore_allocate; may be
 * NULL): a face between two labels counts as boundary, and cells that are made keep their label. Vertices keep their
 * numbers; the number of cells may change, *labels with it. The least quality of all never falls. Slow only where there
 * are many bad cells. False: no memory or cancelled; the mesh can only be cleared then. */
bool spore_tetrahedra_improve(SporeTetrahedralMesh *mesh, uint32_t **labels, const SporeBvh *surface, double goal,
                              const SporeProgress *progress, SporeError *error);

/* Moves vertices of the boundary to points of the surface (count x 3) that lie farther than `tolerance` from the mesh,
 * as far as no cell's quality falls below `least` (or below what it is); repeats while the largest distance gets less.
 */
bool spore_tetrahedra_pull(SporeTetrahedralMesh *mesh, const SporeBvh *surface, const double *points, size_t count,
                           double tolerance, double least, const SporeProgress *progress, SporeError *error);

/* Vertices on a surface leave the faces between them on one side of it, all within what bends outward: moves those of
 * the boundary along their normals until the surface runs through the faces' middle, where no quality falls below
 * `least` (or below what it is). The volume comes near that of the surface, and the largest distance halves where the
 * surface is smooth; points (count x 3) of the surface say whether it is worth it: else nothing changes. */
bool spore_tetrahedra_balance(SporeTetrahedralMesh *mesh, const SporeBvh *surface, const double *points, size_t count,
                              double least, SporeError *error);

#endif
