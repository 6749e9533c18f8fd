/* How large tetrahedra are, from place to place. */
#include <math.h>
#include <string.h>

#include "cells.h"
#include "core/base/memory.h"
#include "tests/mesh/shapes.h"

/* By size: edges of about that length. */
static void test_size(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 12);
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .size = 0.015}, "direct");
  uint32_t *pairs;
  size_t edges;
  double sum = 0;
  g_assert_true(spore_edges_of_tetrahedra(result.mesh.tetrahedra, result.mesh.tetrahedron_count, &pairs, &edges));
  for (gsize i = 0; i < edges; i++)
    sum += spore_vec3_distance(spore_vec3_load(result.mesh.vertices + 3 * (gsize)pairs[2 * i]),
                               spore_vec3_load(result.mesh.vertices + 3 * (gsize)pairs[2 * i + 1]));
  g_assert_cmpfloat(sum / (double)edges, >, 0.75 * 0.015);
  g_assert_cmpfloat(sum / (double)edges, <, 1.25 * 0.015);
  spore_free(pairs);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* Mean length of the edges whose middles are `inside` a place, or not. */
static double mean_edge(const SporeTetrahedralMesh *mesh, gboolean (*inside)(SporeVec3 p), gboolean wanted) {
  uint32_t *pairs;
  size_t edges, count = 0;
  double sum = 0;
  g_assert_true(spore_edges_of_tetrahedra(mesh->tetrahedra, mesh->tetrahedron_count, &pairs, &edges));
  for (gsize i = 0; i < edges; i++) {
    SporeVec3 a = spore_vec3_load(mesh->vertices + 3 * (gsize)pairs[2 * i]);
    SporeVec3 b = spore_vec3_load(mesh->vertices + 3 * (gsize)pairs[2 * i + 1]);
    if (inside(spore_vec3_scale(0.5, spore_vec3_add(a, b))) != wanted) continue;
    sum += spore_vec3_distance(a, b);
    count++;
  }
  spore_free(pairs);
  g_assert_cmpuint(count, >, 20);
  return sum / (double)count;
}

static gboolean in_region(SporeVec3 p) { return spore_vec3_distance(p, spore_vec3(0.05, 0, 0)) < 0.02; }

/* Edges of 6 mm in a ball at the pole of another one of 20 mm; with the same number of cells, those elsewhere grow. */
static void test_region(void) {
  const SporeGenerateRegion region = {{0.05, 0, 0}, 0.02, 0.006, 0};
  SporeTriangleMesh surface = {0}, same = {0};
  shape_ball(&surface, 0.05, 12);
  g_assert_true(spore_triangle_mesh_copy(&same, &surface, NULL));
  SporeTetrahedraOptions options = {CHAIN, .size = 0.02, .regions = &region, .region_count = 1};
  Result result = fill(&surface, options, "direct");
  double inside = mean_edge(&result.mesh, in_region, TRUE), outside = mean_edge(&result.mesh, in_region, FALSE);
  g_test_message("edges of %.1f mm in the region, %.1f mm elsewhere", 1e3 * inside, 1e3 * outside);
  g_assert_cmpfloat_with_epsilon(inside, 0.006, 0.25 * 0.006);
  g_assert_cmpfloat(outside, >, 1.6 * inside);
  spore_tetrahedral_mesh_clear(&result.mesh);
  options.size = 0;
  options.cells = 3000;
  result = fill(&same, options, "direct");
  check_cells(&result, 3000);
  g_assert_cmpfloat_with_epsilon(mean_edge(&result.mesh, in_region, TRUE), 0.006, 0.25 * 0.006);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

static gboolean near_tip(SporeVec3 p) { return fabs(p.x) > 0.04; }

/* A long ellipsoid bends most at its tips: with --curvature its cells are finer there, without they are as elsewhere.
 */
static void test_curvature(void) {
  double ratio[2];
  for (int i = 0; i < 2; i++) {
    SporeTriangleMesh surface = {0};
    shape_ball(&surface, 0.05, 16);
    for (gsize v = 0; v < 3 * surface.vertex_count; v++) surface.vertices[v] *= v % 3 ? 0.4 : 1;
    SporeTetrahedraOptions options = {CHAIN, .cells = 1500, .tolerance = 0.1, .curvature = i ? 30 : 0};
    Result result = fill(&surface, options, "direct");
    check_cells(&result, 1500);
    ratio[i] = mean_edge(&result.mesh, near_tip, TRUE) / mean_edge(&result.mesh, near_tip, FALSE);
    spore_tetrahedral_mesh_clear(&result.mesh);
  }
  g_test_message("edges at the tips: %.2f of those elsewhere, %.2f with curvature", ratio[0], ratio[1]);
  g_assert_cmpfloat(ratio[0], >, 0.8);
  g_assert_cmpfloat(ratio[1], <, 0.8 * ratio[0]);
}

/* Of many triangles a lattice is made at once, and that is said. */
static void test_many(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 131);
  g_assert_cmpuint(surface.triangle_count, >, 200000);
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 300}, "voxels");
  check_cells(&result, 300);
  g_assert_cmpfloat(result.report.hausdorff, <, 0.02);
  if (SPORE_HAVE_CGAL)
    for (int method = 0; method < SPORE_TETRAHEDRA_VOXELS; method++)
      g_assert_nonnull(strstr(result.report.refused[method], "expected at most 200000"));
  spore_tetrahedral_mesh_clear(&result.mesh);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  if (!SPORE_HAVE_CGAL) return g_test_run(); /* the mesher follows sizes */
  g_test_add_func("/tetrahedra/size", test_size);
  g_test_add_func("/tetrahedra/region", test_region);
  g_test_add_func("/tetrahedra/curvature", test_curvature);
  g_test_add_func("/tetrahedra/many", test_many);
  return g_test_run();
}
