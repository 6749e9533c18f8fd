/* Explicit methods with links and contacts that their step does not resolve, what they may do to energy, and how much
 * of it a method takes away. */
#include <math.h>
#include <string.h>

#include "tests/stability/rig.h"

#define GRAVITY 9.81
#define STIFFNESS 1e6

static const double steps[] = {1e-3, 4e-3, 1e-2};

static void hang(Rig *rig, guint body, SporeVec3 at) {
  SporeLinkDescription *spring = rig_link(rig, "spring", &spore_link_spring, body, SPORE_NO_BODY, at);
  spring->point_b = spore_vec3_add(at, spore_vec3(0, 0.1, 0));
  spring->stiffness = STIFFNESS;
  spring->damping = 100;
  spring->rest_length = 0.1;
}

static SporeModel *cube(double side, double mass) {
  SporeTriangleMesh mesh;
  shape_box(&mesh, spore_vec3(0, 0, 0), spore_vec3(side, side, side));
  return rig_surface_model(&spore_rigid_body, &mesh, "mass", mass, NULL);
}

typedef enum Hung { HUNG_CENTRE, HUNG_ABOVE, HUNG_NET, HUNG_TETRAHEDRA, HUNG_KINDS } Hung;
static const char *const hung_names[] = {"rigid body by its centre", "rigid body off centre", "net", "tetrahedra"};

/* Adds the body; an elastic one takes `hung_substeps`. Returns the place that the spring holds. */
static SporeVec3 add_hung(Rig *rig, Hung hung, size_t hung_substeps) {
  SporeTriangleMesh sheet;
  SporeTetrahedralMesh block;
  switch (hung) {
  case HUNG_NET:
    shape_sheet(&sheet, 5, 5, 0.01, TRUE);
    rig_passive(rig, "net", rig_surface_model(&spore_mass_spring_net, &sheet, "damping", 0.05, NULL), NULL)->substeps =
        hung_substeps;
    return spore_vec3(0.02, 0.04, 0);
  case HUNG_TETRAHEDRA:
    shape_block(&block, 2, 2, 2, spore_vec3(0.04, 0.04, 0.04));
    rig_passive(rig, "block", rig_tetrahedra_model(&block, "young_modulus", 1e4, NULL), NULL)->substeps = hung_substeps;
    return spore_vec3(0.02, 0.04, 0.02);
  default:
    rig_passive(rig, "ball", cube(0.032, 0.035), NULL);
    return spore_vec3(0, hung == HUNG_ABOVE ? 0.016 : 0, 0);
  }
}

/* Case 36: what hangs on a stiff spring stretches that by m g/k, and the spring says that it holds m g, by any method
 * in any step; or the step is refused with its limit. */
static void case_36(void) {
  unsigned held = 0;
  for (SporeIntegratorKind kind = SPORE_INTEGRATOR_EXPLICIT_EULER; kind < SPORE_INTEGRATOR_STATIC; kind++)
    for (unsigned s = 0; s < G_N_ELEMENTS(steps); s++)
      for (Hung hung = HUNG_CENTRE; hung < HUNG_KINDS; hung++) {
        /* What a midpoint step of 10 ms does not resolve is not at rest after a second. */
        if (kind == SPORE_INTEGRATOR_IMPLICIT_MIDPOINT && steps[s] > 5e-3) continue;
        Rig *rig = rig_new();
        rig->description.gravity = spore_vec3(0, -GRAVITY, 0);
        rig->description.solver.integrator = (int)kind;
        rig->description.solver.time_step = steps[s];
        rig->description.solver.sleep_speed = 0;
        hang(rig, 0, add_hung(rig, hung, s == 0 && kind < SPORE_INTEGRATOR_IMPLICIT_EULER ? 40 : 1));
        SporeError error = SPORE_ERROR_INIT;
        SporeWorld *world = rig_try_build(rig, &error);
        if (!world) {
          g_test_message("case 36: %s, %s, %g s: refused: %s", spore_integrator_names[kind], hung_names[hung], steps[s],
                         error.message);
          g_assert_true(kind < SPORE_INTEGRATOR_IMPLICIT_EULER && hung >= HUNG_NET);
          g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
          rig_free(rig);
          continue;
        }
        SporeEnergy start = spore_world_energy(world);
        double weight = GRAVITY * spore_model_total_mass(spore_world_body_model(world, 0));
        rig_run(world, (unsigned)(1 / steps[s]));
        SporeEnergy end = spore_world_energy(world);
        double load = spore_world_link_state(world, 0).load;
        double stretch = sqrt(2 * end.internal / STIFFNESS) * STIFFNESS / weight; /* of a rigid body */
        g_test_message("case 36: %s, %s, %g s: load %.4f of the weight, stretch %.4f of m g/k, energy %+.1e J",
                       spore_integrator_names[kind], hung_names[hung], steps[s], load / weight, stretch,
                       end.kinetic + end.internal + end.gravity - start.kinetic - start.internal - start.gravity);
        g_assert_cmpfloat_with_epsilon(load, weight, 0.01 * weight);
        if (hung < HUNG_NET) g_assert_cmpfloat_with_epsilon(stretch, 1, 0.01);
        g_assert_cmpuint(spore_world_unsolved_count(world), ==, 0);
        held++;
        rig_free(rig);
      }
  g_assert_cmpuint(held, >=, 46); /* all rigid bodies: 8 methods, 3 steps, 2 places; but midpoint, 2 steps */
}

