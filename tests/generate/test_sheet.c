/* Patches of shapes whose sides, areas and best sheets are known; and what is no patch. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/sheet/sheet.h"
#include "core/math/spline_sheet.h"
#include "core/mesh/common.h"
#include "core/mesh/sheet_fit.h"
#include "core/mesh/sheet_parameters.h"
#include "tests/mesh/shapes.h"

typedef SporeVec3 Shape(double u, double v);

static SporeVec3 plane(double u, double v) { return spore_vec3(0.1 * u, 0.08 * v, 0); }
static SporeVec3 cylinder(double u, double v) { return spore_vec3(0.05 * cos(3 * u), 0.05 * sin(3 * u), 0.1 * v); }
static SporeVec3 saddle(double u, double v) { return spore_vec3(0.1 * u, 0.1 * v, 0.1 * (u - 0.5) * (v - 0.5)); }
/* Eight waves of 2 mm along u. */
static SporeVec3 waves(double u, double v) { return spore_vec3(0.1 * u, 0.1 * v, 0.002 * sin(16 * G_PI * u)); }

static double noise(guint32 *state) {
  *state = *state * 1664525u + 1013904223u;
  return (double)*state / 4294967296.0 - 0.5;
}

/* across x along cells of the unit square, whose inner points are not where a grid has them. */
static void make(SporeTriangleMesh *mesh, Shape *shape, size_t across, size_t along) {
  guint32 state = 1;
  size_t row = across + 1, t = 0;
  g_assert_true(spore_triangle_mesh_allocate(mesh, row * (along + 1), 2 * across * along, NULL));
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    size_t x = i % row, y = i / row;
    bool inner = x > 0 && x < across && y > 0 && y < along;
    double u = (double)x + inner * 0.4 * noise(&state), v = (double)y + inner * 0.4 * noise(&state);
    spore_vec3_store(mesh->vertices + 3 * i, shape(u / (double)across, v / (double)along));
  }
  for (size_t c = 0; c < across * along; c++) {
    uint32_t a = (uint32_t)(c / across * row + c % across), b = a + 1, d = a + (uint32_t)row, e = d + 1;
    const uint32_t even[6] = {a, b, e, a, e, d}, odd[6] = {a, b, d, b, e, d};
    memcpy(mesh->triangles + 3 * t, c % across % 2 == c / across % 2 ? even : odd, sizeof even);
    t += 2;
  }
}

static SporeSheetOptions between(const SporeVec3 corner[4]) {
  SporeSheetOptions options = {.corners_given = true, .control_points = 12};
  for (int k = 0; k < 4; k++) spore_vec3_store(options.corners[k], corner[k]);
  return options;
}

/* Cuts, measures, and looks whether the patch is laid out without a triangle that is turned over. */
static SporeSheetReport cut(const SporeTriangleMesh *mesh, const SporeSheetOptions *options) {
  SporeTriangleMesh patch;
  SporeSheetReport report;
  SporeError error = SPORE_ERROR_INIT;
  double *distance = NULL;
  if (!spore_sheet_from_mesh(mesh, options, &patch, &distance, &report, NULL, &error)) g_error("%s", error.message);
  g_autofree double *at = g_new0(double, 2 * patch.vertex_count);
  g_assert_true(spore_sheet_parameters(&patch, report.corners[0], at, NULL, &error));
  for (size_t t = 0; t < patch.triangle_count; t++) {
    const double *a = at + 2 * patch.triangles[3 * t], *b = at + 2 * patch.triangles[3 * t + 1],
                 *c = at + 2 * patch.triangles[3 * t + 2];
    g_assert_cmpfloat((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]), >, 0);
  }
  for (size_t i = 0; i < patch.vertex_count; i++) g_assert_cmpfloat(distance[i], <=, report.largest[0]);
  g_test_message(
      "%zu x %zu: off %.3g and %.3g mm, rms %.3g and %.3g; sides %.4f %.4f %.4f %.4f mm; area %.5g, kept %.5f",
      report.control_points[0], report.control_points[1], 1e3 * report.largest[0], 1e3 * report.largest[1],
      1e3 * report.rms[0], 1e3 * report.rms[1], 1e3 * report.side[0], 1e3 * report.side[1], 1e3 * report.side[2],
      1e3 * report.side[3], report.area, report.area_kept);
  spore_free(distance);
  spore_triangle_mesh_clear(&patch);
  return report;
}

