/* Simplified surfaces: as many vertices as asked for, near the surface, the same pieces, holes, handles, creases and
 * outlines, and triangles that a net can be made of. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/mesh/bvh.h"
#include "core/mesh/crossings.h"
#include "core/mesh/simplify.h"
#include "tests/mesh/shapes.h"

static const double cube[2][3] = {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}};

static SporeTriangleMesh simplify(const SporeTriangleMesh *mesh, size_t vertices, SporeSimplifyReport *report) {
  SporeTriangleMesh result;
  SporeError error = SPORE_ERROR_INIT;
  const SporeSimplifyOptions options = {.vertices = vertices};
  if (!spore_triangle_mesh_simplify(mesh, &options, &result, report, NULL, &error)) g_error("%s", error.message);
  g_assert_true(spore_triangle_mesh_validate(&result, &error));
  return result;
}

static SporeMeshReport report_of(const SporeTriangleMesh *mesh) {
  SporeMeshReport report;
  SporeError error = SPORE_ERROR_INIT;
  g_assert_true(spore_triangle_mesh_report(mesh, &report, &error));
  return report;
}

/* Vertices - edges + triangles: 2 for each ball, 0 for a ring. */
static int euler(const SporeTriangleMesh *mesh) {
  uint32_t *edges;
  size_t count;
  g_assert_true(spore_edges_of_triangles(mesh->triangles, mesh->triangle_count, &edges, &count));
  spore_free(edges);
  return (int)mesh->vertex_count - (int)count + (int)mesh->triangle_count;
}

/* Largest distance of the vertices, and of the middles of triangles, of one from the other. */
static double distance(const SporeTriangleMesh *from, const SporeTriangleMesh *to) {
  SporeError error = SPORE_ERROR_INIT;
  SporeBvh *bvh = spore_bvh_create(to, &error);
  double farthest = 0;
  for (size_t i = 0; i < from->vertex_count; i++)
    farthest = fmax(farthest, spore_bvh_distance(bvh, spore_vec3_load(from->vertices + 3 * i), NULL, NULL));
  for (size_t t = 0; t < from->triangle_count; t++) {
    SporeVec3 sum = {0, 0, 0};
    for (size_t k = 0; k < 3; k++)
      sum = spore_vec3_add(sum, spore_vec3_load(from->vertices + 3 * (size_t)from->triangles[3 * t + k]));
    farthest = fmax(farthest, spore_bvh_distance(bvh, spore_vec3_scale(1.0 / 3, sum), NULL, NULL));
  }
  spore_bvh_free(bvh);
  return farthest;
}

static void test_ball(void) {
  SporeTriangleMesh ball;
  SporeSimplifyReport report;
  double least, mean;
  shape_ball(&ball, 0.05, 20);
  SporeTriangleMesh few = simplify(&ball, 200, &report);
  SporeMeshReport now = report_of(&few);
  spore_triangle_mesh_angles(&few, &least, &mean);
  double off = fmax(distance(&few, &ball), distance(&ball, &few)), volume = 4 * G_PI / 3 * 0.05 * 0.05 * 0.05;
  g_test_message("%zu of %zu vertices: off by %.2f %% of the radius, volume %+.2f %%, least angle %.1f, mean %.1f",
                 few.vertex_count, ball.vertex_count, off / 0.05 * 100, 100 * (now.volume / volume - 1), least, mean);
  g_assert_cmpuint(few.vertex_count, ==, 200);
  g_assert_true(report.reached && report.creases == 0 && now.closed);
  g_assert_cmpint(euler(&few), ==, 2);
  g_assert_cmpfloat(off, <, 0.012 * 0.05); /* 200 points inscribed in a ball are off by 0.9 % of the diagonal */
  g_assert_cmpfloat(fabs(now.volume / volume - 1), <, 0.01);
  g_assert_cmpfloat(least, >, 20);
  g_assert_cmpfloat(mean, >, 40);
  spore_triangle_mesh_clear(&few);
  spore_triangle_mesh_clear(&ball);
}

