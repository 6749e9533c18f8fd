/* Spheres that cover all of a solid: proven without sampling. */
#include <glib.h>
#include <math.h>

#include "core/generate/spheres/bounding.h"
#include "sets.h"
#include "tests/mesh/shapes.h"
#include "tests/sanitized.h"

static SporeSphereSet make(const SporeTriangleMesh *mesh, size_t count, SporeSpheresReport *report) {
  return make_set(mesh, (SporeSpheresOptions){.mode = SPORE_SPHERES_BOUNDING, .count = count, .seed = 1}, report);
}

/* The smallest ball around a polyhedron that is a ball but for its facets. */
static void test_ball(void) {
  SporeTriangleMesh ball;
  SporeSpheresReport report;
  shape_ball(&ball, 0.05, 8);
  shape_move(&ball, 1, 2, 3);
  SporeSphereSet set = make(&ball, 1, &report);
  const double expected[4] = {1, 2, 3, 0.05};
  for (int k = 0; k < 4; k++) g_assert_cmpfloat_with_epsilon(set.spheres[k], expected[k], 1e-2 * 0.05);
  g_assert_cmpfloat(set.spheres[3], >=, 0.05 * (1 - 1e-9));
  g_assert_true(report.certified);
  g_assert_cmpfloat(report.outside, <, 0.03);
  set.spheres[3] *= 0.999; /* a corner stands out */
  g_assert_true(spore_spheres_measure(&ball, &set, &report, NULL));
  g_assert_false(report.certified);
  spore_sphere_set_clear(&set);
  spore_triangle_mesh_clear(&ball);
}

/* Proven to cover, and no longer when one ball shrinks; the same again where `again` is not NULL. */
static void check(SporeTriangleMesh *mesh, size_t count, double outside, const SporeSphereSet *again) {
  SporeSpheresReport report;
  SporeSphereSet set = make(mesh, count, &report);
  if (again) g_assert_cmpmem(set.spheres, 32 * set.count, again->spheres, 32 * again->count);
  g_assert_true(report.certified);
  g_assert_cmpfloat(report.coverage, ==, 1);
  g_assert_cmpfloat(report.outside, <, outside);
  set.spheres[3] *= 0.95;
  g_assert_true(spore_spheres_measure(mesh, &set, &report, NULL));
  g_assert_false(report.certified);
  spore_sphere_set_clear(&set);
  spore_triangle_mesh_clear(mesh);
}

/* n balls of radius R about the ring hold a tube of radius a where R^2 = a^2 + (half the way between them)^2, about:
 * 12 balls, 0.06 / 0.02: R = 1.27 a. */
static void test_torus(void) {
  SporeTriangleMesh torus;
  SporeSpheresReport report;
  shape_torus(&torus, 0.06, 0.02, 24, 12);
  SporeSphereSet again = make(&torus, 12, &report);
  check(&torus, 12, 0.6, &again);
  spore_sphere_set_clear(&again);
}

/* So many that the search is a shorter one, which still covers: a tenth of the volume outside, a sixth of what 12
 * leave. */
static void test_many(void) {
  SporeTriangleMesh torus;
  shape_torus(&torus, 0.06, 0.02, 24, 12);
  check(&torus, 260, 0.1, NULL);
}

static void test_capsule_chain(void) {
  SporeTriangleMesh chain, next;
  shape_capsule(&chain, 0.02, 0.05, 4);
  for (int i = 1; i < 3; i++) {
    shape_capsule(&next, 0.02, 0.05, 4);
    shape_move(&next, 0, 0, 0.2 * i);
    shape_append(&chain, &next);
    spore_triangle_mesh_clear(&next);
  }
  check(&chain, 12, 0.6, NULL);
}

static void test_shell(void) {
  SporeTriangleMesh shell, inner;
  const double o = 0.05, i = 0.03;
  shape_box(&shell, (double[3]){-o, -o, -o}, (double[3]){o, o, o}, 2);
  shape_box(&inner, (double[3]){-i, -i, -i}, (double[3]){i, i, i}, 2);
  shape_turn(&inner);
  shape_append(&shell, &inner);
  spore_triangle_mesh_clear(&inner);
  check(&shell, 26, 1, NULL);
}

static void set_ball(SporeBalls *balls, size_t i, double x, double y, double z, double r) {
  balls->x[i] = x, balls->y[i] = y, balls->z[i] = z, balls->r[i] = r;
}

/* 26 balls around the middle of a cube cover its surface; in the middle they leave a hollow, or do not. */
static void test_hollow(void) {
  SporeTriangleMesh box;
  SporeSolid solid;
  SporeBalls balls;
  shape_box(&box, (double[3]){-1, -1, -1}, (double[3]){1, 1, 1}, 2);
  g_assert_true(spore_solid_create(&solid, &box, NULL));
  g_assert_true(spore_balls_create(&balls, 26));
  for (int i = 0, n = 0; i < 27; i++)
    if (i != 13) set_ball(&balls, (size_t)n++, i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1, 0.9);
  g_assert_false(spore_balls_cover(&solid, &balls)); /* of radius 0.1 */
  g_assert_true(spore_balls_grow_to_cover(&solid, &balls));
  g_assert_true(spore_balls_cover(&solid, &balls));
  double largest = 0;
  for (size_t i = 0; i < 26; i++) largest = fmax(largest, balls.r[i]);
  g_assert_cmpfloat(largest, >, 1);    /* reaches the far corners of the hollow, */
  g_assert_cmpfloat(largest, <, 1.35); /* a ball at the middle of a face: 1 + sqrt(2) 0.1 at most, about */
  for (size_t i = 0; i < 26; i++) balls.r[i] = 1.0001;
  g_assert_true(spore_balls_cover(&solid, &balls));
  spore_balls_clear(&balls);
  spore_solid_clear(&solid);
  spore_triangle_mesh_clear(&box);
}

/* A box is its own image in three planes, and so is its set. */
static void test_symmetry(void) {
  SporeTriangleMesh box;
  SporeSpheresReport report;
  shape_box(&box, (double[3]){0.95, 1.97, 2.98}, (double[3]){1.05, 2.03, 3.02}, 1);
  SporeSphereSet set = make(&box, 20, &report);
  g_assert_true(report.certified);
  g_assert_cmpuint(report.mirrors, >=, 2);
  g_assert_cmpuint(count_mirrors(&set, (double[3]){1, 2, 3}), >=, report.mirrors);
  spore_sphere_set_clear(&set);
  spore_triangle_mesh_clear(&box);
}

/* Of an open mesh nothing is proven. */
static void test_open(void) {
  SporeTriangleMesh ball;
  SporeSpheresReport report;
  shape_ball(&ball, 0.05, 5);
  ball.triangle_count -= 4;
  SporeSphereSet set = make(&ball, 2, &report);
  g_assert_cmpfloat(report.coverage, >, 0.9996);
  g_assert_false(report.certified);
  spore_sphere_set_clear(&set);
  spore_triangle_mesh_clear(&ball);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/generate/spheres-bounding/ball", test_ball);
  g_test_add_func("/generate/spheres-bounding/torus", test_torus);
  g_test_add_func("/generate/spheres-bounding/many", test_many);
  if (!tests_sanitized) g_test_add_func("/generate/spheres-bounding/capsule-chain", test_capsule_chain);
  g_test_add_func("/generate/spheres-bounding/shell", test_shell);
  g_test_add_func("/generate/spheres-bounding/hollow", test_hollow);
  g_test_add_func("/generate/spheres-bounding/symmetry", test_symmetry);
  g_test_add_func("/generate/spheres-bounding/open", test_open);
  return g_test_run();
}
