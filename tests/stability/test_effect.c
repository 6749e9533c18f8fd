/* Special effects in place of physics: what they do, that nothing else feels them, and the way there and back. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/sim/effect/effect.h"
#include "tests/stability/rig.h"

#define SIDE 11
#define SPACING 0.005
#define THICK 0.003 /* radius of the sheet's spheres, m */
#define TOOL 0.004  /* radius of the instrument's sphere, m */
#define SPEED 0.05  /* of the instrument, m/s */
#define HALF (0.5 * (SIDE - 1) * SPACING)
#define DEEP 0.006 /* how far the instrument goes into the sheet, m */

static void set_effect(SporeWorld *world, uint32_t body, bool on) {
  const SporeCommand command = {.kind = SPORE_COMMAND_EFFECT, .body = body, .effect = on};
  g_assert_true(spore_world_post(world, &command));
}

static SporeModel *cloud(double swirl, double drag) {
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(0.01, 0.01, 0.01));
  return rig_surface_model(&spore_smoke, &box, "swirl", swirl, "drag", drag, "life", 10., NULL);
}

static Rig *sky(double swirl, double drag, double h, bool effect) {
  Rig *rig = rig_new();
  rig->description.solver.time_step = h;
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  SporeBodyDescription *smoke = rig_passive(rig, "smoke", cloud(swirl, drag), NULL);
  smoke->effect = effect;
  if (swirl == 0) smoke->velocity = spore_vec3(0.2, 0, 0);
  return rig;
}

/* Farthest that a puff of the one is from the same puff of the other, m. */
static double apart(const SporeWorld *a, const SporeWorld *b) {
  double most = 0;
  for (size_t i = 0; i < spore_world_body_model(a, 0)->node_count; i++)
    most = fmax(most, spore_vec3_distance(spore_vec3_load(spore_world_q(a, 0) + 3 * i),
                                          spore_vec3_load(spore_world_q(b, 0) + 3 * i)));
  return most;
}

/* Smoke as an effect goes where physics would take it, at steps of which physics could not take one. */
static void test_smoke_goes_with_the_air(void) {
  static const struct {
    double swirl, h, most; /* most: m that it may be off after .4 s, on a way of 1.6 cm */
  } cases[] = {{0, 4e-3, 1e-7}, {0, 0.1, 1e-7}, {0.014, 4e-3, 2e-5}, {0.014, 0.02, 1e-4}};
  Rig *exact[2] = {sky(0, 250, 1e-4, false), sky(0.014, 250, 1e-4, false)};
  for (int i = 0; i < 2; i++)
    exact[i]->description.solver.integrator = SPORE_INTEGRATOR_RK4, rig_run(rig_build(exact[i]), 4000);
  for (unsigned c = 0; c < G_N_ELEMENTS(cases); c++) {
    Rig *rig = sky(cases[c].swirl, 250, cases[c].h, true);
    SporeWorld *world = rig_build(rig);
    rig_run(world, (unsigned)lround(0.4 / cases[c].h));
    double off = apart(world, exact[cases[c].swirl > 0]->world);
    g_test_message("swirl %g m/s, steps of %g s: %.2g m off", cases[c].swirl, cases[c].h, off);
    g_assert_cmpfloat(off, <, cases[c].most);
    g_assert_cmpuint(spore_world_dof(world), ==, 0);
    rig_free(rig);
  }
  for (int i = 0; i < 2; i++) rig_free(exact[i]);
}

/* Physics has a limit on the step, the effect has none; it says so where it is to become physics. */
static void test_smoke_has_no_limit(void) {
  SporeError error = SPORE_ERROR_INIT;
  Rig *physical = sky(0.014, 1000, 0.1, false);
  g_assert_null(rig_try_build(physical, &error));
  rig_free(physical);
  Rig *rig = sky(0.014, 1000, 0.1, true);
  SporeWorld *world = rig_build(rig);
  set_effect(world, 0, false);
  rig_run(world, 3);
  g_test_message("%s", rig_last_message(world));
  g_assert_true(spore_world_body_is_effect(world, 0) && rig_said(world, "smoke: the time step is too long"));
  g_assert_true(rig_finite(world));
  rig_free(rig);
}

/* A sheet of spheres, held at two corners, over which an instrument comes down; beside them a ball falls. */
static Rig *sheet(const SporeModelType *type, RigMover *mover, bool effect) {
  SporeTriangleMesh mesh;
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.time_step = 4e-3;
  rig->description.solver.sleep_speed = 0;
  shape_level_sheet(&mesh, SIDE, SIDE, SPACING);
  const SporeSphereSet *spheres = rig_spheres(rig, mesh.vertices, mesh.vertex_count, THICK);
  rig_passive(rig, "sheet", rig_surface_model(type, &mesh, NULL), spheres)->effect = effect;
  rig_active(rig, "tool", rig_sphere(rig, TOOL))->pose.position = mover->from;
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(0.01, 0.01, 0.01));
  rig_passive(rig, "ball", rig_surface_model(&spore_rigid_body, &box, NULL), rig_sphere(rig, 0.005))->pose.position =
      spore_vec3(0.3, 0, 0);
  return rig;
}