static void near_to(double value, double known, double relative) {
  g_assert_cmpfloat(fabs(value / known - 1), <, relative);
}

/* Sides are straight, though no edge of the mesh runs so: along edges they would be some per cent longer. */
static void test_plane(void) {
  static const double place[4][2] = {{0.2, 0.15}, {0.9, 0.2}, {0.8, 0.9}, {0.15, 0.75}};
  SporeTriangleMesh mesh;
  SporeVec3 corner[4];
  double area = 0;
  make(&mesh, plane, 40, 30);
  for (int k = 0; k < 4; k++) corner[k] = plane(place[k][0], place[k][1]);
  for (int k = 0; k < 4; k++) area += 0.5 * spore_vec3_cross(corner[k], corner[(k + 1) % 4]).z;
  SporeSheetOptions options = between(corner);
  for (int start = 0; start < 8; start++) { /* from each corner on, both ways around */
    for (int k = 0; k < 4; k++) spore_vec3_store(options.corners[k], corner[(start + (start < 4 ? k : 4 - k)) % 4]);
    SporeSheetReport report = cut(&mesh, &options);
    for (int k = 0; k < 4; k++) {
      SporeVec3 a = spore_vec3_load(report.corners[k]), b = spore_vec3_load(report.corners[(k + 1) % 4]);
      near_to(report.side[k], spore_vec3_distance(a, b), 2e-4);
      g_assert_false(report.follows_edge[k]);
      g_assert_cmpfloat(report.corner_distance[k], <, 1e-4);
    }
    near_to(report.area, area, 2e-3);
    near_to(report.area_kept, 1, 1e-3);
    g_assert_cmpfloat(report.largest[1], <, 1e-12);
    g_assert_cmpfloat(report.largest[0], <, 2e-5); /* along the sides, which pass some vertices of the mesh */
    g_assert_cmpuint(report.fold_overs, ==, 0);
  }
  spore_triangle_mesh_clear(&mesh);
}

/* A sheet without a vertex inside is laid out by its corners alone. */
static void test_two_triangles(void) {
  const double vertices[] = {0, 0, 0, 0.1, 0, 0, 0.1, 0.1, 0, 0, 0.1, 0};
  const uint32_t triangles[] = {0, 1, 2, 0, 2, 3};
  SporeTriangleMesh mesh = {
      .vertex_count = 4, .triangle_count = 2, .vertices = (double *)vertices, .triangles = (uint32_t *)triangles};
  double at[8];
  SporeError error = SPORE_ERROR_INIT;
  g_assert_true(spore_sheet_parameters(&mesh, NULL, at, NULL, &error));
  for (int k = 0; k < 8; k++) g_assert_true(at[k] == 0 || at[k] == 1);
}

/* Helices; and a sheet that is nearer to the cylinder than its facets are. */
static void test_cylinder(void) {
  static const double place[4][2] = {{0.1, 0.1}, {0.85, 0.25}, {0.9, 0.9}, {0.2, 0.8}};
  SporeTriangleMesh mesh;
  SporeVec3 corner[4];
  make(&mesh, cylinder, 60, 40);
  for (int k = 0; k < 4; k++) corner[k] = cylinder(place[k][0], place[k][1]);
  SporeSheetOptions options = between(corner);
  SporeSheetReport report = cut(&mesh, &options);
  for (int k = 0; k < 4; k++) {
    const double *a = place[k], *b = place[(k + 1) % 4];
    near_to(report.side[k], hypot(0.15 * (b[0] - a[0]), 0.1 * (b[1] - a[1])), 1e-3);
  }
  double facet = 0.05 * (1 - cos(1.8 * 3 / 60.0 / 2)); /* of the widest cell */
  g_assert_cmpfloat(report.largest[1], <, facet);
  near_to(report.area_kept, 1, 2e-3);
  spore_triangle_mesh_clear(&mesh);
}