/* Case 39: a light ball under five heavy ones. Energy never rises above the start, or the run says that it was not
 * solved; and the column stands where it was solved. The margin lets a contact be known before it presses, at any of
 * these steps. */
static void case_39(void) {
  for (SporeIntegratorKind kind = SPORE_INTEGRATOR_EXPLICIT_EULER; kind < SPORE_INTEGRATOR_STATIC; kind++)
    for (unsigned s = 0; s < G_N_ELEMENTS(steps); s++) {
      const double radius = 0.02, light = 0.01, heavy = 0.2, fall = 5 * heavy * GRAVITY * radius;
      Rig *rig = rig_new();
      rig->description.gravity = spore_vec3(0, -GRAVITY, 0);
      rig->description.solver.integrator = (int)kind;
      rig->description.solver.time_step = steps[s];
      SporeContactFields law = {.stiffness = 1e5, .damping = 10, .margin = 0.002};
      SporeBodyDescription *floor = rig_unmovable(rig, "floor", rig_sphere(rig, 1));
      floor->pose.position.y = -1;
      floor->contact = law;
      for (int i = 0; i < 6; i++) {
        SporeBodyDescription *ball = rig_passive(rig, g_intern_string((char[]){'b', (char)('0' + i), 0}),
                                                 cube(radius, i == 0 ? light : heavy), rig_sphere(rig, radius));
        ball->pose.position.y = radius * (2 * i + 1);
        ball->contact = law;
      }
      SporeWorld *world = rig_build(rig);
      SporeEnergy start = spore_world_energy(world);
      double most = -HUGE_VAL;
      for (unsigned i = 0; i < (unsigned)(1 / steps[s]); i++) {
        spore_world_step(world);
        SporeEnergy now = spore_world_energy(world);
        most = fmax(most, now.kinetic + now.gravity + now.contact - start.kinetic - start.gravity - start.contact);
      }
      size_t unsolved = spore_world_unsolved_count(world);
      double top = spore_world_q(world, 6)[1];
      g_test_message("case 39: %s, %g s: energy at most %+.1e J above the start (%.1e J a radius), top at %.4f m, %zu "
                     "unsolved, %s",
                     spore_integrator_names[kind], steps[s], most, fall, top, unsolved, rig_last_message(world));
      g_assert_true(rig_finite(world));
      if (unsolved == 0) g_assert_cmpfloat(most, <=, 1e-6 * fall);
      if (unsolved == 0) g_assert_cmpfloat(top, >, 10.5 * radius);
      rig_free(rig);
    }
}

/* A net that hangs by a corner and swings; damped so well that its step bears explicit Euler, but for the swinging,
 * into which that feeds energy. */
static Rig *swinging_net(SporeIntegratorKind kind, double step, double damping) {
  Rig *rig = rig_new();
  SporeTriangleMesh sheet;
  shape_sheet(&sheet, 4, 4, 0.01, TRUE);
  rig->description.gravity = spore_vec3(0, -GRAVITY, 0);
  rig->description.solver.integrator = (int)kind;
  rig->description.solver.time_step = step;
  rig->description.solver.sleep_speed = 0;
  rig_passive(rig, "net", rig_surface_model(&spore_mass_spring_net, &sheet, "damping", damping, NULL), NULL);
  rig_pin(rig, 0, spore_vec3(0, 0, 0), 1e-3);
  return rig;
}

static bool has_cause(const SporeWorld *world, const char *part) {
  for (size_t i = 0; i < spore_world_unsolved_count(world); i++)
    if (strstr(spore_world_unsolved(world, i).cause, part)) return true;
  return false;
}

/* Energy that a method makes is said; that of a method which makes none is not. */
static void energy_is_watched(void) {
  for (SporeIntegratorKind kind = SPORE_INTEGRATOR_EXPLICIT_EULER; kind <= SPORE_INTEGRATOR_SYMPLECTIC_EULER; kind++) {
    Rig *rig = swinging_net(kind, 3e-5, 0.2);
    SporeWorld *world = rig_build(rig);
    SporeEnergy start = spore_world_energy(world);
    rig_run(world, 80000);
    SporeEnergy end = spore_world_energy(world);
    g_test_message("%s: energy %+.2e J of %.2e J, %zu unsolved", spore_integrator_names[kind],
                   end.kinetic + end.internal + end.gravity - start.kinetic - start.internal - start.gravity,
                   end.kinetic, spore_world_unsolved_count(world));
    g_assert_true(has_cause(world, "out of nothing") == (kind == SPORE_INTEGRATOR_EXPLICIT_EULER));
    g_assert_false(has_cause(world, "half its size"));
    rig_free(rig);
  }
}

