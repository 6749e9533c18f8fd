/* Walls, fins and slits that are thinner than cells. */
#include <math.h>

#include "cells.h"
#include "tests/mesh/shapes.h"

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

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/tetrahedra/thin-wall", test_thin_wall);
  g_test_add_func("/tetrahedra/thin-parts", test_thin_parts);
  return g_test_run();
}
