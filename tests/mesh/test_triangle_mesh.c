/* Triangle meshes: report, welding, orientation, normals, validation, edges and tubes. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/mesh/volume.h"
#include "tests/mesh/shapes.h"

#define CLOSE(a, b, tolerance) g_assert_cmpfloat_with_epsilon(a, b, tolerance)

static const double zero[3] = {0, 0, 0}, one[3] = {1, 1, 1};

static SporeMeshReport report_of(const SporeTriangleMesh *mesh) {
  SporeMeshReport report;
  g_assert_true(spore_triangle_mesh_report(mesh, &report, NULL));
  return report;
}

static void test_report_box(void) {
  const double upper[3] = {1, 2, 3};
  SporeTriangleMesh box;
  shape_box(&box, zero, upper, 4);
  SporeMeshReport report = report_of(&box);
  g_assert_cmpuint(box.vertex_count, ==, 6 * 16 + 2);
  g_assert_true(report.closed);
  g_assert_true(spore_triangle_mesh_has_inside(&box));
  g_assert_cmpuint(report.components, ==, 1);
  g_assert_cmpuint(report.degenerate_triangles, ==, 0);
  CLOSE(report.volume, 6, 1e-12);
  CLOSE(report.area, 22, 1e-12);
  CLOSE(report.diagonal, sqrt(14), 1e-12);
  g_assert_cmpfloat(report.upper[2], ==, 3);
  spore_triangle_mesh_clear(&box);
}

/* Far from the origin the volume keeps its digits. */
static void test_report_far(void) {
  SporeTriangleMesh box;
  shape_box(&box, zero, one, 3);
  shape_move(&box, 1e6, -1e6, 1e6);
  CLOSE(report_of(&box).volume, 1, 1e-8);
  spore_triangle_mesh_clear(&box);
}

static void test_report_open(void) {
  SporeTriangleMesh box;
  shape_box(&box, zero, one, 1);
  box.triangle_count--;
  SporeMeshReport report = report_of(&box);
  g_assert_cmpuint(report.boundary_edges, ==, 3);
  g_assert_false(report.closed);
  g_assert_false(spore_triangle_mesh_has_inside(&box));
  spore_triangle_mesh_clear(&box);
}

static void test_report_misoriented(void) {
  SporeTriangleMesh box;
  shape_box(&box, zero, one, 1);
  uint32_t swap = box.triangles[0];
  box.triangles[0] = box.triangles[1];
  box.triangles[1] = swap;
  SporeMeshReport report = report_of(&box);
  g_assert_cmpuint(report.misoriented_edges, ==, 3);
  g_assert_false(report.closed);
  g_assert_false(spore_triangle_mesh_has_inside(&box));
  spore_triangle_mesh_clear(&box);
}

/* Two boxes that share one edge: four triangles meet there. */
static void test_report_nonmanifold(void) {
  const double lower[3] = {1, 1, 0}, upper[3] = {2, 2, 1};
  SporeTriangleMesh a, b;
  shape_box(&a, zero, one, 1);
  shape_box(&b, lower, upper, 1);
  shape_append(&a, &b);
  g_assert_cmpuint(report_of(&a).components, ==, 2);
  g_assert_true(spore_triangle_mesh_weld(&a, 1e-6, NULL));
  g_assert_true(spore_triangle_mesh_has_inside(&a));
  SporeMeshReport report = report_of(&a);
  g_assert_cmpuint(report.nonmanifold_edges, ==, 1);
  g_assert_cmpuint(report.components, ==, 1);
  g_assert_false(report.closed);
  spore_triangle_mesh_clear(&a);
  spore_triangle_mesh_clear(&b);
}

static void test_report_degenerate(void) {
  double vertices[] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0};
  uint32_t triangles[] = {0, 1, 2, 0, 1, 3, 0, 0, 1};
  SporeTriangleMesh mesh = {4, 3, vertices, triangles};
  g_assert_cmpuint(report_of(&mesh).degenerate_triangles, ==, 2);
}

