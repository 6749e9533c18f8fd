/* Each trouble that the monitor knows, provoked: what it does about it, counts and says. Forces that are not finite and
 * bodies that are too fast are in tests/sim/test_world.c. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "tests/stability/rig.h"

static const SporeMonitor *quiet(const SporeWorld *world) {
  const SporeMonitor *monitor = spore_world_monitor(world);
  g_assert_cmpuint(monitor->not_finite + monitor->too_fast + monitor->energy + monitor->not_converged, ==, 0);
  g_assert_cmpuint(monitor->deep_contacts + monitor->over_budget + monitor->recoveries, ==, 0);
  g_assert_cmpuint(monitor->message_count, ==, 0);
  return monitor;
}

static Rig *hanging_net(SporeIntegratorKind integrator) {
  Rig *rig = rig_new();
  SporeTriangleMesh sheet;
  shape_sheet(&sheet, 8, 8, 0.02, TRUE);
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.integrator = integrator;
  rig_passive(rig, "net", rig_surface_model(&spore_mass_spring_net, &sheet, "damping", 0.0, NULL), NULL);
  rig_pin(rig, 0, spore_vec3(0, 0, 0), 1e-3);
  rig_pin(rig, 0, spore_vec3(0.14, 0.14, 0), 1e-3);
  return rig;
}

/* A net that is made too stiff for its explicit step while it runs goes on implicitly, before its energy is worth
 * mentioning; a reset gives it back what the scene says. */
static void test_energy(void) {
  Rig *rig = hanging_net(SPORE_INTEGRATOR_SYMPLECTIC_EULER);
  rig->description.solver.time_step = 1e-4;
  SporeWorld *world = rig_build(rig);
  rig_run(world, 3000);
  const SporeMonitor *monitor = quiet(world);
  SporeCommand stiffen = {.kind = SPORE_COMMAND_RETUNE};
  stiffen.fields = rig_fields(&spore_mass_spring_net, "damping", 0.0, "structural_stiffness", 1e5, NULL);
  g_assert_true(spore_world_post(world, &stiffen));
  spore_world_step(world);
  SporeEnergy after = spore_world_energy(world);
  double most = 0;
  for (int i = 0; i < 3000; i++) {
    spore_world_step(world);
    most = fmax(most, spore_world_energy(world).kinetic);
  }
  double had = after.kinetic + after.internal;
  g_test_message("kinetic energy at most %.2g J after %.2g J; %s", most, had, rig_last_message(world));
  g_assert_true(rig_finite(world));
  g_assert_false(rig_any_frozen(world));
  g_assert_cmpuint(monitor->energy, ==, 1);
  g_assert_true(spore_world_body_made_safer(world, 0));
  g_assert_true(rig_said(world, "net: "));
  g_assert_nonnull(strstr(rig_last_message(world), "energy"));
  g_assert_cmpfloat(most, <, 1e4 * had);
  spore_world_reset(world);
  g_assert_false(spore_world_body_made_safer(world, 0));
  rig_free(rig);
}

/* Gravity, a pull, a change of stiffness that the step still bears: none of it is a fault. */
/* damped: the method makes no energy either, nor says that it does. */
static void check_no_false_alarm(SporeIntegratorKind integrator, gboolean damped) {
  Rig *rig = hanging_net(integrator);
  rig->description.solver.time_step = 5e-4;
  SporeWorld *world = rig_build(rig);
  SporeCommand commands[4] = {
      {.kind = SPORE_COMMAND_GRAVITY, .vector = {0, 30, 0}},
      {.kind = SPORE_COMMAND_PULL, .point = {0.14, 0, 0}, .vector = {0.4, -0.2, 0.3}, .number = 200},
      {.kind = SPORE_COMMAND_RELEASE},
      {.kind = SPORE_COMMAND_RETUNE}};
  commands[3].fields = rig_fields(&spore_mass_spring_net, "damping", 0.0, "structural_stiffness", 200.0, NULL);
  for (int i = 0; i < 4; i++) {
    g_assert_true(spore_world_post(world, &commands[i]));
    rig_run(world, 1000);
    quiet(world);
    for (size_t u = 0; u < spore_world_unsolved_count(world); u++)
      g_test_message("%s, %d: %s %g", spore_integrator_names[integrator], i, spore_world_unsolved(world, u).cause,
                     spore_world_unsolved(world, u).worst);
    if (damped) g_assert_cmpuint(spore_world_unsolved_count(world), ==, 0);
  }
  rig_free(rig);
}

