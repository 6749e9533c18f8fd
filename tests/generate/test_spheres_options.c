/* Spheres by more than their number: mirror planes, regions, a series of numbers, a tolerance; curves, sheets and
 * tetrahedra instead of a surface. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/generate/spheres/spheres.h"
#include "sets.h"
#include "tests/mesh/shapes.h"
#include "tests/sanitized.h"

#define CLOSE(a, b, tolerance) g_assert_cmpfloat_with_epsilon(a, b, tolerance)

static SporeSphereSet make(const SporeTriangleMesh *mesh, size_t count, uint64_t seed, SporeSpheresReport *report) {
  return make_set(mesh, (SporeSpheresOptions){.count = count, .seed = seed}, report);
}

/* A box about (1, 2, 3) is its own image in three planes: so is the set, to rounding; in as many as go with its number.
 */
static void test_symmetry(void) {
  const size_t counts[] = {1, 7, 30, 61, 64};
  SporeTriangleMesh box;
  SporeSpheresReport report;
  shape_box(&box, (double[3]){0.95, 1.97, 2.98}, (double[3]){1.05, 2.03, 3.02}, 1);
  for (size_t n = 0; n < G_N_ELEMENTS(counts); n += tests_sanitized ? 3 : 1) {
    SporeSphereSet set = make(&box, counts[n], 1, &report);
    size_t mirrors = count_mirrors(&set, (double[3]){1, 2, 3});
    g_test_message("%zu spheres, %zu mirrors", counts[n], mirrors);
    g_assert_cmpuint(report.mirrors, >=, counts[n] % 2 ? 1 : 2);
    g_assert_cmpuint(mirrors, >=, report.mirrors);
    spore_sphere_set_clear(&set);
  }
  spore_triangle_mesh_clear(&box);
}

/* Turned by 30 degrees about z, the planes stand on no axis of the coordinates; with a corner pulled there is none. */
static void test_symmetry_found(void) {
  SporeTriangleMesh box;
  SporeSpheresReport report;
  shape_box(&box, (double[3]){-0.05, -0.03, -0.02}, (double[3]){0.05, 0.03, 0.02}, 1);
  for (size_t i = 0; i < box.vertex_count; i++) {
    double *v = box.vertices + 3 * i, x = v[0], y = v[1];
    v[0] = cos(M_PI / 6) * x - sin(M_PI / 6) * y, v[1] = sin(M_PI / 6) * x + cos(M_PI / 6) * y;
  }
  SporeSphereSet turned = make(&box, 20, 1, &report);
  g_assert_cmpuint(report.mirrors, >=, 2);
  box.vertices[0] *= 1.1;
  SporeSphereSet pulled = make(&box, 20, 1, &report);
  g_assert_cmpuint(report.mirrors, ==, 0);
  spore_sphere_set_clear(&pulled);
  spore_sphere_set_clear(&turned);
  spore_triangle_mesh_clear(&box);
}

/* Spheres with their centre in the half with z > 0 of a long box. */
static size_t count_above(const SporeSphereSet *set) {
  size_t above = 0;
  for (size_t i = 0; i < set->count; i++) above += set->spheres[4 * i + 2] > 0;
  return above;
}

/* Eight times as many are asked for in one half of a long bar: eight of nine lie there, about, and the half is nearer;
 * four times as many that bound it: four of five. */
static void test_region(void) {
  SporeTriangleMesh bar;
  SporeSpheresReport report;
  SporeGenerateRegion region = {{0, 0, 0.1}, 0.1, 8, 0};
  SporeSpheresOptions options = {.count = 60, .seed = 1, .regions = &region, .region_count = 1};
  SporeSphereSet set;
  shape_box(&bar, (double[3]){-0.01, -0.01, -0.1}, (double[3]){0.01, 0.01, 0.1}, 4);
  g_assert_true(spore_spheres_from_mesh(&bar, &options, &set, &report, NULL, NULL));
  g_test_message("%zu of 60 spheres in the region, coverage %.3f", count_above(&set), report.coverage);
  g_assert_cmpuint(count_above(&set), >, 45);
  g_assert_cmpuint(count_above(&set), <, 58);
  spore_sphere_set_clear(&set);
  options.mode = SPORE_SPHERES_BOUNDING, options.count = 40, region.value = 4;
  g_assert_true(spore_spheres_from_mesh(&bar, &options, &set, &report, NULL, NULL));
  g_test_message("%zu of 40 bounding spheres in the region", count_above(&set));
  g_assert_true(report.certified);
  g_assert_cmpuint(count_above(&set), >, 27);
  g_assert_cmpuint(count_above(&set), <, 38);
  spore_sphere_set_clear(&set);
  region.value = 0;
  SporeError error = SPORE_ERROR_INIT;
  g_assert_false(spore_spheres_from_mesh(&bar, &options, &set, &report, NULL, &error));
  g_assert_nonnull(strstr(error.message, "region 1 has the factor 0"));
  spore_triangle_mesh_clear(&bar);
}

