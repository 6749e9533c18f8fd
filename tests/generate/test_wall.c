/* Walls of shapes whose inner surface is known: as thick as asked for, closed, one lumen or none. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/surface/surface.h"
#include "core/mesh/bvh.h"
#include "core/mesh/crossings.h"
#include "tests/mesh/shapes.h"

static SporeMeshReport report_of(const SporeTriangleMesh *mesh) {
  SporeMeshReport report;
  SporeError error = SPORE_ERROR_INIT;
  g_assert_true(spore_triangle_mesh_report(mesh, &report, &error));
  return report;
}

static gboolean cuts_itself(const SporeTriangleMesh *mesh) {
  size_t count;
  g_assert_true(spore_triangle_mesh_crossings(mesh, &count, NULL));
  return count > 0;
}

/* The lumen of a box is a box; of a ball a ball. */
static void test_box_and_ball(void) {
  const double lower[3] = {-0.03, -0.04, -0.05}, upper[3] = {0.03, 0.04, 0.05};
  SporeTriangleMesh outer[2], inner, wall;
  SporeError error = SPORE_ERROR_INIT;
  SporeWallReport report;
  const double volume[2] = {0.05 * 0.07 * 0.09, 4 * G_PI / 3 * pow(0.045, 3)};
  shape_box(&outer[0], lower, upper, 2);
  shape_ball(&outer[1], 0.05, 12);
  for (int shape = 0; shape < 2; shape++) {
    if (!spore_wall_inner(&outer[shape], 0.005, 0, &inner, &report, NULL, &error)) g_error("%s", error.message);
    SporeMeshReport lumen = report_of(&inner);
    g_test_message("lumen %+.2f %%, %zu pieces, from it %.3f to %.3f mm, from outside %.3f to %.3f mm",
                   100 * (lumen.volume / volume[shape] - 1), report.pieces, 1e3 * report.inner_min,
                   1e3 * report.inner_max, 1e3 * report.thickness_min, 1e3 * report.thickness_max);
    g_test_message("off by %.2f %%, %zu triangles", 100 * report.error, inner.triangle_count);
    g_assert_cmpfloat(report.error, <, 0.05);
    g_assert_true(lumen.closed);
    g_assert_cmpuint(report.pieces, ==, 1);
    g_assert_cmpfloat(fabs(lumen.volume / volume[shape] - 1), <, 0.02);
    g_assert_cmpfloat(report.inner_min, >, 0.0048);
    g_assert_cmpfloat(report.inner_max, <, 0.0055);
    g_assert_cmpfloat(report.thickness_min, >, 0.0048);
    g_assert_true(spore_wall_solid(&outer[shape], &inner, &wall, &error));
    SporeMeshReport solid = report_of(&wall);
    g_assert_true(solid.closed);
    g_assert_cmpuint(solid.components, ==, 2);
    g_assert_cmpfloat(fabs(solid.volume - report.wall_volume), <, 1e-12);
    spore_triangle_mesh_clear(&wall);
    spore_triangle_mesh_clear(&inner);
    spore_triangle_mesh_clear(&outer[shape]);
  }
}

/* A wedge, whose lumen ends in an edge: off the thickness by .8 over the detail at most, half as far at twice the
 * detail, and told where; below 5 % where none is asked for, in few triangles. */
static void test_edge(void) {
  const double lower[3] = {-0.03, -0.02, -0.03}, upper[3] = {0.03, 0.02, 0.03};
  SporeTriangleMesh outer, inner;
  SporeError error = SPORE_ERROR_INIT;
  const double asked[3] = {SPORE_WALL_DETAIL / 2., 0, SPORE_WALL_DETAIL * 2.};
  double off[3];
  shape_box(&outer, lower, upper, 4);
  for (size_t i = 0; i < outer.vertex_count; i++)
    outer.vertices[3 * i + 1] *= 0.5 - outer.vertices[3 * i] / 0.06 + 0.02;
  SporeBvh *bvh = spore_bvh_create(&outer, &error);
  for (int k = 0; k < 3; k++) {
    SporeWallReport report;
    g_assert_true(spore_wall_inner(&outer, 0.004, asked[k], &inner, &report, NULL, &error));
    off[k] = report.error;
    g_test_message("detail %g: off by %.1f %% at %.4f %.4f %.4f, %zu triangles", asked[k], 100 * report.error,
                   report.error_at.x, report.error_at.y, report.error_at.z, inner.triangle_count);
    double there = fabs(spore_bvh_distance(bvh, report.error_at, NULL, NULL) / 0.004 - 1);
    g_assert_cmpfloat_with_epsilon(there, report.error, 1e-9);
    g_assert_cmpfloat(fmax(report.inner_max / 0.004 - 1, 1 - report.inner_min / 0.004), <=, report.error + 1e-9);
    g_assert_false(cuts_itself(&inner));
    g_assert_cmpuint(inner.triangle_count, <, 500);
    spore_triangle_mesh_clear(&inner);
  }
  for (int k = 0; k < 3; k++) g_assert_cmpfloat(off[k], <, 0.8 / (asked[k] > 0 ? asked[k] : SPORE_WALL_DETAIL));
  for (int k = 0; k < 2; k++) g_assert_cmpfloat(off[k + 1], <, 0.65 * off[k]);
  spore_bvh_free(bvh);
  spore_triangle_mesh_clear(&outer);
}