/* A sixth of the ball, and what is left of the ball. */
static void test_ball(void) {
  SporeTriangleMesh mesh;
  const double a = 0.05 / sqrt(3), area = 4 * G_PI * 0.05 * 0.05 / 6;
  const SporeVec3 corner[4] = {{a, a, 1.1 * a}, {-a, a, a}, {-a, -a, a}, {a, -a, a}};
  shape_ball(&mesh, 0.05, 22);
  SporeSheetOptions options = between(corner);
  SporeSheetReport report = cut(&mesh, &options);
  for (int k = 1; k < 3; k++) near_to(report.side[k], 0.05 * acos(1 / 3.0), 2e-3);
  g_assert_cmpfloat(report.corner_distance[0], >, 0.05 * a); /* given off the ball */
  near_to(report.area, area, 0.04);
  g_assert_cmpfloat(report.largest[1], <, 0.05 * (1 - cos(sqrt(2) / 22))); /* how deep a facet lies at most */
  options.inside_given = true;
  options.inside[2] = -0.05;
  report = cut(&mesh, &options);
  near_to(report.area, 5 * area, 0.02);
  spore_triangle_mesh_clear(&mesh);
}

static void test_saddle(void) {
  SporeTriangleMesh mesh;
  make(&mesh, saddle, 40, 40);
  const SporeVec3 corner[4] = {saddle(0.1, 0.1), saddle(0.9, 0.1), saddle(0.9, 0.9), saddle(0.1, 0.9)};
  SporeSheetOptions options = between(corner);
  SporeSheetReport report = cut(&mesh, &options);
  g_assert_cmpfloat(report.largest[1], <, 0.1 / 4 * pow(1.4 / 40, 2)); /* how deep a facet lies at most */
  near_to(report.side[0], hypot(0.08, 0.032), 1e-3);                   /* the surface is made of straight lines */
  near_to(report.area_kept, 1, 1e-3);
  spore_triangle_mesh_clear(&mesh);
}

/* Too few control points for the waves: what is told is their height. With a tolerance there are as many as it takes,
 * and one less does not do. */
static void test_error_is_told(void) {
  SporeTriangleMesh mesh;
  make(&mesh, waves, 96, 12);
  const SporeVec3 corner[4] = {waves(0, 0), waves(1, 0), waves(1, 1), waves(0, 1)};
  SporeSheetOptions options = between(corner);
  options.control_points = 6;
  SporeSheetReport report = cut(&mesh, &options);
  g_assert_cmpfloat(report.largest[0], >, 0.0018);
  near_to(report.rms[0], 0.002 / sqrt(2), 0.25);
  options.control_points = 0, options.tolerance = 2e-4;
  report = cut(&mesh, &options);
  g_assert_true(report.reached);
  g_assert_cmpfloat(fmax(report.largest[0], report.largest[1]), <=, options.tolerance);
  options.control_points = report.control_points[0] - 1;
  report = cut(&mesh, &options);
  g_assert_cmpfloat(fmax(report.largest[0], report.largest[1]), >, options.tolerance);
  options.control_points = 0, options.tolerance = 1e-12;
  g_assert_false(cut(&mesh, &options).reached);
  spore_triangle_mesh_clear(&mesh);
}

/* A wave as long as the smoothing comes to half its height; without smoothing to all of it. */
static void test_smoothing(void) {
  SporeTriangleMesh mesh;
  SporeError error = SPORE_ERROR_INIT;
  double control[3 * 83 * 7], height[2];
  make(&mesh, waves, 160, 4);
  g_autofree double *at = g_new0(double, 2 * mesh.vertex_count);
  g_assert_true(spore_sheet_parameters(&mesh, NULL, at, NULL, &error));
  for (size_t i = 0; i < mesh.vertex_count; i++) /* as they are without the waves */
    at[2 * i] = mesh.vertices[3 * i] / 0.1, at[2 * i + 1] = mesh.vertices[3 * i + 1] / 0.1;
  for (int smooth = 0; smooth < 2; smooth++) {
    const SporeSplineSheet sheet = {{80, 4}, control};
    double length = 0;
    for (int i = 0; i < 1600; i++) /* of a line through the waves, by which lengths of the sheet are measured */
      length += spore_vec3_distance(waves(i / 1600.0, 0), waves((i + 1) / 1600.0, 0));
    g_assert_true(spore_sheet_fit(&mesh, at, sheet.span, smooth ? length / 8 : 0, control));
    height[smooth] = 0;
    for (double u = 20; u < 60; u += 0.25) {
      SporeSheetPlace place = spore_spline_sheet_place(&sheet, (const double[2]){u, 2});
      height[smooth] = fmax(height[smooth], spore_spline_sheet_point(&sheet, &place, 0).z);
    }
  }
  g_test_message("height %.4f and %.4f mm", 1e3 * height[0], 1e3 * height[1]);
  near_to(height[0], 0.002, 0.02);
  near_to(height[1], 0.001, 0.02);
  spore_triangle_mesh_clear(&mesh);
}

