#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/spheres_parts.h"
#include "core/generate/spheres_series.h"
#include "core/generate/spheres_quality.h"
#include "sets.h"
#include "tests/mesh/shapes.h"

#define CLOSE(a, b, tolerance) g_assert_cmpfloat_with_epsilon(a, b, tolerance)

static SporeSphereSet make(const SporeTriangleMesh *mesh, size_t count, uint64_t seed, SporeSpheresReport *report) {
  return make_set(mesh, (SporeSpheresOptions){.count = count, .seed = seed}, report);
}

static void test_ball(void) {
  SporeTriangleMesh ball;
  SporeSpheresReport report;
  shape_ball(&ball, 0.05, 24);
  shape_move(&ball, 1, 2, 3);
  SporeSphereSet set = make(&ball, 1, 1, &report);
  const double expected[4] = {1, 2, 3, 0.05};
  for (int k = 0; k < 4; k++) CLOSE(set.spheres[k], expected[k], 1e-3 * 0.05);
  g_assert_cmpfloat(report.coverage, >, 0.997);
  g_assert_cmpfloat(report.outside, <, 0.003);
  g_assert_cmpfloat(report.distance_mean, <, 2e-4);
  g_assert_cmpfloat(report.depth_error, <, 1e-3);
  spore_sphere_set_clear(&set);
  spore_triangle_mesh_clear(&ball);
}

/* Turned inside out it is the same ball. */
static void test_inside_out(void) {
  SporeTriangleMesh ball;
  SporeSpheresReport report;
  shape_ball(&ball, 0.05, 12);
  SporeSphereSet right = make(&ball, 2, 1, &report);
  shape_turn(&ball);
  SporeSphereSet wrong = make(&ball, 2, 1, &report);
  g_assert_cmpfloat(report.coverage, >, 0.98);
  spore_sphere_set_clear(&right);
  spore_sphere_set_clear(&wrong);
  spore_triangle_mesh_clear(&ball);
}

/* Centres lie on the ring, and each radius is that of the tube. */
static void test_torus(void) {
  SporeTriangleMesh torus;
  SporeSpheresReport report;
  shape_torus(&torus, 0.06, 0.02, 64, 32);
  SporeSphereSet set = make(&torus, 24, 1, &report);
  for (size_t i = 0; i < set.count; i++) {
    const double *s = set.spheres + 4 * i;
    CLOSE(hypot(hypot(s[0], s[1]) - 0.06, s[2]), 0, 0.1 * 0.02);
    CLOSE(s[3], 0.02, 0.1 * 0.02);
  }
  g_assert_cmpfloat(report.coverage, >, 0.95);
  g_assert_cmpfloat(report.outside, <, 0.04);
  spore_sphere_set_clear(&set);
  spore_triangle_mesh_clear(&torus);
}

static void test_capsule(void) {
  SporeTriangleMesh capsule;
  SporeSpheresReport report;
  shape_capsule(&capsule, 0.02, 0.05, 12);
  SporeSphereSet set = make(&capsule, 12, 1, &report);
  for (size_t i = 0; i < set.count; i++) CLOSE(hypot(set.spheres[4 * i], set.spheres[4 * i + 1]), 0, 0.05 * 0.02);
  g_assert_cmpfloat(report.coverage, >, 0.97);
  g_assert_cmpfloat(report.outside, <, 0.03);
  spore_sphere_set_clear(&set);
  spore_triangle_mesh_clear(&capsule);
}

static void cube_shell(SporeTriangleMesh *shell, double half, double wall) {
  const double o = half, i = half - wall;
  SporeTriangleMesh inner;
  shape_box(shell, (double[3]){-o, -o, -o}, (double[3]){o, o, o}, 8);
  shape_box(&inner, (double[3]){-i, -i, -i}, (double[3]){i, i, i}, 8);
  shape_turn(&inner);
  shape_append(shell, &inner);
  spore_triangle_mesh_clear(&inner);
}

/* The hollow stays hollow. */
static void test_shell(void) {
  SporeTriangleMesh shell;
  SporeSpheresReport report;
  cube_shell(&shell, 0.05, 0.02);
  SporeSphereSet set = make(&shell, 120, 1, &report);
  for (size_t i = 0; i < set.count; i++) {
    const double *s = set.spheres + 4 * i;
    double far = fmax(fabs(s[0]), fmax(fabs(s[1]), fabs(s[2])));
    g_assert_cmpfloat(far, >, 0.03);
    g_assert_cmpfloat(far, <, 0.05);
  }
  g_assert_cmpfloat(report.coverage, >, 0.93);
  g_assert_cmpfloat(report.outside, <, 0.08);
  spore_sphere_set_clear(&set);
  spore_triangle_mesh_clear(&shell);
}

