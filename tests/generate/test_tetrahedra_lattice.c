/* The lattice of tetrahedra, alone and where the chain comes down to it; shapes that are open, thin or hollow. */
#include <math.h>
#include <string.h>

#include "cells.h"
#include "core/base/memory.h"
#include "tests/mesh/shapes.h"

static const double low[3] = {0, 0, 0}, high[3] = {0.1, 0.1, 0.1};

/* A hollow ring whose wall is thinner than its cells would be: the mesher's cells are far from it, the coarsened
 * lattice's are nearer, and that is said. */
static void test_thin_wall(void) {
  SporeTriangleMesh surface = {0}, lumen = {0};
  shape_torus(&surface, 0.02, 0.012, 24, 14);
  shape_torus(&lumen, 0.02, 0.008, 24, 14);
  shape_turn(&lumen);
  shape_append(&surface, &lumen);
  spore_triangle_mesh_clear(&lumen);
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 1200}, "voxels");
  check_cells(&result, 1200);
  g_assert_cmpfloat(result.report.hausdorff, <, 0.01);
  g_assert_cmpfloat(fabs(result.report.volume_change), <, 0.1);
  if (SPORE_HAVE_CGAL) g_assert_true(*result.report.refused[SPORE_TETRAHEDRA_DIRECT]);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* A fin and a slit that lie between the nodes of the lattice: it has both, in one piece, and says what they are made.
 */
