/* Procedural meshes with known measures, for tests. */
#ifndef SPORE_TESTS_MESH_SHAPES_H
#define SPORE_TESTS_MESH_SHAPES_H

#include "core/mesh/mesh.h"

/* Each aborts without memory; clear the result with spore_triangle_mesh_clear. All are closed and outward. */

/* Cube between the corners, each face divided n x n, vertices shared. */
void shape_box(SporeTriangleMesh *mesh, const double lower[3], const double upper[3], size_t n);
/* A box blown up to a sphere about the origin: vertices exactly on the radius. */
void shape_ball(SporeTriangleMesh *mesh, double radius, size_t n);
/* About the z axis: `major` to the middle of the tube, `minor` its radius. */
void shape_torus(SporeTriangleMesh *mesh, double major, double minor, size_t around, size_t across);
/* Ball swept along z from -half to half. */
void shape_capsule(SporeTriangleMesh *mesh, double radius, double half, size_t n);
/* Appends b's triangles to a. */
void shape_append(SporeTriangleMesh *a, const SporeTriangleMesh *b);
void shape_move(SporeTriangleMesh *mesh, double x, double y, double z);
/* Turns every triangle over. */
void shape_turn(SporeTriangleMesh *mesh);
/* Gives each triangle vertices of its own. */
void shape_unweld(SporeTriangleMesh *mesh);
/* The cube [0, n]^3 times `edge` in cubes of six tetrahedra. */
void shape_tetrahedral_box(SporeTetrahedralMesh *mesh, size_t n, double edge);

#endif