static void test_two_components(void) {
  SporeTriangleMesh a, b;
  SporeSpheresReport report;
  shape_ball(&a, 0.04, 16);
  shape_ball(&b, 0.02, 16);
  shape_move(&b, 0.2, 0, 0);
  shape_append(&a, &b);
  SporeSphereSet set = make(&a, 2, 1, &report);
  const double *large = set.spheres[3] > set.spheres[7] ? set.spheres : set.spheres + 4;
  const double *small = large == set.spheres ? set.spheres + 4 : set.spheres;
  CLOSE(large[0], 0, 1e-4);
  CLOSE(large[3], 0.04, 1e-4);
  CLOSE(small[0], 0.2, 1e-4);
  CLOSE(small[3], 0.02, 1e-4);
  spore_sphere_set_clear(&set);
  spore_triangle_mesh_clear(&a);
  spore_triangle_mesh_clear(&b);
}

static void test_seed(void) {
  SporeTriangleMesh torus;
  SporeSpheresReport a, b, c;
  shape_torus(&torus, 0.06, 0.02, 24, 12);
  SporeSphereSet first = make(&torus, 16, 5, &a), again = make(&torus, 16, 5, &b), other = make(&torus, 16, 6, &c);
  a.seconds = b.seconds = 0;
  g_assert_cmpmem(first.spheres, 64 * sizeof(double), again.spheres, 64 * sizeof(double));
  g_assert_cmpmem(&a, sizeof a, &b, sizeof b);
  g_assert_true(memcmp(first.spheres, other.spheres, 64 * sizeof(double)) != 0);
  spore_sphere_set_clear(&first);
  spore_sphere_set_clear(&again);
  spore_sphere_set_clear(&other);
  spore_triangle_mesh_clear(&torus);
}

/* A box about (1, 2, 3) is its own image in three planes: so is the set, to rounding; in as many as go with its number.
 */
