/* What sphere sets are measured by and made from; what is cancelled leaves nothing behind. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/spheres/private.h"
#include "core/generate/spheres/spheres.h"
#include "sets.h"
#include "tests/mesh/shapes.h"

#define CLOSE(a, b, tolerance) g_assert_cmpfloat_with_epsilon(a, b, tolerance)

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
  shape_ball(&ball, 1, 16);
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
  shape_torus(&torus, 0.06, 0.02, 8, 6);
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
  shape_torus(&torus, 0.06, 0.02, 8, 6);
  g_assert_true(spore_solid_create(&solid, &torus, NULL));
  Stop whole = {0};
  SporeProgress progress = {report_progress, &whole};
  SporeProgressPart part = {&progress, 0, 1};
  SporeRandom random = {1};
  g_assert_true(spore_samples_create(&samples, &solid, 1000, &random, &part, NULL));
  g_assert_cmpint(whole.calls, >, (int)(samples.points.count / 4096));
  spore_samples_clear(&samples);
  for (int k = 0; k < 5; k++) {
    Stop stop = {.stop_at = 1 + (whole.calls - 1) * k / 4};
    SporeError error = SPORE_ERROR_INIT;
    progress.data = &stop;
    g_assert_false(spore_samples_create(&samples, &solid, 1000, &random, &part, &error));
    g_assert_cmpint(error.code, ==, SPORE_ERROR_CANCELLED);
    g_assert_cmpint(stop.calls, ==, stop.stop_at);
  }
  spore_solid_clear(&solid);
  spore_triangle_mesh_clear(&torus);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/generate/spheres/measure-concentric", test_measure_concentric);
  g_test_add_func("/generate/spheres/measure-overlap", test_measure_overlap);
  g_test_add_func("/generate/spheres/graded", test_graded);
  g_test_add_func("/generate/spheres/polish", test_polish);
  g_test_add_func("/generate/spheres/quality", test_quality);
  g_test_add_func("/generate/spheres/cancel", test_cancel);
  g_test_add_func("/generate/spheres/cancel-samples", test_cancel_samples);
  return g_test_run();
}