static void test_no_false_alarm(void) {
  check_no_false_alarm(SPORE_INTEGRATOR_SYMPLECTIC_EULER, FALSE);
  check_no_false_alarm(SPORE_INTEGRATOR_IMPLICIT_EULER, TRUE);
  check_no_false_alarm(SPORE_INTEGRATOR_BDF2, TRUE);
  check_no_false_alarm(SPORE_INTEGRATOR_TR_BDF2, TRUE);
}

/* Turned, and far from the origin, a body at rest feels forces of its own that are nothing but rounding. */
static Rig *body_at_rest(int kind) {
  Rig *rig = rig_new();
  rig->description.solver.sleep_speed = 0;
  SporeModel *model;
  if (kind == 0) {
    SporeTriangleMesh sheet;
    shape_sheet(&sheet, 8, 8, 0.02, TRUE);
    model = rig_surface_model(&spore_mass_spring_net, &sheet, NULL);
  } else {
    SporeTetrahedralMesh block;
    shape_block(&block, 3, 3, 3, spore_vec3(0.05, 0.05, 0.05));
    const SporeModelType *type = kind == 1 ? &spore_corotational_tetrahedra : &spore_neo_hookean_tetrahedra;
    model = rig_solid_model(type, &block, NULL);
  }
  SporeBodyDescription *body = rig_passive(rig, "body", model, NULL);
  body->pose = (SporePose){{0.3, -1.7, 11}, spore_quat_from_rotation_vector(spore_vec3(0.4, -1.1, 0.7))};
  return rig;
}

/* Without gravity, a body in balance has nothing to solve, and is not called unsolved. */
static void test_balance(void) {
  for (int kind = 0; kind < 3; kind++)
    for (int pinned = 0; pinned < 2; pinned++)
      for (int nonlinear = SPORE_NONLINEAR_NEWTON; nonlinear <= SPORE_NONLINEAR_BROYDEN; nonlinear++) {
        Rig *rig = body_at_rest(kind);
        rig->description.solver.nonlinear = nonlinear;
        if (pinned) rig_pin(rig, 0, spore_vec3(0.3, -1.7, 11), 0.05);
        SporeWorld *world = rig_build(rig);
        double moved = 0, start[3];
        memcpy(start, spore_world_q(world, 0), sizeof start);
        for (int i = 0; i < 200; i++) {
          spore_world_step(world);
          g_assert_cmpfloat(spore_world_counts(world).residual, <=, 1e-6);
        }
        for (int k = 0; k < 3; k++) moved = fmax(moved, fabs(spore_world_q(world, 0)[k] - start[k]));
        g_test_message("kind %d: moved %.1e m in 200 steps; %s", kind, moved, rig_last_message(world));
        quiet(world);
        g_assert_cmpfloat(moved, <, 1e-12);
        rig_free(rig);
      }
}

static void test_not_converged(void) {
  Rig *rig = hanging_net(SPORE_INTEGRATOR_IMPLICIT_EULER);
  rig->description.solver.time_step = 0.02;
  rig->description.solver.newton_iterations = 1;
  rig->description.solver.linear_iterations = 1;
  rig->description.solver.tolerance = 1e-10;
  SporeWorld *world = rig_build(rig);
  rig_run(world, 50);
  const SporeMonitor *monitor = spore_world_monitor(world);
  g_test_message("%u of 50 steps not converged; %s", (unsigned)monitor->not_converged, rig_last_message(world));
  g_assert_true(rig_finite(world));
  g_assert_cmpuint(monitor->not_converged, >, 0);
  g_assert_true(rig_said(world, "net: its equations"));
  rig_free(rig);
}

static void test_deep_contact(void) {
  Rig *rig = rig_new();
  for (int i = 0; i < 2; i++) {
    SporeTriangleMesh box;
    shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(0.01, 0.01, 0.01));
    SporeModel *model = rig_surface_model(&spore_rigid_body, &box, NULL);
    SporeBodyDescription *body = rig_passive(rig, i ? "right" : "left", model, rig_sphere(rig, 0.01));
    body->pose.position.x = 0.009 * i; /* radius 10 mm each: 11 mm deep */
  }
  SporeWorld *world = rig_build(rig);
  rig_run(world, 2000);
  const SporeMonitor *monitor = spore_world_monitor(world);
  g_test_message("%u deep contacts; %s", (unsigned)monitor->deep_contacts, rig_last_message(world));
  g_assert_cmpuint(monitor->deep_contacts, >, 0);
  g_assert_cmpuint(monitor->message_count, ==, 1);
  g_assert_true(rig_said(world, "left: overlaps right by 0.011 m"));
  g_assert_cmpfloat(spore_world_q(world, 1)[0] - spore_world_q(world, 0)[0], >=, 0.02);
  rig_free(rig);
}

