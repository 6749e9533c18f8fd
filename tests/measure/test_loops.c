/* Loops: how near windings of a line come, against a look at every pair of spheres in every step. */
#include <math.h>
#include <string.h>

#include "core/measure/loops.h"
#include "tests/stability/rig.h"

#define RADIUS 0.004

/* A thread that runs to and fro in planes `gap` apart, `turns` times, each way `way` long. */
static SporeModel *meander(unsigned turns, double way, double gap) {
  enum { ROUND = 10 };
  SporeCurve curve;
  g_assert_true(spore_curve_allocate(&curve, turns * (ROUND + 1) + 1, NULL));
  size_t made = 0;
  for (unsigned turn = 0; turn < turns; turn++)
    for (unsigned i = 0; i <= ROUND; i++, made++) {
      double angle = G_PI * i / ROUND, side = turn % 2 ? -1 : 1;
      SporeVec3 p = spore_vec3(side * (0.5 * way + 0.5 * gap * sin(angle)), gap * (turn + 0.5 - 0.5 * cos(angle)), 0);
      spore_vec3_store(curve.points + 4 * made, p);
    }
  spore_vec3_store(curve.points + 4 * made, spore_vec3(turns % 2 ? -0.5 * way : 0.5 * way, gap * turns, 0));
  for (size_t i = 0; i <= made; i++) curve.points[4 * i + 3] = RADIUS;
  return rig_curve_model(&spore_spline_1d, &curve, "control_points", 20.0 * turns, "young_modulus", 3e3, "damping",
                         0.05, NULL);
}

/* The world of the thread under gravity, over a sphere far below. */
static SporeWorld *fall(Rig *rig, SporeModel *model, double stiffness) {
  SporeSphereSet *set = g_new0(SporeSphereSet, 1);
  g_assert_true(model->type->spheres(model, set, NULL));
  g_ptr_array_add(rig->sets, set);
  SporeBodyDescription *body = rig_passive(rig, "thread", model, set);
  body->contact.self = stiffness > 0;
  body->contact.stiffness = fmax(stiffness, 1);
  rig_unmovable(rig, "floor", rig_sphere(rig, 0.01))->pose.position.y = -1;
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  return rig_build(rig);
}

/* What spore_loops_step measures, of a line whose spheres are a radius apart along it. */
static double nearest_of_all(const SporeSpheres *spheres, size_t start, size_t count) {
  double least = 1;
  for (size_t i = 0; i < count; i++)
    for (size_t j = i + 3; j < count; j++)
      least = fmin(least, spore_vec3_distance(spore_vec3_load(spheres->centre + 3 * (start + i)),
                                              spore_vec3_load(spheres->centre + 3 * (start + j))) /
                              (2 * RADIUS));
  return least;
}

/* Runs the fall of the upper windings on those below, and compares. Returns the steps in which one went through. */
static uint64_t compare(double stiffness, double *least) {
  Rig *rig = rig_new();
  SporeWorld *world = fall(rig, meander(4, 0.1, 0.03), stiffness);
  SporeLoops loops;
  spore_loops_start(&loops, world);
  g_assert_cmpuint(loops.count, ==, 1);
  const SporeLoopsBody *body = &loops.bodies[0];
  uint64_t through = 0;
  *least = 1;
  for (unsigned step = 0; step < 400; step++) {
    spore_world_step(world);
    spore_loops_step(&loops, world);
    double now = nearest_of_all(spore_world_spheres(world), body->start, body->count);
    *least = fmin(*least, now);
    through += now < SPORE_LOOPS_THROUGH;
    g_assert_cmpfloat(fabs(body->least - *least), <, 1e-12);
    g_assert_cmpuint(body->through, ==, through);
  }
  g_assert_false(body->from_start);
  spore_loops_clear(&loops);
  rig_free(rig);
  return through;
}

static void test_against_all_pairs(void) {
  double met, passed;
  uint64_t held = compare(400, &met), through = compare(0, &passed);
  g_test_message("with contacts: nearest %.3f, through in %u steps; without: %.3f, %u steps", met, (unsigned)held,
                 passed, (unsigned)through);
  g_assert_cmpuint(held, ==, 0);
  g_assert_cmpfloat(met, <, 1);
  g_assert_cmpuint(through, >, 0);
}

/* Windings that lie in each other from the start are told apart from those that go through each other later. */
static void test_from_start(void) {
  Rig *rig = rig_new();
  SporeWorld *world = fall(rig, meander(2, 0.1, 0.7 * RADIUS), 400);
  SporeLoops loops;
  spore_loops_start(&loops, world);
  spore_world_step(world);
  spore_loops_step(&loops, world);
  g_assert_true(loops.bodies[0].from_start);
  g_assert_cmpuint(loops.bodies[0].through, ==, 1);
  g_assert_cmpfloat(loops.bodies[0].least_s, ==, 0);
  g_assert_cmpfloat(fabs(loops.bodies[0].least - 0.35), <, 0.01);
  spore_loops_clear(&loops);
  rig_free(rig);
}

/* A body that is no line has no loops, and neither has a line that nothing can touch. */
static void test_none(void) {
  Rig *rig = rig_new();
  rig_passive(rig, "thread", meander(2, 0.1, 0.03), NULL);
  SporeLoops loops;
  spore_loops_start(&loops, rig_build(rig));
  g_assert_cmpuint(loops.count, ==, 0);
  spore_loops_clear(&loops);
  rig_free(rig);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/loops/against-all-pairs", test_against_all_pairs);
  g_test_add_func("/loops/from-start", test_from_start);
  g_test_add_func("/loops/none", test_none);
  return g_test_run();
}