static void test_weld(void) {
  SporeTriangleMesh ball, soup;
  shape_ball(&ball, 0.1, 6);
  g_assert_true(spore_triangle_mesh_copy(&soup, &ball, NULL));
  shape_unweld(&soup);
  g_assert_cmpuint(report_of(&soup).boundary_edges, ==, 3 * soup.triangle_count);
  for (size_t i = 0; i < 3 * soup.vertex_count; i++)
    soup.vertices[i] += 1e-9 * sin((double)i); /* below the tolerance */
  g_assert_true(spore_triangle_mesh_weld(&soup, 1e-6, NULL));
  g_assert_cmpuint(soup.vertex_count, ==, ball.vertex_count);
  g_assert_cmpuint(soup.triangle_count, ==, ball.triangle_count);
  g_assert_true(report_of(&soup).closed);
  spore_triangle_mesh_clear(&ball);
  spore_triangle_mesh_clear(&soup);
}

static void test_weld_drops(void) {
  /* vertex 3 is vertex 1 again, vertex 5 is not used; triangle 1 repeats triangle 0 turned over, triangle 2 collapses
   */
  double vertices[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1e-9, 0, 1, 1, 0, 9, 9, 9};
  uint32_t triangles[] = {0, 1, 2, 3, 0, 2, 1, 3, 2, 1, 4, 2};
  SporeTriangleMesh mesh;
  g_assert_true(spore_triangle_mesh_allocate(&mesh, 6, 4, NULL));
  memcpy(mesh.vertices, vertices, sizeof vertices);
  memcpy(mesh.triangles, triangles, sizeof triangles);
  uint32_t tags[] = {7, 8, 9, 6};
  g_assert_true(spore_triangle_mesh_weld_tagged(&mesh, 1e-6, tags, NULL));
  g_assert_cmpuint(tags[0], ==, 7);
  g_assert_cmpuint(tags[1], ==, 6);
  g_assert_cmpuint(mesh.vertex_count, ==, 4);
  g_assert_cmpuint(mesh.triangle_count, ==, 2);
  const uint32_t expected[] = {0, 1, 2, 1, 3, 2};
  g_assert_cmpmem(mesh.triangles, sizeof expected, expected, sizeof expected);
  spore_triangle_mesh_clear(&mesh);
}

