/* The lattice of tetrahedra, coarsened, alone. */
#include <math.h>

#include "cells.h"
#include "core/base/memory.h"
#include "tests/mesh/shapes.h"

static const double low[3] = {0, 0, 0}, high[3] = {0.1, 0.1, 0.1};

/* The lattice alone: angles that the method proves, the volume of a ball, nothing outside. */
static void test_voxels(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 10);
  shape_move(&surface, 0.3, 0, 0);
  Result result = fill(&surface, (SporeTetrahedraOptions){.method = SPORE_TETRAHEDRA_VOXELS, .cells = 1000}, "voxels");
  check_cells(&result, 1000);
  g_assert_cmpfloat(result.report.quality.min_dihedral_deg, >=, 10.7);
  g_assert_cmpfloat(result.report.hausdorff, <, 0.01);
  g_assert_cmpfloat(fabs(result.report.volume_change), <, 0.03);
  g_assert_cmpfloat(fabs(result.report.area_change), <, 0.03);
  for (gsize i = 0; i < result.mesh.vertex_count; i++) {
    SporeVec3 p = spore_vec3_load(result.mesh.vertices + 3 * i);
    g_assert_cmpfloat(spore_vec3_distance(p, spore_vec3(0.3, 0, 0)), <=, 0.05 * 1.02);
  }
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* The angles hold wherever the solid lies in the lattice, creases and thin walls included; and each face of a cell is
 * that of one other cell, or of the boundary, which is closed. */
static void test_voxel_angles(void) {
  for (int i = 0; i < 9; i += 4) {
    SporeTriangleMesh surface = {0};
    if (i % 3 == 0) shape_box(&surface, low, high, 2);
    else if (i % 3 == 1) shape_torus(&surface, 0.05, 0.008 + 0.001 * i, 16, 8);
    else shape_capsule(&surface, 0.02, 0.05, 4);
    const double angle = 0.37 * i, c = cos(angle), s = sin(angle);
    for (gsize v = 0; v < surface.vertex_count; v++) {
      double *x = surface.vertices + 3 * v, y = c * x[1] - s * x[2], z = s * x[1] + c * x[2];
      x[1] = y, x[2] = z, y = c * x[0] - s * x[1], x[1] = s * x[0] + c * x[1], x[0] = y;
    }
    Result result = fill(
        &surface, (SporeTetrahedraOptions){.method = SPORE_TETRAHEDRA_VOXELS, .cells = 200 + 25 * (gsize)i}, "voxels");
    g_assert_cmpfloat(result.report.quality.min_dihedral_deg, >=, 10.7);
    uint32_t *triangles;
    size_t count;
    g_assert_true(spore_tetrahedral_mesh_boundary(&result.mesh, &triangles, &count));
    SporeTriangleMesh boundary = {result.mesh.vertex_count, count, result.mesh.vertices, triangles, false};
    SporeMeshReport shape;
    g_assert_true(spore_triangle_mesh_report(&boundary, &shape, NULL));
    g_assert_cmpuint(shape.boundary_edges, ==, 0);
    g_assert_cmpuint(shape.nonmanifold_edges, ==, 0);
    g_assert_cmpfloat(fabs(shape.volume / result.report.volume - 1), <, 1e-9);
    spore_free(triangles);
    spore_tetrahedral_mesh_clear(&result.mesh);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/tetrahedra/voxels", test_voxels);
  g_test_add_func("/tetrahedra/voxel-angles", test_voxel_angles);
  return g_test_run();
}
