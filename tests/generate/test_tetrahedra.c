/* Tetrahedra in sound surfaces: the number of cells, their quality, volume; progress, cancelling. */
#include <math.h>
#include <string.h>

#include "cells.h"
#include "core/base/memory.h"
#include "core/base/profile.h"
#include "tests/mesh/shapes.h"

static const double low[3] = {0, 0, 0}, high[3] = {0.1, 0.1, 0.1};

static void test_ball(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 12);
  shape_move(&surface, 1, -2, 3); /* far from the origin */
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 1000}, "direct");
  check_cells(&result, 1000);
  g_assert_cmpfloat(result.report.hausdorff, <, 0.02);
  g_assert_cmpfloat(fabs(result.report.volume_change), <, 0.05);
  for (gsize i = 0; i < result.mesh.vertex_count; i++) {
    SporeVec3 p = spore_vec3_load(result.mesh.vertices + 3 * i);
    g_assert_cmpfloat(spore_vec3_distance(p, spore_vec3(1, -2, 3)), <=, 0.05 * 1.02);
  }
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* The same in millimetres: the mesh is the same, a thousand times as large. */
static void test_scale(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 50, 12);
  Result large = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 500}, "direct");
  check_cells(&large, 500);
  spore_tetrahedral_mesh_clear(&large.mesh);
}

static void test_cube(void) {
  SporeTriangleMesh surface = {0};
  shape_box(&surface, low, high, 4);
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 1000, .tolerance = 0.06}, "direct");
  check_cells(&result, 1000);
  g_assert_cmpfloat(result.report.hausdorff, <, 0.06); /* corners are cut */
  spore_tetrahedral_mesh_clear(&result.mesh);
}

static void test_torus(void) {
  SporeTriangleMesh surface = {0};
  shape_torus(&surface, 0.05, 0.02, 24, 12);
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 800}, "direct");
  check_cells(&result, 800);
  g_assert_cmpfloat(fabs(result.report.volume_change), <, 0.12);
  uint32_t *triangles;
  size_t count, edges;
  uint32_t *pairs;
  g_assert_true(spore_tetrahedral_mesh_boundary(&result.mesh, &triangles, &count));
  g_assert_true(spore_edges_of_triangles(triangles, count, &pairs, &edges));
  gsize outer = 0;
  char *seen = g_malloc0(result.mesh.vertex_count);
  for (gsize i = 0; i < 3 * count; i++) outer += !seen[triangles[i]], seen[triangles[i]] = 1;
  g_assert_cmpint((int)outer - (int)edges + (int)count, ==, 0); /* the hole is still there */
  g_free(seen);
  spore_free(pairs);
  spore_free(triangles);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* A cavity stays one. */
static void test_cavity(void) {
  SporeTriangleMesh surface = {0}, cavity = {0};
  shape_ball(&surface, 0.05, 8);
  shape_ball(&cavity, 0.03, 8);
  shape_turn(&cavity);
  shape_append(&surface, &cavity);
  spore_triangle_mesh_clear(&cavity);
  Result result = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 1200}, "direct");
  g_assert_cmpfloat(fabs(result.report.volume_change), <, 0.1);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

static void test_repeatable(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 8);
  const double scale[3] = {1, 0.7, 0.4};
  for (gsize i = 0; i < 3 * surface.vertex_count; i++) surface.vertices[i] *= scale[i % 3];
  SporeTriangleMesh same = {0};
  g_assert_true(spore_triangle_mesh_copy(&same, &surface, NULL));
  Result a = fill(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 300, .tolerance = 0.03}, "direct");
  Result b = fill(&same, (SporeTetrahedraOptions){CHAIN, .cells = 300, .tolerance = 0.03}, "direct");
  g_assert_cmpmem(a.mesh.vertices, a.mesh.vertex_count * 24, b.mesh.vertices, b.mesh.vertex_count * 24);
  g_assert_cmpmem(a.mesh.tetrahedra, a.mesh.tetrahedron_count * 16, b.mesh.tetrahedra, b.mesh.tetrahedron_count * 16);
  g_assert_cmpfloat(a.report.hausdorff, ==, b.report.hausdorff);
  spore_tetrahedral_mesh_clear(&a.mesh);
  spore_tetrahedral_mesh_clear(&b.mesh);
}

typedef struct {
  guint calls, cancel_at;
  double last;
  gboolean falls;
  guint64 cancelled_ns;
} Watch;

static bool watch(void *data, double fraction, const char *stage) {
  Watch *seen = data;
  if (fraction > 1 || !(fraction >= 0)) seen->falls = TRUE;
  seen->last = fraction;
  if (++seen->calls < seen->cancel_at || !seen->cancel_at) return true;
  if (!seen->cancelled_ns) seen->cancelled_ns = spore_clock_ns();
  return false;
}

