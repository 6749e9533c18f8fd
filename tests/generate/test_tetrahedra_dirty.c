/* Tetrahedra in dirty surfaces: the method that must be used, and what is said of those before it. */
#include <math.h>
#include <string.h>

#include "cells.h"
#include "core/base/memory.h"
#include "tests/mesh/shapes.h"

static const double low[3] = {0, 0, 0}, high[3] = {0.1, 0.1, 0.1};

/* A surface turned inside out bounds the same solid. */
static void test_inside_out(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 8);
  shape_turn(&surface);
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 500}, "direct");
  check_cells(&result, 500);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* Two cubes that overlap by a half: one solid of one and a half. */
static void test_overlapping_cubes(void) {
  const double shifted_low[3] = {0.05, 0.013, 0.017}, shifted_high[3] = {0.15, 0.113, 0.117};
  SporeTriangleMesh surface = {0}, other = {0};
  shape_box(&surface, low, high, 3);
  shape_box(&other, shifted_low, shifted_high, 3);
  shape_append(&surface, &other);
  spore_triangle_mesh_clear(&other);
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 600, .tolerance = 0.06}, "wrapped");
  check_cells(&result, 600);
  const double both = 2e-3 - 0.05 * 0.087 * 0.083;
  g_assert_cmpfloat(fabs(result.report.quality.volume / both - 1), <, 0.1);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* A box without one triangle is closed again. */
static void test_hole(void) {
  SporeTriangleMesh surface = {0};
  shape_box(&surface, low, high, 4);
  surface.triangle_count--;
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 500, .tolerance = 0.1}, "repaired");
  check_cells(&result, 500);
  g_assert_cmpfloat(fabs(result.report.quality.volume / 1e-3 - 1), <, 0.1);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* No two triangles share a vertex, and some are turned over: as STL from a bad exporter. */
static void test_soup(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 8);
  shape_unweld(&surface);
  for (gsize i = 0; i < surface.triangle_count; i += 5) {
    uint32_t *corner = surface.triangles + 3 * i, kept = corner[1];
    corner[1] = corner[2], corner[2] = kept;
  }
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 500}, "direct");
  check_cells(&result, 500);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* Which methods were refused before, and one that is asked for and cannot: no other is taken. */
static void test_method(void) {
  SporeTriangleMesh surface = {0};
  shape_box(&surface, low, high, 4);
  surface.triangle_count--;
  check_refused(&surface, (SporeTetrahedraOptions){.method = SPORE_TETRAHEDRA_DIRECT, .cells = 500},
                SPORE_ERROR_NUMERICAL, SPORE_HAVE_CGAL ? "direct: the surface is not closed" : "without CGAL");
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 500, .tolerance = 0.1}, "repaired");
  g_assert_nonnull(strstr(result.report.refused[SPORE_TETRAHEDRA_DIRECT], SPORE_HAVE_CGAL ? "not closed" : "CGAL"));
  g_assert_cmpstr(result.report.refused[SPORE_TETRAHEDRA_WRAPPED], ==,
                  SPORE_HAVE_CGAL ? "" : result.report.refused[SPORE_TETRAHEDRA_DIRECT]);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  if (SPORE_HAVE_CGAL) {
    g_test_add_func("/tetrahedra/inside-out", test_inside_out);
    g_test_add_func("/tetrahedra/overlapping-cubes", test_overlapping_cubes);
    g_test_add_func("/tetrahedra/hole", test_hole);
    g_test_add_func("/tetrahedra/soup", test_soup);
  }
  g_test_add_func("/tetrahedra/method", test_method);
  return g_test_run();
}