/* Along a straight capsule: equal steps from end to end; between the ends the radius splits the wall, and what sticks
 * out and what is missing are those of a chain of balls, integrated along the axis. */
static void test_curve_straight(void) {
  double numbers[] = {0, 0, 0, 0.01, 0.12, 0, 0, 0.01}, h = 0.01, r = 0.01, grown = r * r + h * h / 16;
  SporeCurve curve = {2, numbers};
  SporeSpheresOptions options = {.count = 13, .seed = 1};
  SporeSphereSet set;
  SporeSpheresReport report;
  g_assert_true(spore_spheres_from_source(&(SporeSpheresSource){.curve = &curve}, &options, &set, &report, NULL, NULL));
  double out = 0, held = 4. / 3 * M_PI * r * r * r, whole = held + M_PI * r * r * 0.12;
  for (int i = 0; i < 13; i++)
    g_assert_true(set_holds(&set, (double[4]){h * i, 0, 0, i % 12 ? sqrt(grown) : r}, NULL, 1e-9));
  for (double x = 0.5e-5; x < 0.12; x += 1e-5) {
    double wall = 0;
    for (int i = 0; i < 13; i++) wall = fmax(wall, (i % 12 ? grown : r * r) - (x - h * i) * (x - h * i));
    out += M_PI * fmax(wall - r * r, 0) * 1e-5, held += M_PI * fmin(wall, r * r) * 1e-5;
  }
  CLOSE(report.outside, out / whole, 3e-3);
  CLOSE(report.coverage, held / whole, 3e-3);
  spore_sphere_set_clear(&set);
  options.count = 1;
  g_assert_true(spore_spheres_from_source(&(SporeSpheresSource){.curve = &curve}, &options, &set, &report, NULL, NULL));
  g_assert_true(set_holds(&set, (double[4]){0.06, 0, 0, 0.01}, NULL, 1e-12));
  spore_sphere_set_clear(&set);
}

/* A ring that thins out: closer where it is thin, all centres on the curve, and by tolerance it is met. */
static void test_curve_bent(void) {
  double numbers[4 * 61];
  SporeCurve curve = {61, numbers};
  for (int i = 0; i <= 60; i++) {
    double angle = 1.5 * M_PI * i / 60, radius = 0.008 - 0.006 * i / 60;
    memcpy(numbers + 4 * i, (double[4]){0.05 * cos(angle), 0.05 * sin(angle), 0, radius}, 4 * sizeof(double));
  }
  SporeSpheresOptions options = {.targets.distance = 0.001, .seed = 1};
  SporeSphereSet set;
  SporeSpheresReport report;
  g_assert_true(spore_spheres_from_source(&(SporeSpheresSource){.curve = &curve}, &options, &set, &report, NULL, NULL));
  g_assert_cmpfloat(report.distance_mean, <=, 0.001);
  for (size_t i = 0; i < set.count; i++) CLOSE(hypot(set.spheres[4 * i], set.spheres[4 * i + 1]), 0.05, 1e-4);
  const double *s = set.spheres, *last = s + 4 * (set.count - 2);
  double first_step = spore_vec3_distance(spore_vec3_load(s), spore_vec3_load(s + 4));
  g_assert_cmpfloat(spore_vec3_distance(spore_vec3_load(last), spore_vec3_load(last + 4)), <, 0.6 * first_step);
  spore_sphere_set_clear(&set);
}

/* A square sheet beside half a cylinder of a fifth of its width: all of it held, centres on it, closer where it bends.
 */