/* A ring's lumen is a ring; two balls joined by what is thinner than the walls have two. Neither cuts itself. */
static void test_ring_and_pair(void) {
  SporeTriangleMesh ring, inner, small;
  SporeError error = SPORE_ERROR_INIT;
  SporeWallReport report;
  shape_torus(&ring, 0.05, 0.015, 40, 16);
  g_assert_true(spore_wall_inner(&ring, 0.005, 6, &inner, &report, NULL, &error));
  uint32_t *edges;
  size_t count;
  g_test_message("ring: off by %.2f %%, %zu triangles", 100 * report.error, inner.triangle_count);
  g_assert_cmpfloat(report.error, <, 0.05 * SPORE_WALL_DETAIL / 6);
  g_assert_true(report_of(&inner).closed);
  g_assert_true(spore_edges_of_triangles(inner.triangles, inner.triangle_count, &edges, &count));
  g_assert_cmpint((int)inner.vertex_count - (int)count + (int)inner.triangle_count, ==, 0);
  g_assert_false(cuts_itself(&inner));
  spore_free(edges);
  spore_triangle_mesh_clear(&inner);
  spore_triangle_mesh_clear(&ring);
  shape_ball(&ring, 0.02, 10);
  shape_ball(&small, 0.02, 10);
  shape_move(&small, 0.05, 0, 0);
  shape_append(&ring, &small);
  g_assert_true(spore_wall_inner(&ring, 0.004, 2, &inner, &report, NULL, &error));
  g_assert_cmpuint(report.pieces, ==, 2);
  g_assert_true(report_of(&inner).closed);
  spore_triangle_mesh_clear(&inner);
  spore_triangle_mesh_clear(&small);
  spore_triangle_mesh_clear(&ring);
}

static bool refuse(void *data, double fraction, const char *stage) { return false; }

/* Whichever allocation fails, the wall is the same, or there is none for lack of memory. */
static void without_memory(const SporeTriangleMesh *ball) {
  SporeTriangleMesh whole, inner;
  SporeWallReport report;
  SporeError error = SPORE_ERROR_INIT;
  uint64_t before = spore_allocation_count();
  g_assert_true(spore_wall_inner(ball, 0.008, 1, &whole, &report, NULL, &error));
  uint64_t all = spore_allocation_count() - before, failed = 0;
  for (uint64_t n = 1; n <= all; n += 1 + n / 3) {
    SporeError fault = SPORE_ERROR_INIT;
    spore_allocation_fail_at(n);
    bool made = spore_wall_inner(ball, 0.008, 1, &inner, &report, NULL, &fault);
    spore_allocation_fail_at(0);
    if (made) {
      g_assert_cmpmem(inner.vertices, 3 * inner.vertex_count * sizeof(double), whole.vertices,
                      3 * whole.vertex_count * sizeof(double));
      spore_triangle_mesh_clear(&inner);
      continue;
    }
    g_assert_cmpint(fault.code, ==, SPORE_ERROR_MEMORY);
    failed++;
  }
  g_test_message("%" G_GUINT64_FORMAT " allocations; without one of them no wall %" G_GUINT64_FORMAT " times", all,
                 failed);
  g_assert_cmpuint(failed, >, 3);
  spore_triangle_mesh_clear(&whole);
}

/* Too thick, open, cancelled, no memory. */
static void test_refused(void) {
  SporeTriangleMesh ball, inner;
  SporeWallReport report;
  SporeError error = SPORE_ERROR_INIT, open = SPORE_ERROR_INIT, stopped = SPORE_ERROR_INIT;
  const SporeProgress progress = {.report = refuse};
  shape_ball(&ball, 0.02, 6);
  g_assert_false(spore_wall_inner(&ball, 0.03, 0, &inner, &report, NULL, &error));
  g_assert_nonnull(strstr(error.message, "leaves no lumen: the deepest place found lies 0.01"));
  g_assert_false(spore_wall_inner(&ball, 0.004, 0, &inner, &report, &progress, &stopped));
  g_assert_cmpint(stopped.code, ==, SPORE_ERROR_CANCELLED);
  without_memory(&ball);
  ball.triangle_count--;
  g_assert_false(spore_wall_inner(&ball, 0.004, 0, &inner, &report, NULL, &open));
  g_assert_nonnull(strstr(open.message, "not closed"));
  spore_triangle_mesh_clear(&ball);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/wall/box-and-ball", test_box_and_ball);
  g_test_add_func("/wall/edge", test_edge);
  g_test_add_func("/wall/ring-and-pair", test_ring_and_pair);
  g_test_add_func("/wall/refused", test_refused);
  return g_test_run();
}