#define COLUMN_RADIUS 0.05
#define COLUMN_STIFFNESS 1e5 /* of a sphere: half of it between two */

/* Balls that lie on each other on a floor; mean depth between them over that of springs, at rest. */
static double column_depth(Rig *rig, unsigned count) {
  const double side = sqrt(2.4) * COLUMN_RADIUS, mass = 0.5;
  SporeContactFields law = {.stiffness = COLUMN_STIFFNESS, .damping = 20};
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.sleep_speed = 0;
  SporeBodyDescription *floor = rig_unmovable(rig, "floor", rig_sphere(rig, 1));
  floor->pose.position.y = -1;
  floor->contact = law;
  for (unsigned i = 0; i < count; i++) {
    SporeTriangleMesh cube;
    shape_box(&cube, spore_vec3(0, 0, 0), spore_vec3(side, side, side));
    SporeModel *model = rig_surface_model(&spore_rigid_body, &cube, "mass", mass, NULL);
    char *name = g_strdup_printf("ball%u", i);
    SporeBodyDescription *ball = rig_passive(rig, g_intern_string(name), model, rig_sphere(rig, COLUMN_RADIUS));
    ball->pose.position.y = (2 * i + 1) * COLUMN_RADIUS;
    ball->contact = law;
    g_free(name);
  }
  SporeWorld *world = rig_build(rig);
  rig_run(world, (unsigned)(3 / rig->description.solver.time_step));
  double total = 0, springs = 0;
  for (unsigned i = 0; i < count; i++) springs += (count - i) * mass * 9.81 / (0.5 * COLUMN_STIFFNESS);
  total = (2 * count - 1) * COLUMN_RADIUS - spore_world_q(world, count)[1];
  return total / springs;
}

/* Contacts that an explicit step does not resolve hold as they are written, under a pile as under one ball. */
static void test_pile(void) {
  for (SporeIntegratorKind kind = SPORE_INTEGRATOR_EXPLICIT_EULER; kind <= SPORE_INTEGRATOR_IMPLICIT_EULER; kind++)
    for (unsigned count = 1; count <= 5; count += 4) {
      Rig *rig = rig_new();
      rig->description.solver.time_step = 4e-3;
      rig->description.solver.integrator = kind;
      double depth = column_depth(rig, count);
      g_test_message("%s, %u balls: %.4f times as deep as springs; %s", spore_integrator_names[kind], count, depth,
                     rig_last_message(rig->world));
      g_assert_cmpfloat_with_epsilon(depth, 1, 0.01);
      quiet(rig->world);
      for (size_t u = 0; u < spore_world_unsolved_count(rig->world); u++)
        g_test_message("%s %g", spore_world_unsolved(rig->world, u).cause, spore_world_unsolved(rig->world, u).worst);
      g_assert_cmpuint(spore_world_unsolved_count(rig->world), ==, 0);
      rig_free(rig);
    }
}

/* Whoever paces a run may say what a step may take; physics does not know. */
static void test_budget(void) {
  uint64_t hash[2];
  for (int i = 0; i < 2; i++) {
    Rig *rig = hanging_net(SPORE_INTEGRATOR_IMPLICIT_EULER);
    SporeWorld *world = rig_build(rig);
    spore_world_set_budget(world, i ? 1e-3 : 1e12);
    rig_run(world, 20);
    g_assert_cmpuint(spore_world_monitor(world)->over_budget, ==, i ? 20 : 0);
    g_assert_cmpuint(spore_world_monitor(world)->message_count, ==, i);
    if (i) g_assert_true(rig_said(world, "net: a step took"));
    if (i) g_assert_nonnull(strstr(rig_last_message(world), "integrate"));
    hash[i] = spore_world_hash(world);
    rig_free(rig);
  }
  g_assert_cmphex(hash[0], ==, hash[1]);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/monitor/energy", test_energy);
  g_test_add_func("/monitor/no_false_alarm", test_no_false_alarm);
  g_test_add_func("/monitor/balance", test_balance);
  g_test_add_func("/monitor/not_converged", test_not_converged);
  g_test_add_func("/monitor/deep_contact", test_deep_contact);
  g_test_add_func("/monitor/pile", test_pile);
  g_test_add_func("/monitor/budget", test_budget);
  return g_test_run();
}