/* Nodes thrown about at random move as fast as they can: a step near the largest one does not follow them, and a tenth
 * of it does. */
static void steps_are_halved(void) {
  for (int fine = 0; fine < 2; fine++) {
    Rig *rig = swinging_net(SPORE_INTEGRATOR_SYMPLECTIC_EULER, fine ? 5e-5 : 5e-4, 0);
    SporeWorld *world = rig_build(rig);
    GRand *random = g_rand_new_with_seed(3);
    size_t n = 3 * spore_world_body_model(world, 0)->block_count;
    g_autofree double *q = g_memdup2(spore_world_q(world, 0), n * sizeof *q), *v = g_new0(double, n);
    for (int i = 0; i < 200; i++) {
      for (size_t e = 0; e < n; e++) v[e] = g_rand_double_range(random, -1, 1);
      spore_world_set_state(world, 0, q, v);
      spore_world_step(world);
    }
    g_test_message("step %s: %zu unsolved; %s", fine ? "fine" : "coarse", spore_world_unsolved_count(world),
                   rig_last_message(world));
    g_assert_true(has_cause(world, "half its size") == !fine);
    g_rand_free(random);
    rig_free(rig);
  }
}

static double energy_of(const SporeWorld *world, double lowest) {
  SporeEnergy energy = spore_world_energy(world);
  return energy.kinetic + energy.internal + energy.gravity - lowest;
}

/* The share of energy that the world loses in a second: over whole periods, a second at least. */
static double measured_share(SporeWorld *world, double step, double period, double lowest) {
  unsigned count = (unsigned)lround(period * fmax(ceil(1 / period), 1) / step);
  double start = energy_of(world, lowest);
  rig_run(world, count);
  return 1 - pow(energy_of(world, lowest) / start, 1 / (count * step));
}

/* What is said of a pendulum is what it does. */
static void pendulum_damping(void) {
  static const struct {
    SporeIntegratorKind kind;
    double steps[2];
  } rows[] = {{SPORE_INTEGRATOR_IMPLICIT_EULER, {1e-3, 4e-3}},
              {SPORE_INTEGRATOR_VERLET, {1e-3, 4e-3}}, /* its joint makes it implicit */
              {SPORE_INTEGRATOR_BDF2, {8e-3, 1.6e-2}}};
  const double arm = 0.2, mass = 0.035, side = 0.032, angle = 0.5;
  const double inertia = mass * side * side / 6 + mass * arm * arm;
  const double period = 2 * G_PI * sqrt(inertia / (mass * GRAVITY * arm));
  for (unsigned i = 0; i < G_N_ELEMENTS(rows); i++)
    for (int s = 0; s < 2; s++) {
      Rig *rig = rig_new();
      rig->description.gravity = spore_vec3(0, -GRAVITY, 0);
      rig->description.solver.integrator = (int)rows[i].kind;
      rig->description.solver.time_step = rows[i].steps[s];
      rig->description.solver.sleep_speed = 0;
      rig->description.solver.tolerance = 1e-9;
      SporeBodyDescription *body = rig_passive(rig, "ball", cube(side, mass), NULL);
      body->pose.position = spore_vec3(arm * sin(angle), -arm * cos(angle), 0);
      SporeLinkDescription *joint = rig_link(rig, "joint", &spore_link_ball, 0, SPORE_NO_BODY, spore_vec3(0, 0, 0));
      joint->stiffness = 1e6;
      SporeWorld *world = rig_build(rig);
      double said = -1;
      g_assert_true(spore_world_body_damping(world, 0, &said));
      double found = measured_share(world, rows[i].steps[s], period, -mass * GRAVITY * arm);
      g_test_message("%s, %g s: takes %.4g%% a second, said %.4g%%", spore_integrator_names[rows[i].kind],
                     rows[i].steps[s], 100 * found, 100 * said);
      g_assert_cmpfloat_with_epsilon(said, found, 0.1 * found);
      rig_free(rig);
    }
}