/* Plane faces, straight creases and corners: nothing is lost. */
static void test_box(void) {
  SporeTriangleMesh box;
  SporeSimplifyReport report;
  shape_box(&box, cube[0], cube[1], 12);
  SporeTriangleMesh few = simplify(&box, 60, &report);
  SporeMeshReport now = report_of(&few);
  g_test_message("off by %.2e and %.2e, volume %.17g", distance(&few, &box), distance(&box, &few), now.volume);
  g_assert_cmpuint(report.creases, ==, 12 * 12);
  g_assert_true(report.creases_kept && report.reached && now.closed);
  g_assert_cmpuint(few.vertex_count, <=, 60);
  g_assert_cmpfloat(distance(&few, &box), <, 1e-9);
  g_assert_cmpfloat(distance(&box, &few), <, 1e-9);
  g_assert_cmpfloat(fabs(now.volume - 1), <, 1e-9);
  spore_triangle_mesh_clear(&few);
  few = simplify(&box, 6, &report); /* fewer than its corners */
  g_assert_false(report.creases_kept);
  g_assert_true(report.reached && report_of(&few).closed);
  spore_triangle_mesh_clear(&few);
  spore_triangle_mesh_clear(&box);
}

static void test_ring(void) {
  SporeTriangleMesh ring;
  SporeSimplifyReport report;
  shape_torus(&ring, 0.05, 0.01, 80, 24);
  for (size_t vertices = 300; vertices > 1; vertices /= 7) {
    SporeTriangleMesh few = simplify(&ring, vertices, &report);
    g_test_message("%zu vertices asked for: %zu", vertices, few.vertex_count);
    g_assert_true(report_of(&few).closed);
    g_assert_cmpint(euler(&few), ==, 0);
    g_assert_cmpint(report.reached, ==, few.vertex_count <= MAX(vertices, 4));
    if (vertices == 300) g_assert_cmpfloat(distance(&ring, &few), <, 0.001);
    spore_triangle_mesh_clear(&few);
  }
  spore_triangle_mesh_clear(&ring);
}

/* A plate of a fiftieth of its width, and a ball away from it: both stay. */
static void test_thin(void) {
  SporeTriangleMesh plate, ball;
  SporeSimplifyReport report;
  const double lower[3] = {0, 0, 0}, upper[3] = {0.1, 0.1, 0.002};
  shape_box(&plate, lower, upper, 20);
  shape_ball(&ball, 0.01, 6);
  shape_move(&ball, 0.2, 0, 0);
  shape_append(&plate, &ball);
  SporeTriangleMesh few = simplify(&plate, 100, &report);
  SporeMeshReport now = report_of(&few), was = report_of(&plate);
  g_test_message("volume %+.2f %%", 100 * (now.volume / was.volume - 1));
  g_assert_cmpuint(now.components, ==, 2);
  g_assert_true(now.closed);
  g_assert_cmpint(euler(&few), ==, 4);
  g_assert_cmpfloat(fabs(now.volume / was.volume - 1), <, 0.02);
  g_assert_cmpfloat(distance(&plate, &few), <, 0.002);
  spore_triangle_mesh_clear(&few);
  spore_triangle_mesh_clear(&plate);
  spore_triangle_mesh_clear(&ball);
}

