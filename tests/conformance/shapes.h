/* Simple shapes for tests, in metres. Meshes are cleared with the mesh room's functions. */
#ifndef SPORE_TESTS_SHAPES_H
#define SPORE_TESTS_SHAPES_H

#include <glib.h>

#include "core/math/quat.h"
#include "core/mesh/mesh.h"

/* Box of the given sides about `centre`: 12 triangles, outward. */
void shape_box(SporeTriangleMesh *mesh, SporeVec3 centre, SporeVec3 sides);
/* Sheet of columns x rows vertices in the plane z = 0, spacing apart, vertex (column, row) at index row * columns +
 * column, first at the origin; diagonals alternate when `alternate`. */
void shape_sheet(SporeTriangleMesh *mesh, unsigned columns, unsigned rows, double spacing, gboolean alternate);
/* The same in the plane of x and z. */
void shape_level_sheet(SporeTriangleMesh *mesh, unsigned columns, unsigned rows, double spacing);
/* Block of nx x ny x nz cells from the origin to `size`, six tetrahedra a cell; vertex (i, j, k) at index
 * (i (ny + 1) + j) (nz + 1) + k. */
void shape_block(SporeTetrahedralMesh *mesh, unsigned nx, unsigned ny, unsigned nz, SporeVec3 size);
/* Surface of that block, which must have no vertex inside. */
void shape_block_surface(SporeTriangleMesh *mesh, unsigned nx, unsigned ny, unsigned nz, SporeVec3 size);
/* Straight line of the given length from the origin, askew: `count` points. */
void shape_line(SporeCurve *curve, unsigned count, double length, double radius);
/* Turn and a half of a helix about y. */
void shape_helix(SporeCurve *curve, unsigned count, double winding, double pitch, double radius);
/* The same mesh with vertex i renamed order[i] and the elements turned round: last first. */
void shape_relabel_triangles(SporeTriangleMesh *to, const SporeTriangleMesh *from, const uint32_t *order);
void shape_relabel_tetrahedra(SporeTetrahedralMesh *to, const SporeTetrahedralMesh *from, const uint32_t *order);
/* A permutation of 0..count-1, g_free. */
uint32_t *shape_order(size_t count, GRand *random);
SporeVec3 shape_random_vector(GRand *random, double amplitude);
SporeQuat shape_random_rotation(GRand *random);

#endif
