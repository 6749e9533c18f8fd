/* A bowel packed from loops that touch or overlap at rest, on its mesentery under gravity, with a probe through it. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/centreline/centreline.h"
#include "core/measure/loops.h"
#include "tests/generate/bowels.h"
#include "tests/stability/rig.h"

#define STEP 0.004
#define STEPS 500
#define PROBE 0.006 /* m: radius of the probe's spheres */

/* The middle line, with the radius that its loops have where they are apart. */
static SporeCurve line_of(double gap) {
  const BowelShape shape = {4, 2, 10, .gap = gap, .waves = 0.3, .sectors = 14};
  SporeTriangleMesh mesh;
  SporeCurve line;
  bowel_create(&shape, &mesh, &line);
  spore_triangle_mesh_clear(&mesh);
  return line;
}

static SporeModel *bowel_along(const SporeCurve *line) {
  SporeCurve root;
  g_assert_true(spore_centreline_root(line, 3, &root, NULL));
  double spans = ceil(spore_curve_length(line) / (2 * BOWEL_RADIUS));
  void *fields = rig_fields(&spore_intestine, "control_points", spans + 3, "wall_thickness", 0.002, NULL);
  SporeModel *model = spore_intestine.create(&(SporeGeometry){.curve = line, .root = &root}, fields, NULL);
  g_assert_nonnull(model);
  spore_free(fields);
  spore_curve_clear(&root);
  return model;
}

/* Where the frame of the mesentery is at rest. */
static SporeVec3 frame_of(const SporeModel *model) {
  const SporeVec3 none = {0, 0, 0};
  double *q = g_new0(double, model->q_count), *v = g_new0(double, 3 * model->block_count);
  model->type->place(model, spore_pose_identity(), none, none, q, v);
  SporeVec3 frame = spore_vec3_load(q + 3 * (model->node_count - 1));
  g_free(q);
  g_free(v);
  return frame;
}

static SporeWorld *build(Rig *rig, SporeModel *model, SporeVec3 from) {
  SporeSphereSet *set = g_new0(SporeSphereSet, 1);
  g_assert_true(model->type->spheres(model, set, NULL));
  g_ptr_array_add(rig->sets, set);
  SporeBodyDescription *bowel = rig_passive(rig, "bowel", model, set);
  bowel->contact =
      (SporeContactFields){.stiffness = 400, .damping = 0.3, .friction = bowel->contact.friction, .self = true};
  rig_pin(rig, 0, frame_of(model), 1e-3);
  double shaft[3 * 8] = {0};
  for (int i = 0; i < 8; i++) shaft[3 * i + 2] = PROBE * i;
  SporeBodyDescription *probe = rig_active(rig, "probe", rig_spheres(rig, shaft, 8, PROBE));
  probe->pose.position = from;
  probe->contact.stiffness = 2000;
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.time_step = STEP;
  return rig_build(rig);
}

static double energy_of_contacts(const SporeWorld *world) { return spore_world_energy(world).contact; }

/* No spheres of the bowel lie in each other at the start, though its loops do, and none is left out of contacts for
 * good: loops stay apart while they hang, and while a probe goes from one side to the other. */