static SporeWorld *build_sheet(Rig *rig, RigMover *mover) {
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, 1, &mover->base);
  return world;
}

/* How deep the instrument is in the deepest of the sheet's spheres, m. */
static double depth(const SporeWorld *world) {
  const SporeSpheres *spheres = spore_world_spheres(world);
  SporeVec3 tool = spore_vec3_load(spore_world_q(world, 1));
  double most = 0;
  for (size_t i = 0; i < spore_world_body_model(world, 0)->node_count; i++)
    most = fmax(most, TOOL + THICK - spore_vec3_distance(spore_vec3_load(spore_world_q(world, 0) + 3 * i), tool));
  return spheres->count > 0 ? most : NAN;
}

static SporeVec3 corner(int i) { return spore_vec3(i & 1 ? 2 * HALF : 0, 0, i & 2 ? 2 * HALF : 0); }

/* Tissue gives way to the instrument at once, and comes back to its shape when that is gone; what is pinned stays. */
static void test_tissue_gives_way(void) {
  RigMover mover = {{&rig_mover_type}, {HALF + 0.001, TOOL + THICK + 0.001, HALF + 0.0007}, {0, -SPEED, 0}};
  Rig *rig = sheet(&spore_mass_spring_net, &mover, true);
  SporeTriangleMesh mesh;
  shape_level_sheet(&mesh, SIDE, SIDE, SPACING);
  double worst = 0, lowest = 0;
  rig_pin(rig, 0, corner(0), 1e-4);
  SporeWorld *world = build_sheet(rig, &mover);
  g_autofree double *rest = g_memdup2(spore_world_q(world, 0), 3 * SIDE * SIDE * sizeof *rest);
  spore_world_step(world);
  uint64_t before = spore_allocation_count();
  for (double gone = 0; gone < DEEP + 0.001; gone += SPEED * 4e-3) {
    spore_world_step(world);
    worst = fmax(worst, depth(world));
  }
  for (size_t i = 0; i < SIDE * SIDE; i++) lowest = fmin(lowest, spore_world_q(world, 0)[3 * i + 1]);
  g_test_message("pressed in by %.2g mm, %.2g mm of the instrument in the tissue at most", -1e3 * lowest, 1e3 * worst);
  g_assert_cmpfloat(lowest, <, -0.8 * DEEP);
  g_assert_cmpfloat(worst, <, 0.05 * THICK);
  g_assert_cmpmem(spore_world_q(world, 0), 3 * sizeof *rest, rest, 3 * sizeof *rest);
  mover.from = spore_vec3(0, 0.1, 0), mover.velocity = spore_vec3(0, 0, 0);
  rig_run(world, 1000);
  g_assert_cmpmem(spore_world_q(world, 0), 3 * SIDE * SIDE * sizeof *rest, rest, 3 * SIDE * SIDE * sizeof *rest);
  g_assert_cmpuint(spore_allocation_count(), ==, before);
  spore_triangle_mesh_clear(&mesh);
  rig_free(rig);
}

/* What neither touches it nor is tied to it is the same to the bit; the effect has no unknowns, and its energy is not
 * counted. */
static void test_others_do_not_feel_it(void) {
  uint64_t hashes[2];
  size_t dof[2];
  for (int effect = 0; effect < 2; effect++) {
    RigMover mover = {{&rig_mover_type}, {HALF + 0.001, TOOL + THICK + 0.001, HALF + 0.0007}, {0, -SPEED, 0}};
    Rig *rig = sheet(&spore_mass_spring_net, &mover, effect);
    SporeWorld *world = build_sheet(rig, &mover);
    rig_run(world, 30);
    hashes[effect] = spore_world_body_hash(world, 2);
    dof[effect] = spore_world_dof(world);
    g_assert_true(rig_finite(world));
    rig_free(rig);
  }
  g_assert_cmphex(hashes[0], ==, hashes[1]);
  g_assert_cmpuint(dof[0], ==, dof[1] + 3 * SIDE * SIDE);
}

/* Farthest that a node moved from `before`, m. */
static double moved(const SporeWorld *world, const double *before) {
  double most = 0;
  for (size_t i = 0; i < SIDE * SIDE; i++)
    most = fmax(most,
                spore_vec3_distance(spore_vec3_load(spore_world_q(world, 0) + 3 * i), spore_vec3_load(before + 3 * i)));
  return most;
}

