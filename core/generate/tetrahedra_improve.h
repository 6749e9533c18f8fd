/* Makes cells better in place: no library, any mesher's result. */
#ifndef SPORE_GENERATE_TETRAHEDRA_IMPROVE_H
#define SPORE_GENERATE_TETRAHEDRA_IMPROVE_H

#include "core/base/progress.h"
#include "core/generate/sizing.h"
#include "core/generate/tetrahedra_skin.h"

/* Raises the least quality of a cell (spore_tetrahedron_quality) as long as it is below `goal` and that helps: vertices
 * move to where the worst cell around them is best, edges and faces inside are exchanged, slivers on the boundary go.
 * Vertices of the boundary move on `surface` alone; NULL: not at all. labels (one a cell, from spore_allocate; may be
 * NULL): a face between two labels counts as boundary, and cells that are made keep their label. Vertices keep their
 * numbers; the number of cells may change, *labels with it. The least quality of all never falls. Slow only where there
 * are many bad cells. False: no memory or cancelled; the mesh can only be cleared then. */
bool spore_tetrahedra_improve(SporeTetrahedralMesh *mesh, uint32_t **labels, const SporeBvh *surface, double goal,
                              const SporeProgress *progress, SporeError *error);

/* Draws edges together until `cells` are left, or fewer cannot be: the shortest first, by the edges that are wanted,
 * and those that keep the skin nearest to its points. No cell's quality falls below `least`. mesh->labels are kept.
 * Vertices keep their numbers; some are in no cell any more. */
bool spore_tetrahedra_coarsen(SporeTetrahedralMesh *mesh, const SporeBvh *surface, SporeSkinPoints *points,
                              const SporeSizing *sizing, size_t cells, double least, const SporeProgress *progress,
                              SporeError *error);

/* Moves vertices of the skin to where its faces are nearest to their points (and their middles to `surface`, unless it
 * is NULL), be that off the surface; distances beyond `usual` count more than by their squares. No cell's quality falls
 * below `least` (or below what it is). Points keep their hosts. */
bool spore_tetrahedra_approach(SporeTetrahedralMesh *mesh, const SporeBvh *surface, SporeSkinPoints *points, int rounds,
                               double usual, double least, SporeError *error);

/* Parts cells that hold together at an edge or a vertex of the boundary alone: by further vertices in the same place,
 * or where the cells hold together elsewhere too, by cells at the edge that go. The boundary is a surface then. */
bool spore_tetrahedra_mend(SporeTetrahedralMesh *mesh, SporeError *error);

#endif