/* An open sheet, bent as a gutter: its outline stays, corners where they were. */
static void test_sheet(void) {
  enum { N = 24 };
  SporeTriangleMesh sheet;
  SporeError error = SPORE_ERROR_INIT;
  SporeSimplifyReport report;
  g_assert_true(spore_triangle_mesh_allocate(&sheet, (N + 1) * (N + 1), 2 * N * N, &error));
  for (size_t i = 0; i < sheet.vertex_count; i++) {
    double x = (double)(i % (N + 1)) / N, y = (double)(i / (N + 1)) / N;
    spore_vec3_store(sheet.vertices + 3 * i, spore_vec3(x, y, 0.2 * x * x));
  }
  for (uint32_t c = 0; c < N * N; c++) {
    uint32_t a = c / N * (N + 1) + c % N, *t = sheet.triangles + 6 * (size_t)c;
    memcpy(t, (const uint32_t[6]){a, a + 1, a + N + 2, a, a + N + 2, a + N + 1}, 6 * sizeof *t);
  }
  SporeTriangleMesh few = simplify(&sheet, 60, &report);
  SporeMeshReport now = report_of(&few);
  g_test_message("%zu vertices, %zu open edges, off by %.2e", few.vertex_count, now.boundary_edges,
                 distance(&sheet, &few));
  g_assert_cmpint(euler(&few), ==, 1);
  g_assert_cmpuint(few.vertex_count, ==, 60);
  g_assert_cmpfloat(distance(&sheet, &few), <, 0.005);
  for (size_t corner = 0; corner < 4; corner++) {
    SporeVec3 at = {corner % 2, corner / 2, corner % 2 ? 0.2 : 0};
    double nearest = HUGE_VAL;
    for (size_t i = 0; i < few.vertex_count; i++)
      nearest = fmin(nearest, spore_vec3_distance(at, spore_vec3_load(few.vertices + 3 * i)));
    g_assert_cmpfloat(nearest, <, 1e-12);
  }
  spore_triangle_mesh_clear(&few);
  spore_triangle_mesh_clear(&sheet);
}

/* By size; twice the same; the same a million metres away, as far as its digits go. */
static void test_size(void) {
  SporeTriangleMesh ball, one, other, away;
  SporeSimplifyReport report;
  SporeError error = SPORE_ERROR_INIT;
  const SporeSimplifyOptions options = {.size = 0.01};
  shape_ball(&ball, 0.05, 16);
  g_assert_true(spore_triangle_mesh_simplify(&ball, &options, &one, &report, NULL, &error));
  g_assert_true(spore_triangle_mesh_simplify(&ball, &options, &other, &report, NULL, &error));
  g_assert_cmpmem(one.vertices, 24 * one.vertex_count, other.vertices, 24 * other.vertex_count);
  g_assert_cmpmem(one.triangles, 12 * one.triangle_count, other.triangles, 12 * other.triangle_count);
  uint32_t *edges;
  size_t count;
  double mean = 0;
  g_assert_true(spore_edges_of_triangles(one.triangles, one.triangle_count, &edges, &count));
  for (size_t e = 0; e < count; e++)
    mean += spore_vec3_distance(spore_vec3_load(one.vertices + 3 * (size_t)edges[2 * e]),
                                spore_vec3_load(one.vertices + 3 * (size_t)edges[2 * e + 1])) /
            (double)count;
  g_test_message("edges of %.4f m on average", mean);
  g_assert_cmpfloat(fabs(mean / 0.01 - 1), <, 0.1);
  shape_move(&ball, 1e6, 0, 0);
  g_assert_true(spore_triangle_mesh_simplify(&ball, &options, &away, &report, NULL, &error));
  g_assert_cmpuint(away.vertex_count, ==, one.vertex_count);
  g_assert_true(report_of(&away).closed);
  spore_free(edges);
  spore_triangle_mesh_clear(&away);
  spore_triangle_mesh_clear(&one);
  spore_triangle_mesh_clear(&other);
  spore_triangle_mesh_clear(&ball);
}

static bool refuse(void *data, double fraction, const char *stage) { return ++*(int *)data < 2; }