/* Corners near open edges lie on them, and sides follow them; the sheet of a mesh without corners finds its own. */
static void test_open_edges(void) {
  SporeTriangleMesh mesh;
  make(&mesh, cylinder, 30, 20);
  const SporeVec3 corner[4] = {cylinder(0.1, 0.005), cylinder(0.9, 0), cylinder(0.8, 0.6), cylinder(0.2, 0.6)};
  SporeSheetOptions options = between(corner);
  SporeSheetReport report = cut(&mesh, &options);
  g_assert_true(report.follows_edge[0]);
  g_assert_cmpfloat(report.corners[0][2], ==, 0);
  for (int k = 1; k < 4; k++) g_assert_false(report.follows_edge[k]);
  near_to(report.side[0], 0.8 * 0.15, 2e-3);
  options.corners_given = false;
  report = cut(&mesh, &options);
  near_to(report.area, 0.15 * 0.1, 2e-3);
  for (int k = 0; k < 4; k++) {
    SporeVec3 at = spore_vec3_load(report.corners[k]);
    g_assert_cmpfloat(
        fmin(spore_vec3_distance(at, cylinder(0, at.z / 0.1)), spore_vec3_distance(at, cylinder(1, at.z / 0.1))), <,
        1e-9);
  }
  spore_triangle_mesh_clear(&mesh);
}

/* Corners anywhere on a ball: a patch that is laid out, or a refusal in words. */
static void test_any_corners(void) {
  SporeTriangleMesh mesh;
  guint32 state = 7;
  guint made = 0, refused = 0;
  shape_ball(&mesh, 0.05, 8);
  for (int round = 0; round < 60; round++) {
    SporeSheetOptions options = {.corners_given = true, .control_points = 8};
    for (int k = 0; k < 4; k++)
      for (int e = 0; e < 3; e++) options.corners[k][e] = 0.1 * noise(&state);
    SporeTriangleMesh patch;
    SporeSheetReport report;
    SporeError error = SPORE_ERROR_INIT;
    if (spore_sheet_from_mesh(&mesh, &options, &patch, NULL, &report, NULL, &error)) {
      spore_triangle_mesh_clear(&patch);
      cut(&mesh, &options);
      made++;
    } else {
      g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
      refused++;
    }
  }
  g_test_message("%u patches, %u refused", made, refused);
  g_assert_cmpuint(made, >=, 20); /* sides of four random places cross each other two times in three */
  spore_triangle_mesh_clear(&mesh);
}

static void refuse(const SporeTriangleMesh *mesh, const SporeSheetOptions *options, const char *words) {
  SporeTriangleMesh patch;
  SporeSheetReport report;
  SporeError error = SPORE_ERROR_INIT;
  g_assert_false(spore_sheet_from_mesh(mesh, options, &patch, NULL, &report, NULL, &error));
  g_assert_cmpuint(patch.triangle_count, ==, 0);
  g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
  if (!strstr(error.message, words)) g_error("%s, instead of: %s", error.message, words);
}

