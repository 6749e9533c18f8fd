/* What is said of links and lines that give is what a load does to them: nothing without one, and by closed solutions
 * under their weight. */
#include <math.h>

#include "core/measure/stretch.h"
#include "tests/stability/rig.h"

#define WEIGHT 9.81 /* N */
#define STIFFNESS 1e4
#define LENGTH 0.5 /* m, of the line */
#define RADIUS 0.002
#define YOUNG 1e6

/* A ball of 1 kg that hangs by one link from the scene, at rest. */
static double gap_of(const SporeLinkType *kind, double gravity) {
  Rig *rig = rig_new();
  SporeTriangleMesh cube;
  shape_box(&cube, spore_vec3(0, 0, 0), spore_vec3(0.1, 0.1, 0.1));
  rig->description.gravity = spore_vec3(0, -gravity, 0);
  rig_passive(rig, "weight", rig_surface_model(&spore_rigid_body, &cube, "mass", 1.0, NULL), NULL);
  if (kind) {
    SporeLinkDescription *link = rig_link(rig, "link", kind, 0, SPORE_NO_BODY, spore_vec3(0, 0, 0));
    link->stiffness = STIFFNESS;
  } else {
    rig_pin(rig, 0, spore_vec3(0, 0, 0), 1);
  }
  SporeWorld *world = rig_build(rig);
  rig_run(world, 2000);
  double gap = spore_stretch_gap(world);
  rig_free(rig);
  return gap;
}

static void test_gap(void) {
  g_assert_cmpfloat_with_epsilon(gap_of(&spore_link_ball, WEIGHT), WEIGHT / STIFFNESS, 1e-5);
  g_assert_cmpfloat(gap_of(&spore_link_ball, 0), ==, 0);
  g_assert_cmpfloat(gap_of(&spore_link_spring, WEIGHT), ==, 0); /* stretches because it is to */
  g_assert_true(isnan(gap_of(NULL, WEIGHT)));
}

/* A line that hangs from its first point, settled. Its first piece is stretched by its weight over E A. */
static double stretch_of(double gravity, double density) {
  Rig *rig = rig_new();
  SporeCurve curve;
  g_assert_true(spore_curve_allocate(&curve, 21, NULL));
  for (size_t i = 0; i < curve.count; i++) {
    spore_vec3_store(curve.points + 4 * i, spore_vec3(0, -LENGTH * (double)i / 20, 0));
    curve.points[4 * i + 3] = RADIUS;
  }
  rig->description.gravity = spore_vec3(0, -gravity, 0);
  rig->description.solver.tolerance = 1e-9;
  rig_passive(
      rig, "line",
      rig_curve_model(&spore_spline_1d, &curve, "young_modulus", YOUNG, "density", density, "damping", 0.1, NULL),
      NULL);
  rig_pin(rig, 0, spore_vec3(0, 0, 0), 1e-4);
  SporeWorld *world = rig_build(rig);
  SporeStretch stretch;
  g_assert_true(spore_stretch_create(&stretch, world, NULL));
  rig_run(world, 2000);
  double found = spore_stretch_of_lines(&stretch, world, spore_world_snapshot_acquire(world));
  spore_stretch_clear(&stretch);
  rig_free(rig);
  return found;
}

static void test_line(void) {
  double density = 5e4, pieces = SPORE_STRETCH_PIECES, hanging = LENGTH * (1 - 0.5 / pieces);
  double expected = density * WEIGHT * hanging / YOUNG; /* in the middle of the first piece */
  g_test_message("stretch %g, expected %g", stretch_of(WEIGHT, density), expected);
  g_assert_cmpfloat_with_epsilon(stretch_of(WEIGHT, density) / expected, 1, 0.02);
  g_assert_cmpfloat(stretch_of(0, density), <, 1e-12);
}

static void test_none(void) {
  Rig *rig = rig_new();
  SporeTriangleMesh cube;
  shape_box(&cube, spore_vec3(0, 0, 0), spore_vec3(0.1, 0.1, 0.1));
  rig_passive(rig, "weight", rig_surface_model(&spore_rigid_body, &cube, "mass", 1.0, NULL), NULL);
  SporeWorld *world = rig_build(rig);
  SporeStretch stretch;
  g_assert_true(spore_stretch_create(&stretch, world, NULL));
  g_assert_true(isnan(spore_stretch_of_lines(&stretch, world, spore_world_snapshot_acquire(world))));
  spore_stretch_clear(&stretch);
  rig_free(rig);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/stretch/gap", test_gap);
  g_test_add_func("/stretch/line", test_line);
  g_test_add_func("/stretch/none", test_none);
  return g_test_run();
}
