#include "sets.h"

#include <glib.h>

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