/* Cells for minutes of work; the wish to cancel must not wait for them. */
static void test_cancel(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 12);
  Watch seen = {.cancel_at = 10};
  SporeProgress progress = {watch, &seen};
  SporeTetrahedraOptions options = {CHAIN, .cells = 2000000};
  SporeTetrahedralMesh mesh;
  GError *error = NULL;
  g_assert_false(spore_tetrahedra_from_mesh("organ", &surface, &options, &mesh, NULL, &progress, &error));
  g_assert_cmpuint(spore_clock_ns() - seen.cancelled_ns, <, (guint64)5 * 1000000000);
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_CANCELLED);
  g_assert_cmpuint(seen.calls, ==, 10);
  g_error_free(error);
  spore_triangle_mesh_clear(&surface);
}

static void test_progress(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 8);
  Watch seen = {0};
  SporeProgress progress = {watch, &seen};
  SporeTetrahedraOptions options = {CHAIN, .cells = 300};
  SporeTetrahedralMesh mesh;
  GError *error = NULL;
  g_assert_true(spore_tetrahedra_from_mesh("organ", &surface, &options, &mesh, NULL, &progress, &error));
  g_assert_no_error(error);
  g_assert_false(seen.falls);
  g_assert_cmpfloat(seen.last, >, 0.9);
  spore_tetrahedral_mesh_clear(&mesh);
  spore_triangle_mesh_clear(&surface);
}

/* Cancelled while the result is measured, after the helper has ended. */
static bool stop_measuring(void *data, double fraction, const char *stage) { return fraction < 0.95; }

static void test_cancel_late(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 8);
  SporeProgress progress = {stop_measuring, NULL};
  SporeTetrahedraOptions options = {CHAIN, .cells = 300};
  SporeTetrahedralMesh mesh;
  GError *error = NULL;
  g_assert_false(spore_tetrahedra_from_mesh("organ", &surface, &options, &mesh, NULL, &progress, &error));
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_CANCELLED);
  g_assert_null(mesh.vertices);
  g_error_free(error);
  spore_triangle_mesh_clear(&surface);
}

static void test_refused(void) {
  SporeTriangleMesh surface = {0};
  shape_ball(&surface, 0.05, 4);
  check_refused(&surface, (SporeTetrahedraOptions){CHAIN}, SPORE_ERROR_INPUT, "or a number of cells");
  check_refused(&surface, (SporeTetrahedraOptions){CHAIN, .size = -1}, SPORE_ERROR_INPUT, "expected a length above 0");
  check_refused(&surface, (SporeTetrahedraOptions){CHAIN, .size = NAN}, SPORE_ERROR_INPUT, "expected a length above 0");
  check_refused(&surface, (SporeTetrahedraOptions){CHAIN, .size = 1e-6}, SPORE_ERROR_INPUT, "expected at most 5000000");
  check_refused(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 1000000000}, SPORE_ERROR_INPUT,
                "expected at most 5000000");
  surface.vertices[4] = NAN;
  check_refused(&surface, (SporeTetrahedraOptions){CHAIN, .cells = 100}, SPORE_ERROR_INPUT, "vertex 1");
  spore_triangle_mesh_clear(&surface);
}

static void add_tests(void) {
  g_test_add_func("/tetrahedra/ball", test_ball);
  g_test_add_func("/tetrahedra/scale", test_scale);
  g_test_add_func("/tetrahedra/cube", test_cube);
  g_test_add_func("/tetrahedra/torus", test_torus);
  g_test_add_func("/tetrahedra/cavity", test_cavity);
  g_test_add_func("/tetrahedra/repeatable", test_repeatable);
  g_test_add_func("/tetrahedra/cancel", test_cancel);
  g_test_add_func("/tetrahedra/cancel-late", test_cancel_late);
  g_test_add_func("/tetrahedra/progress", test_progress);
}

/* Where pieces lie in one another, the chain does not try what cannot make one solid of them. */
static void test_mixed(void) {
  SporeTriangleMesh organ = {0}, vessel = {0};
  shape_ball(&organ, 0.03, 8);
  shape_capsule(&vessel, 0.008, 0.03, 6);
  shape_move(&vessel, 0, 0, 0.04);
  shape_append(&organ, &vessel);
  spore_triangle_mesh_clear(&vessel);
  SporeTetrahedraOptions options = {CHAIN, .cells = 500, .tolerance = 0.06};
  Result result = fill(&organ, options, "wrapped");
  const char *refused = result.report.refused[SPORE_TETRAHEDRA_REPAIRED];
  g_assert_nonnull(strstr(refused, SPORE_HAVE_CGAL ? "lie in one another" : "CGAL"));
  check_cells(&result, 500);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  if (SPORE_HAVE_CGAL) add_tests();
  g_test_add_func("/tetrahedra/refused", test_refused);
  g_test_add_func("/tetrahedra/mixed", test_mixed);
  return g_test_run();
}
