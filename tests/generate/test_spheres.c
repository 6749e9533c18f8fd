/* Spheres that fill solids: their number, places and radii, what is the same again and what is refused. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "sets.h"
#include "tests/mesh/shapes.h"
#include "tests/sanitized.h"

#define CLOSE(a, b, tolerance) g_assert_cmpfloat_with_epsilon(a, b, tolerance)

static SporeSphereSet make(const SporeTriangleMesh *mesh, size_t count, uint64_t seed, SporeSpheresReport *report) {
  return make_set(mesh, (SporeSpheresOptions){.count = count, .seed = seed}, report);
}

static void test_ball(void) {
  SporeTriangleMesh ball;
  SporeSpheresReport report;
  shape_ball(&ball, 0.05, 20);
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
  shape_ball(&ball, 0.05, 5);
  shape_turn(&ball);
  SporeSphereSet wrong = make(&ball, 2, 1, &report);
  g_assert_cmpfloat(report.coverage, >, 0.98);
  spore_sphere_set_clear(&wrong);
  spore_triangle_mesh_clear(&ball);
}

/* Centres lie on the ring, and each radius is that of the tube. */
static void test_torus(void) {
  SporeTriangleMesh torus;
  SporeSpheresReport report;
  shape_torus(&torus, 0.06, 0.02, 40, 20);
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
  shape_capsule(&capsule, 0.02, 0.05, 8);
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
  shape_box(shell, (double[3]){-o, -o, -o}, (double[3]){o, o, o}, 1);
  shape_box(&inner, (double[3]){-i, -i, -i}, (double[3]){i, i, i}, 1);
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
  shape_ball(&a, 0.04, 14);
  shape_ball(&b, 0.02, 14);
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

/* A ball with a hole in it still has an inside. */
static void test_open(void) {
  SporeTriangleMesh ball;
  SporeSpheresReport report;
  shape_ball(&ball, 0.05, 6);
  ball.triangle_count -= 16;
  SporeSphereSet set = make(&ball, 1, 1, &report);
  CLOSE(set.spheres[3], 0.05, 0.05 * 0.05);
  spore_sphere_set_clear(&set);
  spore_triangle_mesh_clear(&ball);
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

/* A seed gives the same set again, bit by bit, also when somebody looks on: whole sets on the way; another gives
 * another. */
static void test_seed(void) {
  SporeTriangleMesh torus;
  SporeSpheresReport alone, watched, another;
  SporeSphereSet seen;
  SporeSpheresOptions options = {.count = 16, .seed = 5};
  Look look = {.wanted = 16};
  SporeProgress progress = {.data = &look, .show = look_at};
  shape_torus(&torus, 0.06, 0.02, 16, 8);
  SporeSphereSet first = make(&torus, 16, 5, &alone), other = make(&torus, 16, 6, &another);
  g_assert_true(spore_spheres_from_mesh(&torus, &options, &seen, &watched, &progress, NULL));
  g_assert_cmpuint(look.looks, >, 5);
  alone.seconds = watched.seconds = 0;
  g_assert_cmpmem(first.spheres, 64 * sizeof(double), seen.spheres, 64 * sizeof(double));
  g_assert_cmpmem(&alone, sizeof alone, &watched, sizeof watched);
  g_assert_true(memcmp(first.spheres, other.spheres, 64 * sizeof(double)) != 0);
  spore_sphere_set_clear(&first);
  spore_sphere_set_clear(&seen);
  spore_sphere_set_clear(&other);
  spore_triangle_mesh_clear(&torus);
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
  refuse(&(SporeTriangleMesh){4, 2, vertices, sheet}, (SporeSpheresOptions){.targets.distance = NAN}, "tolerance");
  refuse(&(SporeTriangleMesh){4, 2, vertices, sheet}, (SporeSpheresOptions){.targets.coverage = 1}, "coverage 1,");
  refuse(&(SporeTriangleMesh){4, 2, vertices, sheet}, (SporeSpheresOptions){.targets.outside = -1}, "outside -1,");
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/generate/spheres/ball", test_ball);
  g_test_add_func("/generate/spheres/inside-out", test_inside_out);
  g_test_add_func("/generate/spheres/torus", test_torus);
  g_test_add_func("/generate/spheres/capsule", test_capsule);
  g_test_add_func("/generate/spheres/shell", test_shell);
  g_test_add_func("/generate/spheres/two-components", test_two_components);
  if (!tests_sanitized) g_test_add_func("/generate/spheres/tetrahedron", test_tetrahedron);
  g_test_add_func("/generate/spheres/open", test_open);
  g_test_add_func("/generate/spheres/seed", test_seed);
  g_test_add_func("/generate/spheres/refused", test_refused);
  return g_test_run();
}
