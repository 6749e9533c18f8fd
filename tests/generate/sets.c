/* What the tests of sphere sets share: a run of the generator, and counts over its result. */
#include "sets.h"

#include <glib.h>
#include <math.h>
#include <string.h>

SporeSphereSet make_set(const SporeTriangleMesh *mesh, SporeSpheresOptions options, SporeSpheresReport *report) {
  SporeError error = SPORE_ERROR_INIT;
  SporeSphereSet set;
  bool done = spore_spheres_from_mesh(mesh, &options, &set, report, NULL, &error);
  g_assert_cmpstr(error.message, ==, "");
  g_assert_true(done);
  g_assert_cmpuint(set.count, ==, options.count);
  g_assert_true(spore_sphere_set_validate(&set, NULL));
  g_test_message(
      "%zu spheres: coverage %.4f outside %.4f distance %.4f %% depth %.4f, certified %d, weighted depth %.4f, "
      "felt outside %.4f, %.2f s",
      set.count, report->coverage, report->outside, 100 * report->distance_mean, report->depth_error, report->certified,
      report->weighted_depth_error, report->felt_outside, report->seconds);
  return set;
}

bool set_holds(const SporeSphereSet *set, const double sphere[4], const double *weight, double tolerance) {
  for (size_t i = 0; i < set->count; i++) {
    bool same = !weight || fabs(set->weights[i] - *weight) <= tolerance;
    for (int k = 0; k < 4; k++) same &= fabs(set->spheres[4 * i + k] - sphere[k]) <= tolerance;
    if (same) return true;
  }
  return false;
}

size_t count_mirrors(const SporeSphereSet *set, const double middle[3]) {
  size_t mirrors = 0;
  for (int k = 0; k < 3; k++) {
    bool all = true;
    for (size_t i = 0; i < set->count; i++) {
      double image[4];
      memcpy(image, set->spheres + 4 * i, sizeof image);
      image[k] = 2 * middle[k] - image[k];
      all &= set_holds(set, image, set->weights ? set->weights + i : NULL, 1e-12);
    }
    mirrors += all;
  }
  return mirrors;
}