static void test_thin_parts(void) {
  const SporeTetrahedraOptions options = {.method = SPORE_TETRAHEDRA_VOXELS, .cells = 400, .tolerance = 0.05};
  SporeTriangleMesh fin = {0}, slit = {0}, box = {0};
  shape_ball(&fin, 0.03, 8);
  shape_box(&box, (double[3]){0.02, -0.011, 0.0003}, (double[3]){0.09, 0.012, 0.0008}, 6);
  shape_append(&fin, &box);
  spore_triangle_mesh_clear(&box);
  Result result = fill(&fin, options, "voxels");
  g_assert_cmpfloat(result.report.thickened, >, 0.1);
  g_assert_cmpfloat(result.report.thickness, >, 0.0005);
  g_assert_cmpfloat(result.report.inner_share, >, 0.001); /* what of each part lies in the other */
  g_assert_cmpfloat(result.report.hausdorff, <, 0.05);
  g_assert_cmpuint(result.report.pieces, ==, 1);
  spore_tetrahedral_mesh_clear(&result.mesh);

  shape_ball(&slit, 0.05, 8);
  shape_box(&box, (double[3]){-0.01, -0.06, 0.0003}, (double[3]){0.06, 0.06, 0.0008}, 6);
  shape_turn(&box);
  shape_append(&slit, &box);
  spore_triangle_mesh_clear(&box);
  result = fill(&slit, options, "voxels");
  g_assert_cmpfloat(result.report.widened, >, 0.1);
  g_assert_cmpfloat(result.report.hausdorff, <, 0.05);
  g_assert_cmpuint(result.report.pieces, ==, 1);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

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

/* A hollow ball: filled, it has the volume of a whole one; else of the shell. By each method that may do it. */
static void test_fill(void) {
  for (int i = 0; i < 4; i++) {
    const SporeTetrahedraMethod method = i < 2 ? SPORE_TETRAHEDRA_VOXELS : SPORE_TETRAHEDRA_METHODS;
    SporeTriangleMesh surface = {0}, cavity = {0};
    shape_ball(&surface, 0.05, 6);
    shape_ball(&cavity, 0.025, 6);
    shape_turn(&cavity);
    shape_append(&surface, &cavity);
    spore_triangle_mesh_clear(&cavity);
    Result result = fill(&surface, (SporeTetrahedraOptions){.method = method, .cells = 400, .fill = i % 2},
                         i < 2 ? "voxels" : "direct");
    const double whole = 1.0 / (1 - 0.125); /* of the shell's volume */
    g_assert_cmpfloat_with_epsilon(result.report.volume_change, i % 2 ? whole - 1 : 0, 0.06);
    g_assert_cmpfloat(result.report.hausdorff, <, 0.02); /* a cavity that is filled does not count */
    spore_tetrahedral_mesh_clear(&result.mesh);
  }
}

/* A sheet of no thickness, an open cup, one triangle, two parts: each is made by a method, or refused in words. */
static void test_open_shapes(void) {
  SporeTriangleMesh plate = {0}, cup = {0}, parts = {0}, other = {0};
  shape_box(&plate, low, high, 4);
  gsize kept = 0; /* of a box, the triangles of the side z = 0 */
  for (gsize t = 0; t < plate.triangle_count; t++) {
    const uint32_t *c = plate.triangles + 3 * t;
    if (plate.vertices[3 * c[0] + 2] + plate.vertices[3 * c[1] + 2] + plate.vertices[3 * c[2] + 2] > 0) continue;
    memmove(plate.triangles + 3 * kept++, c, 12);
  }
  plate.triangle_count = kept;
  check_refused(&plate, (SporeTetrahedraOptions){CHAIN, .cells = 200}, SPORE_ERROR_INPUT, "encloses nothing");
  plate.triangle_count = 1;
  check_refused(&plate, (SporeTetrahedraOptions){CHAIN, .cells = 200}, SPORE_ERROR_INPUT, "encloses nothing");
  spore_triangle_mesh_clear(&plate);

  shape_ball(&cup, 0.05, 6);
  kept = 0;
  for (gsize t = 0; t < cup.triangle_count; t++)
    if (cup.vertices[3 * cup.triangles[3 * t] + 2] <= 0.01)
      memmove(cup.triangles + 3 * kept++, cup.triangles + 3 * t, 12);
  cup.triangle_count = kept;
  Result result = fill(&cup, (SporeTetrahedraOptions){CHAIN, .cells = 300, .tolerance = 0.1}, "repaired");
  g_assert_cmpfloat(result.report.volume, >, 2e-4);
  g_assert_cmpfloat(result.report.volume, <, 4.5e-4);
  spore_tetrahedral_mesh_clear(&result.mesh);

  shape_ball(&parts, 0.03, 6);
  shape_ball(&other, 0.03, 6);
  shape_move(&other, 0.1, 0, 0);
  shape_append(&parts, &other);
  spore_triangle_mesh_clear(&other);
  result = fill(&parts, (SporeTetrahedraOptions){CHAIN, .cells = 400}, "direct");
  g_assert_cmpfloat(fabs(result.report.volume_change), <, 0.08);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* A ball with a small one beside it at a neck that no cell is as thin as: what breaks off goes, and is said. One by
 * itself stays. */
static void test_crumbs(void) {
  SporeTriangleMesh organ = {0}, other = {0};
  shape_ball(&organ, 0.03, 24);
  for (gsize i = 0; i < organ.vertex_count; i++) {
    double *p = organ.vertices + 3 * i, z = p[2] / 0.03, wide = z > 0 ? 1 : z > -0.7 ? 0.01 : 0.4;
    p[0] *= wide, p[1] *= wide, p[2] *= 2;
  }
  Result result = fill(&organ, (SporeTetrahedraOptions){.method = SPORE_TETRAHEDRA_VOXELS, .cells = 600}, "voxels");
  uint32_t *pieces;
  size_t count;
  g_assert_true(spore_tetrahedral_mesh_pieces(&result.mesh, &pieces, &count, NULL));
  spore_free(pieces);
  g_assert_cmpuint(count, ==, 1);
  g_assert_cmpuint(result.report.pieces, ==, 1);
  g_assert_cmpuint(result.report.pieces_given, ==, 1);
  g_assert_cmpfloat(result.report.crumbs, >, 0.001);
  g_assert_cmpfloat(result.report.crumbs, <, 0.02);
  spore_tetrahedral_mesh_clear(&result.mesh);

  shape_ball(&organ, 0.03, 8);
  shape_ball(&other, 0.006, 8);
  shape_move(&other, 0.05, 0, 0);
  shape_append(&organ, &other);
  spore_triangle_mesh_clear(&other);
  result = fill(&organ, (SporeTetrahedraOptions){.method = SPORE_TETRAHEDRA_VOXELS, .cells = 1500}, "voxels");
  g_assert_cmpuint(result.report.pieces, ==, 2);
  g_assert_cmpuint(result.report.pieces_given, ==, 2);
  g_assert_cmpfloat(result.report.crumbs, ==, 0);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/tetrahedra/thin-wall", test_thin_wall);
  g_test_add_func("/tetrahedra/thin-parts", test_thin_parts);
  g_test_add_func("/tetrahedra/voxels", test_voxels);
  g_test_add_func("/tetrahedra/voxel-angles", test_voxel_angles);
  g_test_add_func("/tetrahedra/fill", test_fill);
  g_test_add_func("/tetrahedra/open-shapes", test_open_shapes);
  g_test_add_func("/tetrahedra/crumbs", test_crumbs);
  return g_test_run();
}