static void test_no_patch(void) {
  SporeTriangleMesh ball, other, torus, holed;
  const double a = 0.03;
  const SporeVec3 corner[4] = {{a, a, a}, {-a, a, a}, {-a, -a, a}, {a, -a, a}};
  const SporeVec3 crossed[4] = {{a, a, a}, {-a, -a, a}, {-a, a, a}, {a, -a, a}};
  shape_ball(&ball, 0.05, 8);
  SporeSheetOptions options = between(crossed);
  refuse(&ball, &options, "meets another side");
  options = between(corner);
  memcpy(options.corners[2], options.corners[1], sizeof options.corners[1]);
  refuse(&ball, &options, "corners 2 and 3 come to lie at the same place");
  options = between(corner);
  options.corners[1][1] = 0.3;
  refuse(&ball, &options, "corner 2 lies 0.253 m off the surface");
  shape_ball(&other, 0.02, 4);
  shape_move(&other, 0.2, 0, 0);
  shape_append(&ball, &other);
  options = between(corner);
  options.inside_given = true, options.inside[0] = 0.2;
  refuse(&ball, &options, "inside lies on another piece");
  options.corners[3][0] = 0.2;
  refuse(&ball, &options, "do not hang together");
  shape_torus(&torus, 0.05, 0.02, 40, 20);
  const SporeVec3 around[4] = {{0.05, 0, 0.02}, {0, 0.05, 0.02}, {-0.05, 0, 0.02}, {0, -0.05, 0.02}};
  options = between(around);
  refuse(&torus, &options, "around a handle");
  const SporeVec3 small[4] = {{0.05, 0.01, 0.02}, {0.05, -0.01, 0.02}, {0.06, -0.01, 0.02}, {0.06, 0.01, 0.02}};
  options = between(small);
  g_assert_cmpuint(cut(&torus, &options).fold_overs, ==, 0);
  options.inside_given = true, options.inside[0] = -0.05;
  refuse(&torus, &options, "has a handle");
  make(&holed, plane, 20, 20);
  memmove(holed.triangles + 3 * 420, holed.triangles + 3 * 422,
          3 * (holed.triangle_count - 422) * sizeof *holed.triangles);
  holed.triangle_count -= 2;
  const SporeVec3 wide[4] = {plane(0.1, 0.1), plane(0.9, 0.1), plane(0.9, 0.9), plane(0.1, 0.9)};
  options = between(wide);
  refuse(&holed, &options, "has holes");
  options.control_points = 5;
  refuse(&holed, &options, "number of control points");
  SporeTriangleMesh *all[] = {&ball, &other, &torus, &holed};
  for (size_t i = 0; i < G_N_ELEMENTS(all); i++) spore_triangle_mesh_clear(all[i]);
}

/* Ends at its first question after so many. */
static bool stops(void *data, double fraction, const char *stage) { return (*(int *)data)-- > 0; }

static void test_cancel(void) {
  SporeTriangleMesh mesh, patch;
  SporeSheetReport report;
  make(&mesh, saddle, 40, 40);
  SporeSheetOptions options = {.control_points = SPORE_SHEET_MOST_POINTS};
  /* Places between two questions cost as much whatever the sheet: the fit asks the more, the more control points. */
  const int asked = (int)(16 * SPORE_SHEET_MOST_POINTS * SPORE_SHEET_MOST_POINTS / 1200), after[] = {0, 1, 2, asked};
  for (gsize i = 0; i < G_N_ELEMENTS(after); i++) {
    int left = after[i];
    const SporeProgress progress = {.report = stops, .data = &left};
    SporeError error = SPORE_ERROR_INIT;
    g_assert_false(spore_sheet_from_mesh(&mesh, &options, &patch, NULL, &report, &progress, &error));
    g_assert_cmpint(error.code, ==, SPORE_ERROR_CANCELLED);
  }
  spore_triangle_mesh_clear(&mesh);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/sheet/plane", test_plane);
  g_test_add_func("/sheet/two-triangles", test_two_triangles);
  g_test_add_func("/sheet/cylinder", test_cylinder);
  g_test_add_func("/sheet/ball", test_ball);
  g_test_add_func("/sheet/saddle", test_saddle);
  g_test_add_func("/sheet/error-is-told", test_error_is_told);
  g_test_add_func("/sheet/smoothing", test_smoothing);
  g_test_add_func("/sheet/open-edges", test_open_edges);
  g_test_add_func("/sheet/any-corners", test_any_corners);
  g_test_add_func("/sheet/no-patch", test_no_patch);
  g_test_add_func("/sheet/cancel", test_cancel);
  return g_test_run();
}
