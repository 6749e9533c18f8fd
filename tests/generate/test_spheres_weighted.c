/* Spheres with weights, whose sum is the depth. */
#include <glib.h>
#include <math.h>

#include "core/generate/spheres/spheres.h"
#include "sets.h"
#include "tests/mesh/shapes.h"
#include "tests/sanitized.h"

static SporeSphereSet make(const SporeTriangleMesh *mesh, SporeSpheresMode mode, size_t count,
                           SporeSpheresReport *report) {
  return make_set(mesh, (SporeSpheresOptions){.mode = mode, .count = count, .seed = 1}, report);
}

/* The depth in a ball is that of one sphere of weight 1. */
static void test_ball(void) {
  SporeTriangleMesh ball;
  SporeSpheresReport report;
  shape_ball(&ball, 0.05, 16);
  shape_move(&ball, 1, 2, 3);
  SporeSphereSet set = make(&ball, SPORE_SPHERES_WEIGHTED, 1, &report);
  const double expected[4] = {1, 2, 3, 0.05};
  for (int k = 0; k < 4; k++) g_assert_cmpfloat_with_epsilon(set.spheres[k], expected[k], 5e-3 * 0.05);
  g_assert_cmpfloat_with_epsilon(set.weights[0], 1, 5e-3);
  g_assert_cmpfloat(report.weighted_depth_error, <, 2e-3);
  set.weights[0] = 0.5; /* the mean of half the depth is an eighth of the radius; the deepest sample is not quite it */
  g_assert_true(spore_spheres_measure(&ball, &set, &report, NULL));
  g_assert_cmpfloat(report.weighted_depth_error, >, 0.124);
  g_assert_cmpfloat(report.weighted_depth_error, <, 0.132);
  SporeSpheresQuality quality; /* judged by the sum, not by the sphere */
  g_assert_true(spore_spheres_quality(&ball, &set, &quality, NULL, NULL));
  g_assert_cmpfloat_with_epsilon(quality.depth_error[0], 0.5 * 0.05, 1e-2 * 0.05);
  spore_spheres_quality_clear(&quality);
  g_assert_cmpfloat(spore_spheres_felt_error(&report), ==, report.weighted_depth_error);
  set.spheres[3] += 0.02 * 2 * sqrt(3) * 0.05; /* all places near it are felt */
  g_assert_true(spore_spheres_measure(&ball, &set, &report, NULL));
  g_assert_cmpfloat(report.felt_outside, ==, 1);
  spore_sphere_set_clear(&set);
  spore_triangle_mesh_clear(&ball);
}

/* In a box the sum says more of the depth than the largest of as many balls, and the same input gives the same set. */
static void test_box(void) {
  SporeTriangleMesh box;
  SporeSpheresReport report, balanced;
  shape_box(&box, (double[3]){-0.05, -0.03, -0.02}, (double[3]){0.05, 0.03, 0.02}, 1);
  SporeSphereSet plain = make(&box, SPORE_SPHERES_BALANCED, 16, &balanced);
  SporeSphereSet set = make(&box, SPORE_SPHERES_WEIGHTED, 16, &report),
                 again = make(&box, SPORE_SPHERES_WEIGHTED, 16, &report);
  g_assert_null(plain.weights);
  g_assert_cmpfloat(spore_spheres_felt_error(&balanced), ==, balanced.depth_error);
  g_assert_cmpfloat(balanced.weighted_depth_error, ==, 0);
  g_assert_cmpfloat(report.weighted_depth_error, <, 0.77 * balanced.depth_error);
  g_assert_cmpfloat(report.felt_outside, <, 0.34);
  g_assert_cmpmem(set.spheres, 32 * set.count, again.spheres, 32 * again.count);
  g_assert_cmpmem(set.weights, 8 * set.count, again.weights, 8 * again.count);
  spore_sphere_set_clear(&plain);
  spore_sphere_set_clear(&set);
  spore_sphere_set_clear(&again);
  spore_triangle_mesh_clear(&box);
}

/* A box is its own image in three planes, and so is its set, weights too. */
static void test_symmetry(void) {
  SporeTriangleMesh box;
  SporeSpheresReport report;
  shape_box(&box, (double[3]){0.95, 1.97, 2.98}, (double[3]){1.05, 2.03, 3.02}, 1);
  SporeSphereSet set = make(&box, SPORE_SPHERES_WEIGHTED, 20, &report);
  g_assert_cmpuint(report.mirrors, >=, 2);
  g_assert_cmpuint(count_mirrors(&set, (double[3]){1, 2, 3}), >=, report.mirrors);
  g_assert_cmpfloat(report.weighted_depth_error, <, 0.08);
  spore_sphere_set_clear(&set);
  spore_triangle_mesh_clear(&box);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/generate/spheres-weighted/ball", test_ball);
  if (!tests_sanitized) g_test_add_func("/generate/spheres-weighted/box", test_box); /* as the symmetric one */
  g_test_add_func("/generate/spheres-weighted/symmetry", test_symmetry);
  return g_test_run();
}