static void run(double gap) {
  SporeCurve line = line_of(gap);
  SporeVec3 low = spore_vec3_load(line.points), high = low;
  for (size_t i = 0; i < line.count; i++) {
    SporeVec3 p = spore_vec3_load(line.points + 4 * i);
    low = spore_vec3(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
    high = spore_vec3(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
  }
  SporeVec3 middle = spore_vec3_scale(0.5, spore_vec3_add(low, high));
  SporeVec3 from = {low.x - 2 * BOWEL_RADIUS - PROBE, middle.y, middle.z};
  double way = high.x - low.x + 4 * BOWEL_RADIUS + 2 * PROBE, length = spore_curve_length(&line);
  RigMover mover = {{&rig_mover_type}, from, {way / (STEP * STEPS), 0, 0}};
  Rig *rig = rig_new();
  SporeWorld *world = build(rig, bowel_along(&line), from);
  spore_world_set_device(world, 1, &mover.base);
  SporeLoops loops;
  spore_loops_start(&loops, world);
  size_t steps = rig_steps(STEPS, 60), newton = 0, linear = 0, contacts = 0, reached = 0;
  g_assert_cmpfloat(energy_of_contacts(world), ==, 0);
  for (size_t i = 0; i < steps; i++) {
    spore_world_step(world);
    spore_loops_step(&loops, world);
    SporeStepCounts counts = spore_world_counts(world);
    newton += counts.newton_iterations, linear += counts.linear_iterations;
    contacts += counts.contacts, reached += counts.contacts > 0;
  }
  const SporeMonitor *monitor = spore_world_monitor(world);
  g_test_message(
      "%.2f m, gap %.2f: %zu spheres, nearest %.3f of the radii at %.3f s; a step %.1f contacts, %.1f Newton "
      "and %.1f linear iterations",
      length, gap, spore_world_body_sphere_count(world, 0), loops.bodies[0].least, loops.bodies[0].least_s,
      (double)contacts / (double)steps, (double)newton / (double)steps, (double)linear / (double)steps);
  g_assert_cmpuint(reached, >, 0);
  g_assert_cmpuint(loops.bodies[0].through, ==, 0);
  g_assert_cmpuint(spore_world_unsolved_count(world), ==, 0);
  g_assert_cmpuint(monitor->recoveries, ==, 0);
  spore_loops_clear(&loops);
  spore_curve_clear(&line);
  rig_free(rig);
}

#define THREAD 0.004 /* m: radius */
#define LEG 0.1      /* m */

/* A thread that runs along x, and back above itself so near that both legs overlap at rest. */
static SporeModel *legs(double gap) {
  enum { ON = 20, ROUND = 8, POINTS = 2 * ON + ROUND + 1 };
  SporeCurve curve;
  g_assert_true(spore_curve_allocate(&curve, POINTS, NULL));
  for (int i = 0; i < POINTS; i++) {
    double angle = G_PI * fmin(fmax(i - ON, 0), ROUND) / ROUND, back = fmax(ON - i, 0) + fmax(i - ON - ROUND, 0);
    double x = LEG * (1 - back / ON) + 0.5 * gap * sin(angle);
    spore_vec3_store(curve.points + 4 * i, spore_vec3(x, 0.5 * gap * (1 - cos(angle)), 0));
    curve.points[4 * i + 3] = THREAD;
  }
  return rig_curve_model(&spore_spline_1d, &curve, "control_points", 45.0, "young_modulus", 3e3, "damping", 0.05, NULL);
}

/* The lower leg is held. The upper one, which touched it from the start, does not fall through it: it would within
 * 0.1 s, if spheres that touch at rest did not meet. */
static void leg_on_leg(void) {
  Rig *rig = rig_new();
  SporeSphereSet *set = g_new0(SporeSphereSet, 1);
  SporeModel *model = legs(0.95 * 2 * THREAD);
  g_assert_true(model->type->spheres(model, set, NULL));
  g_ptr_array_add(rig->sets, set);
  rig_passive(rig, "thread", model, set)->contact =
      (SporeContactFields){.stiffness = 400, .damping = 0.3, .self = true};
  for (int i = 0; i < 10; i++) rig_pin(rig, 0, spore_vec3(0.1 * LEG * i, 0, 0), 0.9 * THREAD);
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.time_step = STEP;
  SporeWorld *world = rig_build(rig);
  SporeLoops loops;
  spore_loops_start(&loops, world);
  for (size_t i = 0; i < 60; i++) {
    spore_world_step(world);
    spore_loops_step(&loops, world);
  }
  g_test_message("nearest %.3f of the radii", loops.bodies[0].least);
  g_assert_cmpfloat(loops.bodies[0].least, >, 0.8);
  g_assert_cmpuint(loops.bodies[0].through, ==, 0);
  g_assert_cmpuint(spore_world_unsolved_count(world), ==, 0);
  spore_loops_clear(&loops);
  rig_free(rig);
}

static void apart(void) { run(0.02); }
static void overlapping(void) { run(-0.05); }

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/packed-bowel/apart", apart);
  g_test_add_func("/packed-bowel/overlapping", overlapping);
  g_test_add_func("/packed-bowel/leg-on-leg", leg_on_leg);
  return g_test_run();
}