static void test_weld_collapsed(void) {
  double vertices[9] = {1, 2, 3, 1, 2, 3, 1, 2, 3};
  uint32_t triangles[3] = {0, 1, 2};
  SporeTriangleMesh mesh = {3, 1, vertices, triangles};
  SporeError error = SPORE_ERROR_INIT;
  g_assert_false(spore_triangle_mesh_weld(&mesh, 1e-6, &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
  g_assert_cmpuint(mesh.vertex_count, ==, 3);
}

static void test_orient(void) {
  SporeTriangleMesh a, b;
  shape_ball(&a, 0.1, 5);
  shape_ball(&b, 0.05, 4);
  shape_move(&b, 0.5, 0, 0);
  double expected = report_of(&a).volume + report_of(&b).volume;
  shape_turn(&b);
  shape_append(&a, &b);
  for (size_t t = 0; t < a.triangle_count; t += 3) { /* every third the wrong way */
    uint32_t swap = a.triangles[3 * t];
    a.triangles[3 * t] = a.triangles[3 * t + 1];
    a.triangles[3 * t + 1] = swap;
  }
  g_assert_true(spore_triangle_mesh_orient(&a, NULL));
  SporeMeshReport report = report_of(&a);
  g_assert_true(report.closed);
  CLOSE(report.volume, expected, 1e-12);
  spore_triangle_mesh_clear(&a);
  spore_triangle_mesh_clear(&b);
}

/* A ball with a hollow, as it is and inside out: the hollow stays one. A ball of the same sense inside another does not
 * become one. */
static void test_orient_cavity(void) {
  for (int turned = 0; turned < 2; turned++)
    for (int hollow = 0; hollow < 2; hollow++) {
      SporeTriangleMesh a, b;
      shape_ball(&a, 1, 8);
      shape_ball(&b, 0.5, 8);
      double outer = report_of(&a).volume, inner = report_of(&b).volume;
      if (hollow) shape_turn(&b);
      shape_append(&a, &b);
      if (turned) shape_turn(&a);
      g_assert_true(spore_triangle_mesh_orient(&a, NULL));
      CLOSE(report_of(&a).volume, hollow ? outer - inner : outer + inner, 1e-12);
      spore_triangle_mesh_clear(&a);
      spore_triangle_mesh_clear(&b);
    }
}

/* Neither a Moebius band nor an edge with three wings makes it stumble. */
static void test_orient_impossible(void) {
  double vertices[18];
  uint32_t triangles[] = {0, 1, 2, 1, 2, 3, 2, 3, 4, 3, 4, 0, 4, 0, 1, 0, 1, 5};
  for (int i = 0; i < 6; i++) vertices[3 * i] = cos(i), vertices[3 * i + 1] = sin(i), vertices[3 * i + 2] = i % 2;
  SporeTriangleMesh mesh = {6, 6, vertices, triangles};
  g_assert_true(spore_triangle_mesh_orient(&mesh, NULL));
  g_assert_true(spore_triangle_mesh_validate(&mesh, NULL));
}

static void test_normals(void) {
  SporeTriangleMesh ball;
  shape_ball(&ball, 0.2, 8);
  double *normals = g_new(double, 3 * ball.vertex_count);
  spore_triangle_mesh_normals(ball.vertices, ball.vertex_count, ball.triangles, ball.triangle_count, normals);
  for (size_t i = 0; i < ball.vertex_count; i++) {
    SporeVec3 n = spore_vec3_load(normals + 3 * i), p = spore_vec3_load(ball.vertices + 3 * i);
    CLOSE(spore_vec3_length(n), 1, 1e-12);
    g_assert_cmpfloat(spore_vec3_dot(n, p) / 0.2, >, 0.995);
  }
  g_free(normals);
  spore_triangle_mesh_clear(&ball);
}

static void refuse(SporeTriangleMesh mesh, const char *expected) {
  SporeError error = SPORE_ERROR_INIT;
  g_assert_false(spore_triangle_mesh_validate(&mesh, &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
  g_assert_nonnull(strstr(error.message, expected));
}

static void test_validate(void) {
  double vertices[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  uint32_t triangles[] = {0, 1, 2, 2, 1, 3};
  g_assert_true(spore_triangle_mesh_validate(&(SporeTriangleMesh){3, 1, vertices, triangles}, NULL));
  refuse((SporeTriangleMesh){3, 2, vertices, triangles}, "triangle 1 uses vertex 3");
  refuse((SporeTriangleMesh){0, 1, vertices, triangles}, "0 vertices");
  refuse((SporeTriangleMesh){3, 0, vertices, triangles}, "0 triangles");
  refuse((SporeTriangleMesh){3, (size_t)SPORE_MESH_MAXIMUM + 1, vertices, triangles}, "too many");
  vertices[4] = NAN;
  refuse((SporeTriangleMesh){3, 1, vertices, triangles}, "vertex 1");
  vertices[4] = -INFINITY;
  refuse((SporeTriangleMesh){3, 1, vertices, triangles}, "vertex 1");
  vertices[4] = 2e9;
  refuse((SporeTriangleMesh){3, 1, vertices, triangles}, "vertex 1");
}

static void test_sphere_set(void) {
  SporeSphereSet set;
  SporeError error = SPORE_ERROR_INIT;
  g_assert_true(spore_sphere_set_allocate(&set, 2, NULL));
  set.spheres[3] = 1;
  g_assert_false(spore_sphere_set_validate(&set, &error));
  g_assert_nonnull(strstr(error.message, "sphere 1"));
  set.spheres[7] = 0.5;
  g_assert_true(spore_sphere_set_validate(&set, NULL));
  set.spheres[6] = NAN;
  g_assert_false(spore_sphere_set_validate(&set, &error));
  spore_sphere_set_clear(&set);
  g_assert_null(set.spheres);
  g_assert_false(spore_sphere_set_validate(&set, &error));
}

/* Euler: V - E + F = 2 for a ball, 0 for a torus. */
static void test_edges(void) {
  SporeTriangleMesh mesh;
  uint32_t *edges;
  size_t count;
  shape_torus(&mesh, 1, 0.3, 20, 10);
  g_assert_true(spore_edges_of_triangles(mesh.triangles, mesh.triangle_count, &edges, &count));
  g_assert_cmpuint(mesh.vertex_count + mesh.triangle_count, ==, count);
  for (size_t i = 0; i < count; i++) {
    g_assert_cmpuint(edges[2 * i], <, edges[2 * i + 1]);
    if (i)
      g_assert_true(edges[2 * i - 2] < edges[2 * i] ||
                    (edges[2 * i - 2] == edges[2 * i] && edges[2 * i - 1] < edges[2 * i + 1]));
  }
  spore_free(edges);
  spore_triangle_mesh_clear(&mesh);
}

/* Every allocation that fails gives an error, and nothing leaks (the sanitizer looks). */
/* A straight tube is a prism; one along a helix, with a corner, is closed and outward too. */
static void test_tube(void) {
  double straight[] = {0, 0, 0, 0.1, 0, 0, 1, 0.1, 0, 0, 3, 0.1};
  SporeCurve curve = {3, straight};
  SporeTriangleMesh tube;
  g_assert_true(spore_curve_validate(&curve, NULL));
  CLOSE(spore_curve_length(&curve), 3, 1e-15);
  g_assert_true(spore_curve_tube(&curve, 24, &tube, NULL));
  SporeMeshReport report = report_of(&tube);
  g_assert_true(report.closed);
  g_assert_cmpuint(report.components, ==, 1);
  CLOSE(report.volume, 3 * 12 * 0.1 * 0.1 * sin(2 * M_PI / 24), 1e-14);
  spore_triangle_mesh_clear(&tube);
  double helix[4 * 60];
  for (size_t i = 0; i < 60; i++) {
    double point[4] = {cos(0.3 * (double)i), i < 30 ? 0.05 * (double)i : 3 - 0.05 * (double)i, sin(0.3 * (double)i),
                       0.05};
    memcpy(helix + 4 * i, point, sizeof point);
  }
  curve = (SporeCurve){60, helix};
  g_assert_true(spore_curve_tube(&curve, 8, &tube, NULL));
  report = report_of(&tube);
  g_assert_true(report.closed);
  g_assert_cmpfloat(report.volume, >, 0.8 * M_PI * 0.05 * 0.05 * spore_curve_length(&curve));
  g_assert_cmpfloat(report.volume, <, M_PI * 0.05 * 0.05 * spore_curve_length(&curve));
  spore_triangle_mesh_clear(&tube);
}

static void test_no_memory(void) {
  SporeTriangleMesh mesh;
  SporeMeshReport report;
  bool done = false;
  shape_ball(&mesh, 1, 3);
  for (int job = 0; job < 4; job++) {
    done = false;
    for (uint64_t n = 1; !done; n++) {
      SporeError error = SPORE_ERROR_INIT;
      SporeTriangleMesh copy = {0};
      spore_allocation_fail_at(n);
      done = job == 0   ? spore_triangle_mesh_weld(&mesh, 1e-6, &error)
             : job == 1 ? spore_triangle_mesh_report(&mesh, &report, &error)
             : job == 2 ? spore_triangle_mesh_orient(&mesh, &error)
                        : spore_triangle_mesh_copy(&copy, &mesh, &error);
      spore_allocation_fail_at(0);
      g_assert_cmpint(error.code, ==, done ? SPORE_ERROR_NONE : SPORE_ERROR_MEMORY);
      g_assert_cmpuint(n, <, 50);
      spore_triangle_mesh_clear(&copy);
    }
  }
  spore_triangle_mesh_clear(&mesh);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/mesh/triangle/report-box", test_report_box);
  g_test_add_func("/mesh/triangle/report-far", test_report_far);
  g_test_add_func("/mesh/triangle/report-open", test_report_open);
  g_test_add_func("/mesh/triangle/report-misoriented", test_report_misoriented);
  g_test_add_func("/mesh/triangle/report-nonmanifold", test_report_nonmanifold);
  g_test_add_func("/mesh/triangle/report-degenerate", test_report_degenerate);
  g_test_add_func("/mesh/triangle/weld", test_weld);
  g_test_add_func("/mesh/triangle/weld-drops", test_weld_drops);
  g_test_add_func("/mesh/triangle/weld-collapsed", test_weld_collapsed);
  g_test_add_func("/mesh/triangle/orient", test_orient);
  g_test_add_func("/mesh/triangle/orient-cavity", test_orient_cavity);
  g_test_add_func("/mesh/triangle/orient-impossible", test_orient_impossible);
  g_test_add_func("/mesh/triangle/normals", test_normals);
  g_test_add_func("/mesh/triangle/validate", test_validate);
  g_test_add_func("/mesh/triangle/sphere-set", test_sphere_set);
  g_test_add_func("/mesh/triangle/edges", test_edges);
  g_test_add_func("/mesh/triangle/tube", test_tube);
  g_test_add_func("/mesh/triangle/no-memory", test_no_memory);
  return g_test_run();
}