/* Pairs of triangles without a common corner, the slow way. */
static size_t crossings_of(const SporeTriangleMesh *mesh) {
  size_t count = 0;
  for (size_t s = 0; s < mesh->triangle_count; s++)
    for (size_t t = s + 1; t < mesh->triangle_count; t++) {
      const uint32_t *n = mesh->triangles + 3 * s, *m = mesh->triangles + 3 * t;
      SporeVec3 p[3], q[3];
      gboolean joined = FALSE, crossing = FALSE;
      for (int k = 0; k < 3; k++) {
        p[k] = spore_vec3_load(mesh->vertices + 3 * (size_t)n[k]);
        q[k] = spore_vec3_load(mesh->vertices + 3 * (size_t)m[k]);
        for (int l = 0; l < 3; l++) joined |= n[k] == m[l];
      }
      for (int k = 0; k < 3 && !joined; k++)
        crossing |= spore_vec3_crosses(p[k], p[(k + 1) % 3], q[0], q[1], q[2]) ||
                    spore_vec3_crosses(q[k], q[(k + 1) % 3], p[0], p[1], p[2]);
      count += crossing;
    }
  return count;
}

/* Two balls one in the other, so near that with so few vertices their faces go through each other unless that is seen
 * to; and two that overlap, which stay so. */
static void test_crossings(void) {
  SporeTriangleMesh balls, other, result;
  SporeSimplifyReport report;
  const double radius[2] = {0.048, 0.05}, shift[2] = {0, 0.06};
  for (int overlap = 0; overlap < 2; overlap++) {
    shape_ball(&balls, 0.05, 16);
    shape_ball(&other, radius[overlap], 16);
    shape_move(&other, shift[overlap], 0.001, 0.0007);
    shape_append(&balls, &other);
    size_t count;
    g_autofree bool *crossing = g_new(bool, balls.triangle_count);
    g_assert_true(spore_triangle_mesh_crossings(&balls, &count, crossing));
    g_assert_cmpuint(count, ==, crossings_of(&balls));
    g_assert_cmpint(count > 0, ==, overlap);
    size_t marked = 0;
    for (size_t t = 0; t < balls.triangle_count; t++) marked += crossing[t];
    g_assert_cmpuint(marked, <=, 2 * count);
    g_assert_cmpint(marked > 1, ==, overlap);
    const SporeSimplifyOptions options = {.vertices = 120};
    g_assert_true(spore_triangle_mesh_simplify(&balls, &options, &result, &report, NULL, NULL));
    g_test_message("%zu vertices: %zu crossings, before %zu", result.vertex_count, report.crossings,
                   report.crossings_before);
    g_assert_cmpuint(report.crossings_before, ==, count);
    g_assert_cmpuint(report.crossings, ==, crossings_of(&result));
    g_assert_cmpuint(report.crossings, <=, report.crossings_before);
    spore_triangle_mesh_clear(&result);
    spore_triangle_mesh_clear(&balls);
    spore_triangle_mesh_clear(&other);
  }
}

static void test_without_memory(void) {
  SporeTriangleMesh box, few;
  SporeSimplifyReport report;
  const SporeSimplifyOptions options = {.vertices = 10};
  shape_box(&box, cube[0], cube[1], 3);
  for (uint64_t n = 1;; n++) {
    SporeError error = SPORE_ERROR_INIT;
    spore_allocation_fail_at(n);
    bool done = spore_triangle_mesh_simplify(&box, &options, &few, &report, NULL, &error);
    spore_allocation_fail_at(0);
    if (done) break;
    g_assert_cmpint(error.code, ==, SPORE_ERROR_MEMORY);
    g_assert_null(few.vertices);
  }
  spore_triangle_mesh_clear(&few);
  SporeError error = SPORE_ERROR_INIT;
  int calls = 0;
  const SporeProgress progress = {.report = refuse, .data = &calls};
  g_assert_false(spore_triangle_mesh_simplify(&box, &options, &few, &report, &progress, &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_CANCELLED);
  spore_triangle_mesh_clear(&box);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/simplify/ball", test_ball);
  g_test_add_func("/simplify/box", test_box);
  g_test_add_func("/simplify/ring", test_ring);
  g_test_add_func("/simplify/thin", test_thin);
  g_test_add_func("/simplify/sheet", test_sheet);
  g_test_add_func("/simplify/size", test_size);
  g_test_add_func("/simplify/crossings", test_crossings);
  g_test_add_func("/simplify/without-memory", test_without_memory);
  return g_test_run();
}
