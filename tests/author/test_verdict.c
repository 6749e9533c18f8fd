/* Verdicts on what was generated: each is true of what was measured. */
#include <string.h>

#include "core/author/verdict.h"
#include "core/mesh/mesh.h"

static SporeSpheresReport spheres_of_tube(size_t count) {
  double points[] = {0, 0, 0, 0.01, 0.03, 0.01, 0, 0.012, 0.06, 0, 0, 0.008};
  SporeCurve line = {.count = 3, .points = points};
  SporeTriangleMesh mesh;
  SporeSphereSet set;
  SporeSpheresReport report;
  SporeError error = SPORE_ERROR_INIT;
  SporeSpheresOptions options = {.mode = SPORE_SPHERES_BALANCED, .count = count, .seed = 1};
  g_assert_true(spore_curve_tube(&line, 16, &mesh, NULL));
  g_assert_true(spore_spheres_from_mesh(&mesh, &options, &set, &report, NULL, &error));
  spore_sphere_set_clear(&set);
  spore_triangle_mesh_clear(&mesh);
  return report;
}

/* The number that the verdict on few spheres tells makes good spheres, and half of it does not. */
static void test_number_that_does(void) {
  const size_t few = 5;
  SporeSpheresReport report = spheres_of_tube(few);
  g_autofree char *coarse = spore_spheres_verdict(&(SporeSpheresOptions){.mode = SPORE_SPHERES_BALANCED}, &report, few);
  g_assert_true(g_str_has_prefix(coarse, "Coarse: about ") || g_str_has_prefix(coarse, "Fair: about "));
  size_t wanted = (size_t)g_ascii_strtoull(strpbrk(coarse, "0123456789"), NULL, 10);
  report = spheres_of_tube(wanted);
  g_autofree char *good =
      spore_spheres_verdict(&(SporeSpheresOptions){.mode = SPORE_SPHERES_BALANCED}, &report, wanted);
  g_assert_cmpstr(good, ==, "Good: instruments feel the organ where it is drawn");
  g_test_message("%zu: %s; %zu: %.4f", few, coarse, wanted, spore_spheres_felt_error(&report));
  g_assert_cmpfloat(report.depth_error, <=, SPORE_SPHERES_GOOD);
}

static void test_spheres(void) {
  SporeSpheresReport report = {.coverage = 0.93, .depth_error = 0.06};
  g_autofree char *fair = spore_spheres_verdict(&(SporeSpheresOptions){.mode = SPORE_SPHERES_BALANCED}, &report, 40);
  g_assert_cmpstr(fair, ==, "Fair: about 90 spheres would be good");
  report.depth_error = 0.12;
  g_autofree char *coarse = spore_spheres_verdict(&(SporeSpheresOptions){.mode = SPORE_SPHERES_BALANCED}, &report, 10);
  g_assert_cmpstr(coarse, ==, "Coarse: about 90 spheres would be good");
  report.weighted_depth_error = 0.03; /* of a weighted set that is what is felt */
  g_autofree char *weighted =
      spore_spheres_verdict(&(SporeSpheresOptions){.mode = SPORE_SPHERES_WEIGHTED}, &report, 10);
  g_assert_true(g_str_has_prefix(weighted, "Good"));
  g_autofree char *bounding =
      spore_spheres_verdict(&(SporeSpheresOptions){.mode = SPORE_SPHERES_BOUNDING}, &report, 10);
  g_assert_cmpstr(bounding, ==, "Not proven to hold all of the organ: 7.0 % is outside the spheres");
  report.certified = true;
  g_autofree char *proven = spore_spheres_verdict(&(SporeSpheresOptions){.mode = SPORE_SPHERES_BOUNDING}, &report, 10);
  g_assert_true(g_str_has_prefix(proven, "Good"));
  report = (SporeSpheresReport){.coverage = 0.9}; /* of an open surface no depth is known */
  g_assert_null(spore_spheres_verdict(&(SporeSpheresOptions){.mode = SPORE_SPHERES_BALANCED}, &report, 10));
}

static void test_tetrahedra(void) {
  SporeTetrahedraReport report = {.method = SPORE_TETRAHEDRA_DIRECT, .hausdorff = 0.01};
  report.quality.min_dihedral_deg = 10.8;
  g_autofree char *good = spore_tetrahedra_verdict(&report);
  g_assert_true(g_str_has_prefix(good, "Good"));
  report.hausdorff = 0.03;
  g_autofree char *coarse = spore_tetrahedra_verdict(&report);
  g_assert_true(g_str_has_prefix(coarse, "Coarse"));
  report.quality.min_dihedral_deg = 4;
  g_autofree char *thin = spore_tetrahedra_verdict(&report);
  g_assert_true(g_str_has_prefix(thin, "Thin cells") && strstr(thin, "voxels"));
  report.method = SPORE_TETRAHEDRA_VOXELS; /* what is in use is no remedy */
  g_autofree char *other = spore_tetrahedra_verdict(&report);
  g_assert_true(g_str_has_prefix(other, "Thin cells") && !strstr(other, "voxels"));
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/verdict/number-that-does", test_number_that_does);
  g_test_add_func("/verdict/spheres", test_spheres);
  g_test_add_func("/verdict/tetrahedra", test_tetrahedra);
  return g_test_run();
}
