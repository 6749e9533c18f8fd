/* Changes to a triangle mesh as it came from a file: its pieces, its flaws, its shape. All in place; false with an
 * error leaves the mesh as it was. */
#ifndef SPORE_MESH_EDIT_H
#define SPORE_MESH_EDIT_H

#include "core/base/progress.h"
#include "core/mesh/mesh.h"

/* pieces[t]: which connected piece (sets of triangles joined by edges, as in SporeMeshReport) triangle t is of, counted
 * in the order of their first triangles. triangle_count numbers from spore_allocate. */
bool spore_triangle_mesh_pieces(const SporeTriangleMesh *mesh, uint32_t **pieces, size_t *count, SporeError *error);

/* The triangles t with pieces[t] == piece and their vertices, in order. *part is overwritten. */
bool spore_triangle_mesh_extract(const SporeTriangleMesh *mesh, const uint32_t *pieces, uint32_t piece,
                                 SporeTriangleMesh *part, SporeError *error);

/* Puts `more` behind what is there; nothing is welded. */
bool spore_triangle_mesh_append(SporeTriangleMesh *mesh, const SporeTriangleMesh *more, SporeError *error);

/* Triangles without area: a side of no length is merged away, a corner on its opposite side is freed by giving that
 * side's other triangle the two halves; one at an open edge is dropped. Also drops duplicates (whichever way they
 * turn) and unused vertices. `relative` as for spore_triangle_mesh_weld. */
bool spore_triangle_mesh_clean(SporeTriangleMesh *mesh, double relative, SporeError *error);

/* Closes each open loop of at most `most_edges` edges (0: any) by triangles between its own corners, of least total
 * area (Barequet and Sharir 1995, "Filling gaps in the boundary of a polyhedron"); of loops of over 300 edges the
 * corners with the shortest diagonals are cut off first. Left open: a loop whose filling would put a third triangle on
 * an edge. Neighbouring triangles should turn the same way: see spore_triangle_mesh_orient. */
bool spore_triangle_mesh_fill_holes(SporeTriangleMesh *mesh, size_t most_edges, const SporeProgress *progress,
                                    SporeError *error);

/* `rounds` rounds of Taubin's smoothing (1995, "A signal processing approach to fair surface design": lambda 0.5,
 * mu -0.53, equal weights), open edges smoothed along themselves alone; then each closed piece is moved along its
 * normals until its volume is what it was; one that has not it back then, or clearly more area than it had, was too
 * thin for so many rounds and stays as it came. */
bool spore_triangle_mesh_smooth(SporeTriangleMesh *mesh, size_t rounds, const SporeProgress *progress,
                                SporeError *error);

#endif