static void test_sheet(void) {
  enum { ACROSS = 40, ALONG = 20, FLAT = 20 };
  SporeTriangleMesh sheet;
  SporeSphereSet set;
  SporeSpheresReport report;
  g_assert_true(spore_triangle_mesh_allocate(&sheet, (ACROSS + 1) * (ALONG + 1), 2 * ACROSS * ALONG, NULL));
  for (size_t i = 0; i <= ACROSS; i++)
    for (size_t k = 0; k <= ALONG; k++) {
      double angle = i > FLAT ? M_PI * (double)(i - FLAT) / (ACROSS - FLAT) : 0, r = 0.1 / M_PI;
      double x = i > FLAT ? 0.1 + r * sin(angle) : 0.1 * (double)i / FLAT;
      spore_vec3_store(sheet.vertices + 3 * (i * (ALONG + 1) + k),
                       spore_vec3(x, 0.1 * (double)k / ALONG, r * (1 - cos(angle))));
    }
  for (size_t i = 0; i < ACROSS; i++)
    for (size_t k = 0; k < ALONG; k++) {
      uint32_t a = (uint32_t)(i * (ALONG + 1) + k), b = a + ALONG + 1;
      memcpy(sheet.triangles + 6 * (i * ALONG + k), (uint32_t[6]){a, b, b + 1, a, b + 1, a + 1}, 6 * sizeof a);
    }
  SporeSpheresSource source = {.sheet = &sheet};
  SporeSpheresOptions options = {.count = 100, .seed = 1};
  g_assert_true(spore_spheres_from_source(&source, &options, &set, &report, NULL, NULL));
  size_t flat = 0;
  for (size_t i = 0; i < set.count; i++) {
    const double *s = set.spheres + 4 * i, r = 0.1 / M_PI;
    flat += s[0] < 0.1 && s[2] < r;
    double off = s[0] < 0.1 ? fmin(fabs(s[2]), fabs(s[2] - 2 * r)) : fabs(hypot(s[0] - 0.1, s[2] - r) - r);
    CLOSE(off, 0, 1e-3 * 0.1);
  }
  g_test_message("%zu of 100 spheres on the flat half", flat);
  g_assert_cmpuint(flat, <, 46);
  g_assert_cmpuint(flat, >, 20);
  g_assert_cmpfloat(report.coverage, ==, 1);
  g_assert_true(isnan(report.depth_error));
  spore_sphere_set_clear(&set);
  options.thickness = 0.004; /* 100 discs of that diameter hold a sixteenth of the area at most */
  g_assert_true(spore_spheres_from_source(&source, &options, &set, &report, NULL, NULL));
  CLOSE(set.spheres[3], 0.002, 1e-12);
  CLOSE(report.coverage, 100 * M_PI * 0.002 * 0.002 / 0.02, 0.01);
  spore_sphere_set_clear(&set);
  spore_triangle_mesh_clear(&sheet);
}

static void test_enough(void) {
  const size_t counts[] = {10, 20, 40, 160};
  const double errors[] = {0.1, 0.05, 0.045, 0.039};
  g_assert_cmpuint(spore_enough(counts, errors, 4, 0.01), ==, 1); /* from 20 on .005, then .003 a doubling */
  g_assert_cmpuint(spore_enough(counts, errors, 4, 0.004), ==, 2);
  g_assert_cmpuint(spore_enough(counts, errors, 4, 0.001), ==, 4);
  g_assert_cmpuint(spore_enough(counts, errors, 4, 0.9), ==, 0);
  g_assert_cmpuint(spore_enough(counts, errors, 1, 0.01), ==, 1);
}

static void count_point(void *data, size_t point, const SporeSpheresReport *report) {
  size_t *points = data;
  g_assert_cmpuint(point, ==, (*points)++);
  g_assert_cmpfloat(report->coverage, >, 0.5);
}

/* Each point of a series is the set that its number gives alone. */
static void test_series(void) {
  SporeTriangleMesh torus;
  SporeSpheresReport reports[2], alone;
  SporeSpheresOptions options = {.seed = 1};
  const size_t counts[] = {8, 16}, wrong[] = {8, 8};
  size_t points = 0;
  shape_torus(&torus, 0.06, 0.02, 16, 8);
  SporeSpheresSource source = {.solid = &torus};
  g_assert_true(spore_spheres_series(&source, &options, counts, 2, reports, count_point, &points, NULL, NULL));
  g_assert_cmpuint(points, ==, 2);
  SporeSphereSet set = make(&torus, 16, 1, &alone);
  g_assert_cmpfloat(alone.depth_error, ==, reports[1].depth_error);
  SporeError error = SPORE_ERROR_INIT;
  g_assert_false(spore_spheres_series(&source, &options, wrong, 2, reports, NULL, NULL, NULL, &error));
  g_assert_nonnull(strstr(error.message, "ascending"));
  spore_sphere_set_clear(&set);
  spore_triangle_mesh_clear(&torus);
}

static void test_tolerance(void) {
  SporeTriangleMesh torus;
  SporeSpheresReport report, fewer;
  SporeSphereSet set;
  SporeSpheresOptions options = {.targets.distance = 0.008, .seed = 1};
  shape_torus(&torus, 0.06, 0.02, 16, 8);
  g_assert_true(spore_spheres_from_mesh(&torus, &options, &set, &report, NULL, NULL));
  g_assert_cmpfloat(report.distance_mean, <=, 0.008);
  SporeSphereSet less = make(&torus, set.count * 9 / 10, 1, &fewer);
  g_assert_cmpfloat(fewer.distance_mean, >, 0.008);
  spore_sphere_set_clear(&less);
  spore_sphere_set_clear(&set);
  spore_triangle_mesh_clear(&torus);
}