static void test_symmetry(void) {
  const size_t counts[] = {1, 7, 30, 61, 64};
  SporeTriangleMesh box;
  SporeSpheresReport report;
  shape_box(&box, (double[3]){0.95, 1.97, 2.98}, (double[3]){1.05, 2.03, 3.02}, 4);
  for (size_t n = 0; n < G_N_ELEMENTS(counts); n++) {
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
  shape_box(&box, (double[3]){-0.05, -0.03, -0.02}, (double[3]){0.05, 0.03, 0.02}, 2);
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

/* Eight times as many are asked for in one half of a long bar: eight of nine lie there, about, and the half is nearer.
 */
static void test_region(void) {
  SporeTriangleMesh bar;
  SporeSpheresReport report;
  SporeSpheresRegion region = {{0, 0, 0.1}, 0.1, 8};
  SporeSpheresOptions options = {.count = 60, .seed = 1, .regions = &region, .region_count = 1};
  SporeSphereSet set;
  shape_box(&bar, (double[3]){-0.01, -0.01, -0.1}, (double[3]){0.01, 0.01, 0.1}, 4);
  g_assert_true(spore_spheres_from_mesh(&bar, &options, &set, &report, NULL, NULL));
  g_test_message("%zu of 60 spheres in the region, coverage %.3f", count_above(&set), report.coverage);
  g_assert_cmpuint(count_above(&set), >, 45);
  g_assert_cmpuint(count_above(&set), <, 58);
  spore_sphere_set_clear(&set);
  region.factor = 0;
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
  SporeSpheresOptions options = {.aims.distance = 0.001, .seed = 1};
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
  shape_torus(&torus, 0.06, 0.02, 24, 12);
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
  SporeSpheresOptions options = {.aims.distance = 0.004, .seed = 1};
  shape_torus(&torus, 0.06, 0.02, 24, 12);
  g_assert_true(spore_spheres_from_mesh(&torus, &options, &set, &report, NULL, NULL));
  g_assert_cmpfloat(report.distance_mean, <=, 0.004);
  SporeSphereSet less = make(&torus, set.count * 9 / 10, 1, &fewer);
  g_assert_cmpfloat(fewer.distance_mean, >, 0.004);
  spore_sphere_set_clear(&less);
  spore_sphere_set_clear(&set);
  spore_triangle_mesh_clear(&torus);
}

/* Of several aims all are reached, and it is told which takes the spheres. */
static void test_aims(void) {
  SporeTriangleMesh torus;
  SporeSpheresReport report, fewer;
  SporeSphereSet set;
  SporeSpheresOptions options = {.aims = {.coverage = 0.95, .outside = 0.07, .depth_error = 0.5}, .seed = 1};
  double excess;
  shape_torus(&torus, 0.06, 0.02, 24, 12);
  g_assert_true(spore_spheres_from_mesh(&torus, &options, &set, &report, NULL, NULL));
  g_assert_cmpfloat(report.coverage, >=, 0.95);
  g_assert_cmpfloat(report.outside, <=, 0.07);
  g_assert_cmpstr(spore_spheres_hardest_aim(&options.aims, &report, &excess), !=, "depth_error");
  CLOSE(excess, fmax((1 - report.coverage) / 0.05, report.outside / 0.07), 1e-12);
  SporeSphereSet less = make(&torus, set.count * 4 / 5, 1, &fewer);
  g_assert_true(fewer.coverage < 0.95 || fewer.outside > 0.07);
  spore_sphere_set_clear(&less);
  spore_sphere_set_clear(&set);
  g_assert_null(spore_spheres_hardest_aim(&(SporeSpheresAims){0}, &report, NULL));
  spore_triangle_mesh_clear(&torus);
}

/* Four triangles, with few and with far more spheres than they ask for. */
static void test_tetrahedron(void) {
  double vertices[] = {0, 0, 0, 0.1, 0, 0, 0, 0.1, 0, 0, 0, 0.1};
  uint32_t triangles[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  SporeTriangleMesh mesh = {4, 4, vertices, triangles};
  SporeSpheresReport one, many;
  SporeSphereSet a = make(&mesh, 1, 1, &one), b = make(&mesh, 200, 1, &many);
  g_assert_cmpfloat(many.coverage, >, 0.97);
  g_assert_cmpfloat(many.distance_mean, <, 0.3 * one.distance_mean);
  spore_sphere_set_clear(&a);
  spore_sphere_set_clear(&b);
}

static void refuse(const SporeTriangleMesh *mesh, SporeSpheresOptions options, const char *expected) {
  SporeSphereSet set;
  SporeSpheresReport report;
  SporeError error = SPORE_ERROR_INIT;
  g_assert_false(spore_spheres_from_mesh(mesh, &options, &set, &report, NULL, &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
  g_assert_nonnull(strstr(error.message, expected));
  g_assert_null(set.spheres);
}

static void test_refused(void) {
  double vertices[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  uint32_t sheet[] = {0, 1, 2, 1, 3, 2}, doubled[] = {0, 1, 2, 0, 2, 1}, wrong[] = {0, 1, 9};
  SporeSpheresOptions ten = {.count = 10};
  refuse(&(SporeTriangleMesh){4, 2, vertices, sheet}, ten, "encloses no volume");
  refuse(&(SporeTriangleMesh){4, 2, vertices, doubled}, ten, "encloses no volume");
  refuse(&(SporeTriangleMesh){4, 1, vertices, wrong}, ten, "triangle 0 uses vertex 9");
  refuse(&(SporeTriangleMesh){4, 2, vertices, sheet}, (SporeSpheresOptions){.count = 5001}, "too many");
  refuse(&(SporeTriangleMesh){4, 2, vertices, sheet}, (SporeSpheresOptions){0}, "tolerance");
  refuse(&(SporeTriangleMesh){4, 2, vertices, sheet}, (SporeSpheresOptions){.aims.distance = NAN}, "tolerance");
  refuse(&(SporeTriangleMesh){4, 2, vertices, sheet}, (SporeSpheresOptions){.aims.coverage = 1}, "coverage 1,");
  refuse(&(SporeTriangleMesh){4, 2, vertices, sheet}, (SporeSpheresOptions){.aims.outside = -1}, "outside -1,");
}

/* A ball with a hole in it still has an inside. */
static void test_open(void) {
  SporeTriangleMesh ball;
  SporeSpheresReport report;
  shape_ball(&ball, 0.05, 16);
  ball.triangle_count -= 40;
  SporeSphereSet set = make(&ball, 1, 1, &report);
  CLOSE(set.spheres[3], 0.05, 0.05 * 0.05);
  spore_sphere_set_clear(&set);
  spore_triangle_mesh_clear(&ball);
}

/* Concentric with a unit ball, k its radius: coverage min(1, k^3), outside max(0, k^3 - 1), distance |1 - k| over the
 * diagonal 2 sqrt 3, depth error |1 - k| for k > 1 and (1 - k) k^3 + (1 - k^3) - 3 (1 - k^4) / 4 for k < 1. */
static void test_measure_concentric(void) {
  SporeTriangleMesh ball;
  shape_ball(&ball, 1, 32);
  const double radii[] = {0.6, 0.9, 1.2};
  for (int i = 0; i < 3; i++) {
    double k = radii[i], cube = k * k * k, sphere[4] = {0, 0, 0, k},
           less = (1 - k) * cube + (1 - cube) - 0.75 * (1 - k * cube);
    SporeSphereSet set = {1, sphere};
    SporeSpheresReport report;
    g_assert_true(spore_spheres_measure(&ball, &set, &report, NULL));
    CLOSE(report.coverage, fmin(1, cube), 0.006);
    CLOSE(report.outside, fmax(0, cube - 1), 0.006);
    CLOSE(report.distance_mean, fabs(1 - k) / (2 * sqrt(3)), 3e-4);
    CLOSE(report.distance_max, fabs(1 - k) / (2 * sqrt(3)), 1e-3);
    CLOSE(report.depth_error, k > 1 ? k - 1 : less, 0.006);
  }
  spore_triangle_mesh_clear(&ball);
}

/* Two balls of radius 1/2 a distance 1/2 apart in a unit ball: the lens that they share counts once. */
static void test_measure_overlap(void) {
  SporeTriangleMesh ball;
  SporeSpheresReport report;
  shape_ball(&ball, 1, 32);
  double spheres[] = {-0.25, 0, 0, 0.5, 0.25, 0, 0, 0.5}, r = 0.5, d = 0.5;
  double lens = (4 * r + d) * (2 * r - d) * (2 * r - d) / 16; /* over 4 pi / 3 */
  SporeSphereSet set = {2, spheres};
  g_assert_true(spore_spheres_measure(&ball, &set, &report, NULL));
  CLOSE(report.coverage, 2 * r * r * r - lens, 0.008);
  CLOSE(report.outside, 0, 1e-12);
  for (int i = 0; i < 8; i += 4) spheres[i] += 10; /* far away: all outside */
  g_assert_true(spore_spheres_measure(&ball, &set, &report, NULL));
  g_assert_cmpfloat(report.coverage, ==, 0);
  CLOSE(report.outside, 2 * r * r * r - lens, 0.008);
  spore_triangle_mesh_clear(&ball);
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
  spore_sphere_set_clear(&set);
  mesh.tetrahedra[3] = 1000;
  SporeError error = SPORE_ERROR_INIT;
  g_assert_false(spore_spheres_from_tetrahedra(&mesh, &options, &set, &report, NULL, &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
  spore_tetrahedral_mesh_clear(&mesh);
}

typedef struct Stop {
  int calls, stop_at;
  double last;
} Stop;

static bool report_progress(void *data, double fraction, const char *stage) {
  Stop *stop = data;
  g_assert_cmpfloat(fraction, >=, stop->last - 1e-12); /* never goes back */
  g_assert_cmpfloat(fraction, <=, 1);
  g_assert_nonnull(stage);
  stop->last = fraction;
  return ++stop->calls != stop->stop_at;
}

static void test_cancel(void) {
  SporeTriangleMesh torus;
  SporeSpheresOptions options = {.count = 3, .seed = 1};
  shape_torus(&torus, 0.06, 0.02, 12, 8);
  Stop whole = {0};
  SporeProgress progress = {report_progress, &whole};
  SporeSphereSet set;
  SporeSpheresReport report;
  g_assert_true(spore_spheres_from_mesh(&torus, &options, &set, &report, &progress, NULL));
  spore_sphere_set_clear(&set);
  g_assert_cmpint(whole.calls, >, 30);
  for (int k = 0; k < 5; k++) {
    Stop stop = {.stop_at = 1 + (whole.calls - 1) * k / 4};
    SporeError error = SPORE_ERROR_INIT;
    progress.data = &stop;
    g_assert_false(spore_spheres_from_mesh(&torus, &options, &set, &report, &progress, &error));
    g_assert_cmpint(error.code, ==, SPORE_ERROR_CANCELLED);
    g_assert_cmpint(stop.calls, ==, stop.stop_at);
    g_assert_null(set.spheres);
  }
  spore_triangle_mesh_clear(&torus);
}

/* Samples of thousands of spheres take seconds to draw, so that is asked about on the way, too. */
static void test_cancel_samples(void) {
  SporeTriangleMesh torus;
  SporeSolid solid;
  SporeSamples samples;
  shape_torus(&torus, 0.06, 0.02, 12, 8);
  g_assert_true(spore_solid_create(&solid, &torus, NULL));
  Stop whole = {0};
  SporeProgress progress = {report_progress, &whole};
  SporeProgressPart part = {&progress, 0, 1};
  SporeRandom random = {1};
  g_assert_true(spore_samples_create(&samples, &solid, 3000, &random, &part, NULL));
  g_assert_cmpint(whole.calls, >, (int)(samples.points.count / 4096));
  spore_samples_clear(&samples);
  for (int k = 0; k < 5; k++) {
    Stop stop = {.stop_at = 1 + (whole.calls - 1) * k / 4};
    SporeError error = SPORE_ERROR_INIT;
    progress.data = &stop;
    g_assert_false(spore_samples_create(&samples, &solid, 3000, &random, &part, &error));
    g_assert_cmpint(error.code, ==, SPORE_ERROR_CANCELLED);
    g_assert_cmpint(stop.calls, ==, stop.stop_at);
  }
  spore_solid_clear(&solid);
  spore_triangle_mesh_clear(&torus);
}

/* Cells of a ball: inside they add up to its volume, none is farther out than the band, and depths are the ball's. */
static void test_graded(void) {
  SporeTriangleMesh ball;
  SporeSolid solid;
  SporeSamples samples;
  SporeRandom random = {1};
  SporeProgressPart part = {NULL, 0, 1};
  shape_ball(&ball, 0.05, 48);
  g_assert_true(spore_solid_create(&solid, &ball, NULL));
  g_assert_true(spore_samples_create_graded(&samples, &solid, 8, 0.025, &random, &part, NULL));
  double inside = 0;
  for (size_t i = 0; i < samples.points.count; i++) {
    SporeVec3 p = spore_vec3(samples.points.x[i], samples.points.y[i], samples.points.z[i]);
    CLOSE(samples.depth[i], 0.05 - spore_vec3_length(p), 3e-4);
    g_assert_cmpfloat(samples.depth[i], >, -2 * samples.band);
    if (samples.depth[i] >= 0) inside += samples.weight[i];
  }
  CLOSE(inside / solid.volume, 1, 0.005);
  spore_samples_clear(&samples);
  spore_solid_clear(&solid);
  spore_triangle_mesh_clear(&ball);
}

/* One ball that is too small and off the middle of a ball comes to be that. */
static void test_polish(void) {
  SporeTriangleMesh mesh;
  SporeSolid solid;
  SporeBalls balls;
  SporeProgressPart part = {NULL, 0, 1};
  shape_ball(&mesh, 0.05, 48);
  g_assert_true(spore_solid_create(&solid, &mesh, NULL));
  g_assert_true(spore_balls_create(&balls, 1));
  spore_balls_set(&balls, 0, spore_vec3(0.004, -0.003, 0.002), 0.045);
  g_assert_true(spore_spheres_polish(&solid, &balls, NULL, 0.05, 1, &part, NULL));
  g_assert_cmpfloat(spore_vec3_length(spore_balls_centre(&balls, 0)), <, 2e-4);
  CLOSE(balls.r[0], 0.05, 2e-4);
  spore_balls_clear(&balls);
  spore_solid_clear(&solid);
  spore_triangle_mesh_clear(&mesh);
}

/* Who looks on sees whole sets on the way, and the set that comes out is the same. */
typedef struct {
  size_t looks, wanted;
} Look;

static void look_at(void *data, const double *spheres, size_t count) {
  Look *look = data;
  g_assert_cmpuint(count, ==, look->wanted);
  for (size_t i = 0; i < count; i++) g_assert_true(spheres[4 * i + 3] > 0 && isfinite(spheres[4 * i]));
  look->looks++;
}

static void test_look(void) {
  SporeTriangleMesh torus;
  SporeSpheresReport report;
  SporeSphereSet seen;
  SporeSpheresOptions options = {.count = 12, .seed = 1};
  shape_torus(&torus, 0.06, 0.02, 32, 16);
  SporeSphereSet alone = make(&torus, 12, 1, &report);
  Look look = {.wanted = 12};
  SporeProgress progress = {.data = &look, .show = look_at};
  g_assert_true(spore_spheres_from_mesh(&torus, &options, &seen, &report, &progress, NULL));
  g_assert_cmpuint(look.looks, >, 5);
  g_assert_cmpmem(seen.spheres, 12 * 4 * sizeof(double), alone.spheres, 12 * 4 * sizeof(double));
  spore_sphere_set_clear(&seen);
  spore_sphere_set_clear(&alone);
  spore_triangle_mesh_clear(&torus);
}

/* A ball in a cube's middle and one on its face: half of that is outside, and it is as deep as wrong by its radius. The
 * cube's corners are as far from the first as its diagonal says. */
static void test_quality(void) {
  SporeTriangleMesh cube;
  double numbers[8] = {0, 0, 0, 0.5, 0.5, 0, 0, 0.1};
  SporeSphereSet set = {.count = 2, .spheres = numbers};
  SporeSpheresQuality quality;
  shape_box(&cube, (double[3]){-0.5, -0.5, -0.5}, (double[3]){0.5, 0.5, 0.5}, 1);
  g_assert_true(spore_spheres_quality(&cube, &set, &quality, NULL, NULL));
  CLOSE(quality.outside[0], 0, 0.02);
  CLOSE(quality.outside[1], 0.5, 0.04);
  CLOSE(quality.depth_error[0], 0, 1e-12);
  CLOSE(quality.depth_error[1], 0.1, 1e-12);
  double area = 0;
  for (size_t i = 0; i < quality.vertex_count; i++) {
    CLOSE(quality.distance[i], sqrt(0.75) - 0.5, 1e-7); /* the field is of single precision */
    area += quality.area[i];
  }
  CLOSE(area, 1, 1e-12);
  spore_spheres_quality_clear(&quality);
  spore_triangle_mesh_clear(&cube);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/generate/spheres/ball", test_ball);
  g_test_add_func("/generate/spheres/inside-out", test_inside_out);
  g_test_add_func("/generate/spheres/torus", test_torus);
  g_test_add_func("/generate/spheres/capsule", test_capsule);
  g_test_add_func("/generate/spheres/shell", test_shell);
  g_test_add_func("/generate/spheres/two-components", test_two_components);
  g_test_add_func("/generate/spheres/seed", test_seed);
  g_test_add_func("/generate/spheres/symmetry", test_symmetry);
  g_test_add_func("/generate/spheres/symmetry-found", test_symmetry_found);
  g_test_add_func("/generate/spheres/region", test_region);
  g_test_add_func("/generate/spheres/curve-straight", test_curve_straight);
  g_test_add_func("/generate/spheres/curve-bent", test_curve_bent);
  g_test_add_func("/generate/spheres/sheet", test_sheet);
  g_test_add_func("/generate/spheres/enough", test_enough);
  g_test_add_func("/generate/spheres/series", test_series);
  g_test_add_func("/generate/spheres/tolerance", test_tolerance);
  g_test_add_func("/generate/spheres/aims", test_aims);
  g_test_add_func("/generate/spheres/tetrahedron", test_tetrahedron);
  g_test_add_func("/generate/spheres/refused", test_refused);
  g_test_add_func("/generate/spheres/open", test_open);
  g_test_add_func("/generate/spheres/measure-concentric", test_measure_concentric);
  g_test_add_func("/generate/spheres/measure-overlap", test_measure_overlap);
  g_test_add_func("/generate/spheres/tetrahedra", test_tetrahedra);
  g_test_add_func("/generate/spheres/graded", test_graded);
  g_test_add_func("/generate/spheres/polish", test_polish);
  g_test_add_func("/generate/spheres/cancel", test_cancel);
  g_test_add_func("/generate/spheres/cancel-samples", test_cancel_samples);
  g_test_add_func("/generate/spheres/look", test_look);
  g_test_add_func("/generate/spheres/quality", test_quality);
  return g_test_run();
}