/* There and back while it runs: without a jump, and a reset is time 0 again to the bit. */
static void test_there_and_back(void) {
  RigMover mover = {{&rig_mover_type}, {0, 0.2, 0}, {0, 0, 0}};
  Rig *rig = sheet(&spore_mass_spring_net, &mover, false);
  SporeTriangleMesh mesh;
  shape_level_sheet(&mesh, SIDE, SIDE, SPACING);
  for (int i = 0; i < 2; i++) rig_pin(rig, 0, corner(i), 1e-4);
  SporeWorld *world = build_sheet(rig, &mover);
  g_autofree double *before = g_new(double, 3 * SIDE * SIDE);
  uint64_t start = spore_world_hash(world);
  double hangs = 0;
  rig_run(world, 500);
  memcpy(before, spore_world_q(world, 0), 3 * SIDE * SIDE * sizeof *before);
  for (size_t i = 0; i < SIDE * SIDE; i++) hangs = fmax(hangs, -before[3 * i + 1]);
  set_effect(world, 0, true);
  spore_world_step(world);
  g_test_message("hangs by %.2g mm; the first step of the effect moves it by %.2g mm", 1e3 * hangs,
                 1e3 * moved(world, before));
  g_assert_cmpfloat(hangs, >, 5e-3);
  g_assert_cmpfloat(moved(world, before), <, 0.05 * SIDE * SPACING);
  g_assert_true(spore_world_body_is_effect(world, 0));
  rig_run(world, 1000);
  g_assert_cmpmem(spore_world_q(world, 0), 3 * SIDE * SIDE * sizeof(double), mesh.vertices,
                  3 * SIDE * SIDE * sizeof(double));
  memcpy(before, spore_world_q(world, 0), 3 * SIDE * SIDE * sizeof *before);
  set_effect(world, 0, false);
  spore_world_step(world);
  g_assert_cmpfloat(moved(world, before), <, 2 * 9.81 * 4e-3 * 4e-3);
  rig_run(world, 500);
  g_assert_cmpfloat(moved(world, before), >, 0.5 * hangs);
  set_effect(world, 0, true);
  rig_run(world, 10);
  spore_world_reset(world);
  g_assert_false(spore_world_body_is_effect(world, 0));
  g_assert_cmphex(spore_world_hash(world), ==, start);
  spore_triangle_mesh_clear(&mesh);
  rig_free(rig);
}

/* A rigid body stands still, and what falls on it stays on it. */
static void test_rigid_stands(void) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(0.02, 0.02, 0.02));
  rig_passive(rig, "stand", rig_surface_model(&spore_rigid_body, &box, NULL), rig_sphere(rig, 0.01))->effect = true;
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(0.02, 0.02, 0.02));
  SporeBodyDescription *ball =
      rig_passive(rig, "ball", rig_surface_model(&spore_rigid_body, &box, NULL), rig_sphere(rig, 0.01));
  ball->pose.position = spore_vec3(0, 0.0205, 0);
  SporeWorld *world = rig_build(rig);
  rig_run(world, 100);
  g_assert_cmpfloat(spore_world_q(world, 0)[1], ==, 0);
  g_assert_cmpfloat(spore_world_q(world, 1)[1], >, 0.018);
  g_assert_cmpuint(spore_world_dof(world), ==, 6);
  rig_free(rig);
}

/* A fluid has no effect: it stays physics, and says so where it is asked for while it runs. */
static void test_none(void) {
  SporeTriangleMesh box;
  Rig *rig = rig_new();
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(0.01, 0.01, 0.01));
  rig->description.solver.time_step = 1e-4;
  rig_passive(rig, "blood", rig_fluid_model(&box, 30, NULL), NULL)->effect = true;
  SporeWorld *world = rig_build(rig);
  g_assert_false(spore_world_body_is_effect(world, 0));
  set_effect(world, 0, true);
  spore_world_step(world);
  g_assert_true(rig_said(world, "blood: its model has no effect"));
  g_assert_false(spore_world_body_is_effect(world, 0));
  rig_free(rig);
}

/* In its middle a dent is its push; far off it falls as the third power. */
static void test_dent(void) {
  const SporeDent dent = {{0, 0, 0}, {0, -1e-3, 0}, 2e-3};
  SporeVec3 middle = spore_dents_at(&dent, 1, dent.at);
  double near = spore_vec3_length(spore_dents_at(&dent, 1, spore_vec3(0.1, 0, 0))),
         far = spore_vec3_length(spore_dents_at(&dent, 1, spore_vec3(0.2, 0, 0)));
  g_assert_cmpfloat(spore_vec3_distance(middle, dent.push), <, 1e-15);
  g_assert_cmpfloat(fabs(near / far / 8 - 1), <, 0.01);
  g_assert_cmpfloat(near, <, 1e-2 * 1e-3);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/stability/effect/smoke-goes-with-the-air", test_smoke_goes_with_the_air);
  g_test_add_func("/stability/effect/smoke-has-no-limit", test_smoke_has_no_limit);
  g_test_add_func("/stability/effect/tissue-gives-way", test_tissue_gives_way);
  g_test_add_func("/stability/effect/others-do-not-feel-it", test_others_do_not_feel_it);
  g_test_add_func("/stability/effect/there-and-back", test_there_and_back);
  g_test_add_func("/stability/effect/rigid-stands", test_rigid_stands);
  g_test_add_func("/stability/effect/none", test_none);
  g_test_add_func("/stability/effect/dent", test_dent);
  return g_test_run();
}