/* Of several targets all are reached, and it is told which takes the spheres. */
static void test_targets(void) {
  SporeTriangleMesh torus;
  SporeSpheresReport report, fewer;
  SporeSphereSet set;
  SporeSpheresOptions options = {.targets = {.coverage = 0.88, .outside = 0.15, .depth_error = 0.5}, .seed = 1};
  double excess;
  shape_torus(&torus, 0.06, 0.02, 16, 8);
  g_assert_true(spore_spheres_from_mesh(&torus, &options, &set, &report, NULL, NULL));
  g_assert_cmpfloat(report.coverage, >=, 0.88);
  g_assert_cmpfloat(report.outside, <=, 0.15);
  g_assert_cmpstr(spore_spheres_hardest_target(&options.targets, &report, &excess), !=, "depth_error");
  CLOSE(excess, fmax((1 - report.coverage) / 0.12, report.outside / 0.15), 1e-12);
  SporeSphereSet less = make(&torus, set.count * 4 / 5, 1, &fewer);
  g_assert_true(fewer.coverage < 0.88 || fewer.outside > 0.15);
  spore_sphere_set_clear(&less);
  spore_sphere_set_clear(&set);
  g_assert_null(spore_spheres_hardest_target(&(SporeSpheresTargets){0}, &report, NULL));
  spore_triangle_mesh_clear(&torus);
}

/* The solid of the cells, with fewer spheres than cells. */
static void test_tetrahedra(void) {
  SporeTetrahedralMesh mesh;
  SporeSphereSet set;
  SporeSpheresReport report;
  SporeSpheresOptions options = {.count = 40, .seed = 1};
  shape_tetrahedral_box(&mesh, 4, 0.02);
  g_assert_true(spore_spheres_from_tetrahedra(&mesh, &options, &set, &report, NULL, NULL));
  g_assert_cmpuint(set.count, ==, 40);
  g_assert_cmpfloat(report.coverage, >, 0.95);
  g_assert_cmpfloat(report.outside, <, 0.07);
  const double fitted = report.depth_error;
  spore_sphere_set_clear(&set);
  options.each_cell = true; /* the paper's way: all is held, with more outside and a larger error, by more spheres */
  g_assert_true(spore_spheres_from_tetrahedra(&mesh, &options, &set, &report, NULL, NULL));
  g_assert_cmpuint(set.count, ==, mesh.tetrahedron_count);
  for (size_t t = 0; t < set.count; t++)
    for (size_t k = 0; k < 4; k++)
      g_assert_cmpfloat(spore_vec3_distance(spore_vec3_load(set.spheres + 4 * t),
                                            spore_vec3_load(mesh.vertices + 3 * (size_t)mesh.tetrahedra[4 * t + k])),
                        <, set.spheres[4 * t + 3] * (1 + 1e-9));
  g_assert_cmpfloat(report.coverage, >, 0.999);
  g_assert_cmpfloat(report.depth_error, >, fitted);
  spore_sphere_set_clear(&set);
  SporeError none = SPORE_ERROR_INIT;
  const SporeTriangleMesh *nothing = &(SporeTriangleMesh){0};
  g_assert_false(spore_spheres_from_mesh(nothing, &options, &set, &report, NULL, &none));
  g_assert_nonnull(strstr(none.message, "no tetrahedra"));
  options.each_cell = false;
  mesh.tetrahedra[3] = 1000;
  SporeError error = SPORE_ERROR_INIT;
  g_assert_false(spore_spheres_from_tetrahedra(&mesh, &options, &set, &report, NULL, &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
  spore_tetrahedral_mesh_clear(&mesh);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/generate/spheres/symmetry", test_symmetry);
  g_test_add_func("/generate/spheres/symmetry-found", test_symmetry_found);
  g_test_add_func("/generate/spheres/region", test_region);
  g_test_add_func("/generate/spheres/curve-straight", test_curve_straight);
  g_test_add_func("/generate/spheres/curve-bent", test_curve_bent);
  g_test_add_func("/generate/spheres/sheet", test_sheet);
  g_test_add_func("/generate/spheres/enough", test_enough);
  g_test_add_func("/generate/spheres/series", test_series);
  if (!tests_sanitized) g_test_add_func("/generate/spheres/tolerance", test_tolerance); /* one target of several */
  g_test_add_func("/generate/spheres/targets", test_targets);
  g_test_add_func("/generate/spheres/tetrahedra", test_tetrahedra);
  return g_test_run();
}