/* A beam of tetrahedra held at one end, in its slowest mode. */
static void beam_damping(void) {
  for (int s = 0; s < 2; s++) {
    double step = s ? 4e-3 : 1e-3, said = -1;
    Rig *rig = rig_new();
    SporeTetrahedralMesh block;
    shape_block(&block, 8, 2, 2, spore_vec3(0.2, 0.02, 0.03));
    rig->description.solver.time_step = step;
    rig->description.solver.sleep_speed = 0;
    rig->description.solver.tolerance = 1e-8;
    rig->description.solver.integrator = SPORE_INTEGRATOR_IMPLICIT_EULER;
    SporeBodyDescription *body = rig_passive(
        rig, "beam", rig_tetrahedra_model(&block, "young_modulus", 1e5, "stiffness_damping", 0., NULL), NULL);
    body->velocity = spore_vec3(0, 0.01, 0);
    for (int i = 0; i < 9; i++) rig_pin(rig, 0, spore_vec3(0, 0.01 * (i % 3), 0.015 * (i / 3)), 1e-3);
    SporeWorld *world = rig_build(rig);
    g_assert_true(spore_world_body_damping(world, 0, &said));
    rig_run(world, (unsigned)(2 / step)); /* faster modes are gone then */
    double found = measured_share(world, step, 1, 0);
    g_test_message("beam, %g s: takes %.4g%% a second, said %.4g%%", step, 100 * found, 100 * said);
    g_assert_cmpfloat_with_epsilon(said, found, 0.1 * found);
    rig_free(rig);
  }
}

/* Where the swing is not known, nothing is said: free bodies, bodies on two springs, particles. */
static void unknown_damping(void) {
  double said;
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -GRAVITY, 0);
  rig_passive(rig, "free", cube(0.02, 0.1), NULL);
  rig_passive(rig, "sprung", cube(0.02, 0.1), NULL);
  hang(rig, 1, spore_vec3(0, 0, 0));
  SporeWorld *world = rig_build(rig);
  for (uint32_t b = 0; b < 2; b++) g_assert_false(spore_world_body_damping(world, b, &said));
  rig_free(rig);
}

/* The plan's words about a method are those of the steps: a body is implicit where a link is stiff for its step. */
static void coupling_is_said(void) {
  for (int soft = 0; soft < 2; soft++)
    for (SporeIntegratorKind kind = SPORE_INTEGRATOR_SYMPLECTIC_EULER; kind <= SPORE_INTEGRATOR_IMPLICIT_EULER;
         kind++) {
      Rig *rig = rig_new();
      rig->description.gravity = spore_vec3(0, -GRAVITY, 0);
      rig->description.solver.integrator = (int)kind;
      rig->description.solver.time_step = 1e-3;
      rig_passive(rig, "ball", cube(0.032, 0.035), NULL);
      hang(rig, 0, spore_vec3(0, 0, 0));
      g_array_index(rig->links, SporeLinkDescription, 0).stiffness = soft ? 10 : 1e5;
      g_array_index(rig->links, SporeLinkDescription, 0).damping = soft ? 0 : 10;
      SporeWorld *world = rig_build(rig);
      SporeMethod method;
      g_assert_true(spore_world_body_method(world, 0, &method));
      gboolean coupled = !soft && kind < SPORE_INTEGRATOR_IMPLICIT_EULER;
      g_assert_cmpint(method.coupled, ==, coupled ? SPORE_COUPLED_LINKS : SPORE_COUPLED_NEVER);
      g_assert_true((method.nonlinear.name != NULL) == (!soft || kind == SPORE_INTEGRATOR_IMPLICIT_EULER));
      rig_run(world, 2);
      g_assert_true((spore_world_counts(world).newton_iterations > 0) == (method.nonlinear.name != NULL));
      for (size_t k = 0; k < spore_world_plan(world)->left_out_count; k++)
        g_assert_null(strstr(spore_world_plan(world)->left_out[k].what, "solver"));
      if (coupled) {
        g_assert_cmpuint(method.resolving, >, 1);
        size_t resolving = method.resolving;
        for (int less = 0; less < 2; less++) {
          rig->description.solver.substeps = (int64_t)resolving - less;
          spore_world_free(rig->world);
          g_array_index(rig->bodies, SporeBodyDescription, 0).model = cube(0.032, 0.035);
          world = rig->world = NULL;
          world = rig_build(rig);
          g_assert_true(spore_world_body_method(world, 0, &method));
          g_assert_cmpint(method.coupled, ==, less ? SPORE_COUPLED_LINKS : SPORE_COUPLED_NEVER);
        }
      }
      rig_free(rig);
    }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/stability/explicit/case_36", case_36);
  g_test_add_func("/stability/explicit/case_39", case_39);
  g_test_add_func("/stability/explicit/energy", energy_is_watched);
  g_test_add_func("/stability/explicit/halves", steps_are_halved);
  g_test_add_func("/stability/explicit/pendulum_damping", pendulum_damping);
  g_test_add_func("/stability/explicit/beam_damping", beam_damping);
  g_test_add_func("/stability/explicit/unknown_damping", unknown_damping);
  g_test_add_func("/stability/explicit/coupling", coupling_is_said);
  return g_test_run();
}
