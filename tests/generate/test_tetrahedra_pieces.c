/* Shapes that are open or in pieces, and what falls into pieces. */
#include <math.h>
#include <string.h>

#include "cells.h"
#include "core/base/memory.h"
#include "tests/mesh/shapes.h"

static const double low[3] = {0, 0, 0}, high[3] = {0.1, 0.1, 0.1};

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
static void test_small_components(void) {
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
  g_assert_cmpfloat(result.report.small_components, >, 0.001);
  g_assert_cmpfloat(result.report.small_components, <, 0.02);
  spore_tetrahedral_mesh_clear(&result.mesh);

  shape_ball(&organ, 0.03, 8);
  shape_ball(&other, 0.006, 8);
  shape_move(&other, 0.05, 0, 0);
  shape_append(&organ, &other);
  spore_triangle_mesh_clear(&other);
  result = fill(&organ, (SporeTetrahedraOptions){.method = SPORE_TETRAHEDRA_VOXELS, .cells = 1500}, "voxels");
  g_assert_cmpuint(result.report.pieces, ==, 2);
  g_assert_cmpuint(result.report.pieces_given, ==, 2);
  g_assert_cmpfloat(result.report.small_components, ==, 0);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/tetrahedra/open-shapes", test_open_shapes);
  g_test_add_func("/tetrahedra/small components", test_small_components);
  return g_test_run();
}
