/* Position-based steps: they come to the same as others do, they bear any step, and what they cannot meet moves as by
 * symplectic Euler. */
#include <math.h>
#include <string.h>

#include "tests/stability/rig.h"

typedef enum Body { NET, TETRAHEDRA, VISCOUS, COROTATIONAL, BODIES } Body;

/* A sheet or a bar that one end holds, and that falls. */
static Rig *held_body(Body body, SporeIntegratorKind kind, double step, double factor) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 2);
  rig->description.solver.integrator = (int)kind;
  rig->description.solver.time_step = step;
  rig->description.solver.sleep_speed = 0;
  SporeTriangleMesh sheet;
  SporeTetrahedralMesh bar;
  if (body == NET) {
    shape_sheet(&sheet, 6, 6, 0.02, TRUE);
    rig_passive(rig, "net",
                rig_surface_model(&spore_mass_spring_net, &sheet, "structural_stiffness", 100 * factor,
                                  "shear_stiffness", 50 * factor, "bending_stiffness", 10 * factor, NULL),
                NULL);
  } else {
    const SporeModelType *type = body == COROTATIONAL ? &spore_corotational_tetrahedra : &spore_neo_hookean_tetrahedra;
    shape_block(&bar, 6, 2, 2, spore_vec3(0.12, 0.04, 0.04));
    rig_passive(rig, "bar",
                rig_solid_model(type, &bar, "young_modulus", 1e4 * factor, "poisson_ratio", 0.45, "mass_damping", 0.5,
                                "stiffness_damping", body == VISCOUS ? 5e-3 : 0, NULL),
                NULL);
  }
  if (body == NET)
    for (int i = 0; i < 6; i++) rig_pin(rig, 0, spore_vec3(0, 0.02 * i, 0), 0.005);
  else rig_pin(rig, 0, spore_vec3(-0.1, 0.02, 0.02), 0.105);
  return rig;
}

/* Largest distance of a node from where it is in `other`, m. */
static double distance(const SporeWorld *world, const double *other) {
  double most = 0;
  size_t n = spore_world_body_model(world, 0)->node_count;
  for (size_t i = 0; i < n; i++)
    most = fmax(most,
                spore_vec3_distance(spore_vec3_load(spore_world_q(world, 0) + 3 * i), spore_vec3_load(other + 3 * i)));
  return most;
}

static double error_of(Body body, double step, double time_s, const double *exact) {
  Rig *rig = held_body(body, SPORE_INTEGRATOR_POSITION_BASED, step, 1);
  SporeWorld *world = rig_build(rig);
  rig_run(world, (unsigned)lround(time_s / step));
  double error = distance(world, exact);
  rig_free(rig);
  return error;
}

/* Half the step, half the error: to the motion that RK4 finds. */
static void converges(gconstpointer data) {
  Body body = (Body)GPOINTER_TO_INT(data);
  const double time_s = 0.1;
  Rig *rig = held_body(body, SPORE_INTEGRATOR_RK4, 1e-4, 1);
  SporeWorld *world = rig_build(rig);
  rig_run(world, (unsigned)lround(time_s / 1e-4));
  g_autofree double *exact =
      g_memdup2(spore_world_q(world, 0), 3 * spore_world_body_model(world, 0)->node_count * sizeof *exact);
  double coarse = error_of(body, 2e-4, time_s, exact), fine = error_of(body, 1e-4, time_s, exact);
  g_test_message("errors %.3g and %.3g m", coarse, fine);
  g_assert_cmpfloat(coarse, <, 1e-3);
  g_assert_cmpfloat(fine, <, 0.6 * coarse);
  rig_free(rig);
}

/* However stiff and however long the step: what hangs stays in its neighbourhood, is not refused, and keeps its method.
 */
static void bears_any_step(gconstpointer data) {
  static const double steps[] = {1e-1, 1e-2, 1e-3}, factors[] = {1, 1e3, 1e6};
  Body body = (Body)GPOINTER_TO_INT(data);
  for (unsigned s = 0; s < G_N_ELEMENTS(steps); s++)
    for (unsigned f = 0; f < G_N_ELEMENTS(factors); f++) {
      Rig *rig = held_body(body, SPORE_INTEGRATOR_POSITION_BASED, steps[s], factors[f]);
      SporeWorld *world = rig_build(rig);
      double most = 0;
      g_autofree double *rest =
          g_memdup2(spore_world_q(world, 0), 3 * spore_world_body_model(world, 0)->node_count * sizeof *rest);
      unsigned count = rig_steps(2000, 200);
      for (unsigned i = 0; i < count; i++) {
        rig_run(world, 1);
        most = fmax(most, distance(world, rest));
      }
      g_test_message("step %g s, stiffness x %g: within %.3g m; %s", steps[s], factors[f], most,
                     rig_last_message(world));
      g_assert_true(rig_finite(world));
      g_assert_cmpfloat(most, <, 10); /* free fall would be far below it: 2000 steps of 1 ms are 20 m */
      g_assert_false(spore_world_body_made_safer(world, 0));
      g_assert_cmpuint(spore_world_monitor(world)->recoveries, ==, 0);
      rig_free(rig);
    }
}

/* A stretched body far from what its step resolves has energy that nobody gave it, and that is said. */
static void says_what_it_misses(void) {
  for (int fine = 0; fine < 2; fine++) {
    Rig *rig = held_body(NET, SPORE_INTEGRATOR_POSITION_BASED, fine ? 2e-4 : 2e-2, fine ? 1 : 1e6);
    SporeWorld *world = rig_build(rig);
    rig_run(world, 300);
    g_test_message("%s: %zu unsolved; %s", fine ? "fine" : "coarse", spore_world_unsolved_count(world),
                   rig_last_message(world));
    g_assert_true((spore_world_unsolved_count(world) > 0) == !fine);
    rig_free(rig);
  }
}

/* Bodies in contact. */

#define WALL_RADIUS 1e4 /* m: over a small body it is a plane */

/* A block of soft tetrahedra on a plane y = 0, `count` of them on each other, each with spheres at its nodes. */
static Rig *blocks(unsigned count, double step, const SporeContactFields *contact, SporeVec3 gravity) {
  Rig *rig = rig_new();
  rig->description.gravity = gravity;
  rig->description.solver.integrator = SPORE_INTEGRATOR_POSITION_BASED;
  rig->description.solver.time_step = step;
  rig->description.solver.sleep_speed = 0;
  rig_unmovable(rig, "floor", rig_sphere(rig, WALL_RADIUS))->pose.position = spore_vec3(0, -WALL_RADIUS, 0);
  g_array_index(rig->bodies, SporeBodyDescription, 0).contact = *contact;
  for (unsigned i = 0; i < count; i++) {
    SporeTetrahedralMesh mesh;
    shape_block(&mesh, 2, 2, 2, spore_vec3(0.04, 0.04, 0.04));
    const SporeSphereSet *spheres = rig_spheres(rig, mesh.vertices, mesh.vertex_count, 0.005);
    SporeModel *model = rig_solid_model(&spore_neo_hookean_tetrahedra, &mesh, "young_modulus", 2e4, "mass_damping", 2.0,
                                        "stiffness_damping", 0.0, NULL);
    SporeBodyDescription *body = rig_passive(rig, "block", model, spheres);
    body->pose.position = spore_vec3(0, 0.006 + 0.052 * i, 0);
    body->contact = *contact;
  }
  return rig;
}

static SporeVec3 middle(const SporeWorld *world, uint32_t body) {
  SporeVec3 sum = {0, 0, 0};
  size_t n = spore_world_body_model(world, body)->node_count;
  for (size_t i = 0; i < n; i++)
    sum = spore_vec3_add_scaled(sum, 1.0 / (double)n, spore_vec3_load(spore_world_q(world, body) + 3 * i));
  return sum;
}

/* Runs, and counts the steps that another method had to solve. */
static unsigned solved_steps(SporeWorld *world, unsigned steps) {
  unsigned solved = 0;
  for (unsigned i = 0; i < steps; i++) {
    rig_run(world, 1);
    solved += spore_world_counts(world).newton_iterations > 0;
  }
  return solved;
}

/* One block, and one on the other, fall, come to rest, and press with their weight; none is solved for. */
static void rests_in_contact(gconstpointer data) {
  unsigned count = GPOINTER_TO_UINT(data);
  const SporeContactFields contact = {.stiffness = 2000, .damping = 2, .friction = 0.5};
  Rig *rig = blocks(count, 1e-3, &contact, spore_vec3(0, -9.81, 0));
  SporeWorld *world = rig_build(rig);
  SporeMethod method;
  for (unsigned i = 1; i <= count; i++) {
    g_assert_true(spore_world_body_method(world, i, &method));
    g_assert_cmpint(method.coupled, ==, SPORE_COUPLED_CONTACTS);
  }
  g_assert_cmpuint(solved_steps(world, 3000), ==, 0);
  SporeVec3 before = middle(world, count);
  rig_run(world, 500);
  SporeVec3 after = middle(world, count);
  double pressing = 0;
  const SporeSnapshot *snapshot = spore_world_snapshot_acquire(world);
  for (size_t i = 0; i < snapshot->contact_count; i++)
    if (snapshot->contacts[i].sphere_a == 0) pressing += fabs(snapshot->contacts[i].force.y);
  double weight = 9.81 * count * spore_model_total_mass(spore_world_body_model(world, 1));
  g_test_message("middle %.6g m, moved %.2g m, presses with %.6g N of %.6g N; %s", after.y,
                 spore_vec3_distance(before, after), pressing, weight, rig_last_message(world));
  g_assert_true(rig_finite(world));
  g_assert_cmpfloat(spore_vec3_distance(before, after), <, 1e-5);
  g_assert_cmpfloat(fabs(pressing - weight), <, 0.01 * weight);
  g_assert_cmpfloat(after.y, >, 0.05 * (count - 1) + 0.015);
  rig_free(rig);
}

/* On a slope a block stays where the slope is less than the friction, and slides where it is more, as fast as that
 * leaves. */
static void friction_holds(void) {
  const SporeContactFields contact = {.stiffness = 2000, .damping = 2, .friction = 0.5};
  for (int steep = 0; steep < 2; steep++) {
    double slope = steep ? 0.6 : 0.4;
    Rig *rig = blocks(1, 1e-3, &contact, spore_vec3(9.81 * slope, -9.81, 0));
    SporeWorld *world = rig_build(rig);
    rig_run(world, 1000);
    SporeVec3 before = middle(world, 1);
    rig_run(world, 500);
    double slid = middle(world, 1).x - before.x;
    g_test_message("slope %g: slid %.3g m in 0.5 s; %s", slope, slid, rig_last_message(world));
    /* a = (slope - friction) g, less damping by mass of d: v = a/d (1 - exp(-d t)) */
    double a = 9.81 * (slope - contact.friction), d = 2, way = a / d * (0.5 + (exp(-1.5 * d) - exp(-1 * d)) / d);
    if (steep) g_assert_cmpfloat(fabs(slid - way), <, 0.05 * way);
    else g_assert_cmpfloat(fabs(slid), <, 1e-4);
    rig_free(rig);
  }
}

/* However stiff the contact, however long the step, and however deep the body lies in the floor when it begins: it is
 * not thrown out faster than the law lets it go, and does not fall through. */
static void contact_bears_any_step(void) {
  static const double steps[] = {2e-2, 5e-3, 1e-3}, stiffness[] = {1e3, 1e5, 1e8};
  for (unsigned s = 0; s < G_N_ELEMENTS(steps); s++)
    for (unsigned k = 0; k < G_N_ELEMENTS(stiffness); k++)
      for (int deep = 0; deep < 2; deep++) {
        const SporeContactFields contact = {.stiffness = stiffness[k], .damping = 1, .friction = 0.3};
        Rig *rig = blocks(1, steps[s], &contact, spore_vec3(0, -9.81, 0));
        if (deep) g_array_index(rig->bodies, SporeBodyDescription, 1).pose.position.y = 0.002;
        SporeWorld *world = rig_build(rig);
        double highest = 0, lowest = 1;
        for (unsigned i = 0; i < rig_steps(400, 50); i++) {
          spore_world_step(world);
          highest = fmax(highest, middle(world, 1).y), lowest = fmin(lowest, middle(world, 1).y);
        }
        g_test_message("step %g s, %g N/m: middle %.3g to %.3g m; %s", steps[s], stiffness[k], lowest, highest,
                       rig_last_message(world));
        g_assert_true(rig_finite(world));
        g_assert_cmpfloat(lowest, >, -0.04);        /* the longest steps press it flat */
        g_assert_cmpfloat(highest, <, 0.25 + 0.03); /* 2 m/s upward go 0.2 m */
        g_assert_false(rig_any_frozen(world));
        rig_free(rig);
      }
}

/* What strikes the floor fast leaves it no faster, whatever its step and the law, and no other method is asked. */
static void strikes_without_gain(void) {
  static const double steps[] = {1e-2, 2e-3}, stiffness[] = {1e3, 1e5, 1e7};
  const double speed = 3;
  for (unsigned s = 0; s < G_N_ELEMENTS(steps); s++)
    for (unsigned k = 0; k < G_N_ELEMENTS(stiffness); k++) {
      const SporeContactFields contact = {.stiffness = stiffness[k]};
      Rig *rig = blocks(1, steps[s], &contact, spore_vec3(0, 0, 0));
      rig->description.solver.maximum_speed = 1000;
      SporeBodyDescription *body = &g_array_index(rig->bodies, SporeBodyDescription, 1);
      body->pose.position.y = 0.1, body->velocity = spore_vec3(0, -speed, 0);
      SporeWorld *world = rig_build(rig);
      double fastest = 0, lowest = 1;
      for (unsigned i = 0; i < (unsigned)lround(0.2 / steps[s]); i++) {
        double before = middle(world, 1).y;
        g_assert_cmpuint(solved_steps(world, 1), ==, 0);
        double now = middle(world, 1).y;
        fastest = fmax(fastest, (now - before) / steps[s]), lowest = fmin(lowest, now);
      }
      g_test_message("step %g s, %g N/m: leaves with %.3g m/s; %s", steps[s], stiffness[k], fastest,
                     rig_last_message(world));
      g_assert_cmpfloat(fastest, >, 0);
      g_assert_cmpfloat(fastest, <, speed);
      g_assert_cmpfloat(lowest, >, -0.02);
      rig_free(rig);
    }
}

static double contact_error(double step, SporeIntegratorKind kind, double **exact) {
  const SporeContactFields contact = {.stiffness = 300, .damping = 0.1, .friction = 0.2};
  Rig *rig = blocks(1, step, &contact, spore_vec3(3, -9.81, 0));
  rig->description.solver.integrator = (int)kind;
  SporeWorld *world = rig_build(rig);
  rig_run(world, (unsigned)lround(0.06 / step));
  size_t n = 3 * spore_world_body_model(world, 1)->node_count;
  double most = 0;
  if (!*exact) *exact = g_memdup2(spore_world_q(world, 1), n * sizeof **exact);
  else
    for (size_t i = 0; i < n; i++) most = fmax(most, fabs(spore_world_q(world, 1)[i] - (*exact)[i]));
  g_assert_true(kind != SPORE_INTEGRATOR_POSITION_BASED || spore_world_counts(world).contacts > 0);
  rig_free(rig);
  return most;
}

/* With friction and damping: half the step, half the error, to the motion that RK4 finds. */
static void contact_converges(void) {
  g_autofree double *exact = NULL;
  contact_error(1e-5, SPORE_INTEGRATOR_RK4, &exact);
  double coarse = contact_error(4e-4, SPORE_INTEGRATOR_POSITION_BASED, &exact),
         fine = contact_error(2e-4, SPORE_INTEGRATOR_POSITION_BASED, &exact);
  g_test_message("errors %.3g and %.3g m", coarse, fine);
  g_assert_cmpfloat(coarse, <, 1e-3);
  g_assert_cmpfloat(fine, <, 0.65 * coarse);
}

/* Blocks that are two islands: the same bits on one thread and on several, and when run again. */
static void same_bits(void) {
  const SporeContactFields contact = {.stiffness = 2000, .damping = 2, .friction = 0.5};
  g_autofree double *expected = NULL;
  for (int run = 0; run < 3; run++) {
    Rig *rig = blocks(2, 1e-3, &contact, spore_vec3(1, -9.81, 0));
    g_array_index(rig->bodies, SporeBodyDescription, 2).pose.position = spore_vec3(0.2, 0.006, 0);
    SporePool *pool = spore_pool_create(run == 0 ? 1 : 4);
    SporeWorld *world = rig_build_on(rig, pool);
    rig_run(world, 300);
    size_t size = 6 * spore_world_body_model(world, 1)->node_count * sizeof(double);
    if (run == 0) expected = g_memdup2(spore_world_q(world, 1), size);
    else g_assert_cmpmem(expected, size, spore_world_q(world, 1), size);
    rig_free(rig);
    spore_pool_free(pool);
  }
}

/* What touches a rigid body is not met: such steps are solved by implicit Euler, and that is told beforehand. */
static void rigid_falls_back(void) {
  const SporeContactFields contact = {.stiffness = 1e5, .damping = 2};
  Rig *rig = blocks(1, 2e-3, &contact, spore_vec3(0, -9.81, 0));
  SporeTriangleMesh cube;
  shape_box(&cube, spore_vec3(0, 0, 0), spore_vec3(0.02, 0.02, 0.02));
  SporeBodyDescription *ball =
      rig_passive(rig, "ball", rig_surface_model(&spore_rigid_body, &cube, "mass", 0.05, NULL), rig_sphere(rig, 0.02));
  ball->pose.position = spore_vec3(0.02, 0.08, 0.02);
  ball->contact = contact;
  SporeWorld *world = rig_build(rig);
  SporeMethod method;
  g_assert_true(spore_world_body_method(world, 1, &method));
  g_assert_cmpint(method.coupled, ==, SPORE_COUPLED_CONTACTS);
  g_assert_cmpuint(solved_steps(world, 100), >, 0);
  rig_free(rig);
}

static double *state_after(SporeIntegratorKind kind, const SporeModelType *type, double viscosity, size_t *count) {
  Rig *rig = rig_new();
  SporeTetrahedralMesh bar;
  shape_block(&bar, 4, 1, 1, spore_vec3(0.08, 0.02, 0.02));
  rig->description.solver.integrator = (int)kind;
  rig->description.solver.time_step = 5e-5;
  rig_passive(rig, "bar", rig_solid_model(type, &bar, "stiffness_damping", viscosity, NULL), NULL);
  rig_pin(rig, 0, spore_vec3(0, 0, 0), 1e-3);
  SporeWorld *world = rig_build(rig);
  rig_run(world, 50);
  *count = 3 * spore_world_body_model(world, 0)->node_count;
  double *q = g_memdup2(spore_world_q(world, 0), *count * sizeof *q);
  rig_free(rig);
  return q;
}

typedef struct Solid {
  const SporeModelType *type;
  double viscosity; /* s */
  bool met;
} Solid;

/* Solids that a sweep meets and others. */
static const Solid solids[] = {{&spore_neo_hookean_tetrahedra, 0, true},
                               {&spore_neo_hookean_tetrahedra, 1e-4, true},
                               {&spore_corotational_tetrahedra, 0, true},
                               {&spore_corotational_tetrahedra, 1e-4, false},
                               {&spore_saint_venant_kirchhoff_tetrahedra, 0, false}};

static void others_as_symplectic(void) {
  for (unsigned i = 0; i < G_N_ELEMENTS(solids); i++) {
    size_t count;
    g_autofree double *own = state_after(SPORE_INTEGRATOR_POSITION_BASED, solids[i].type, solids[i].viscosity, &count);
    g_autofree double *symplectic =
        state_after(SPORE_INTEGRATOR_SYMPLECTIC_EULER, solids[i].type, solids[i].viscosity, &count);
    g_assert_true((memcmp(own, symplectic, count * sizeof *own) != 0) == solids[i].met);
  }
}

/* Height of what swings, in its second second. */
static double swing(SporeIntegratorKind kind, double viscosity) {
  const double step = 5e-4;
  Rig *rig = rig_new();
  SporeTetrahedralMesh bar;
  shape_block(&bar, 6, 2, 2, spore_vec3(0.12, 0.04, 0.04));
  rig->description.gravity = spore_vec3(0, -1, 0);
  rig->description.solver.integrator = (int)kind;
  rig->description.solver.time_step = step;
  rig->description.solver.sleep_speed = 0;
  rig_passive(rig, "bar",
              rig_solid_model(&spore_neo_hookean_tetrahedra, &bar, "young_modulus", 1e4, "mass_damping", 0.0,
                              "stiffness_damping", viscosity, NULL),
              NULL);
  rig_pin(rig, 0, spore_vec3(-0.1, 0.02, 0.02), 0.105);
  SporeWorld *world = rig_build(rig);
  size_t tip = spore_world_body_model(world, 0)->node_count - 1;
  double lowest = 1, highest = -1;
  for (unsigned i = 0, from = (unsigned)lround(1 / step); i < 2 * from; i++) {
    rig_run(world, 1);
    if (i < from) continue;
    lowest = fmin(lowest, spore_world_q(world, 0)[3 * tip + 1]);
    highest = fmax(highest, spore_world_q(world, 0)[3 * tip + 1]);
  }
  rig_free(rig);
  return highest - lowest;
}

/* As much as the method of second order says, which solves each step. */
static void viscosity_damps(void) {
  static const double viscosities[] = {0, 2e-3, 1e-2};
  for (unsigned i = 0; i < G_N_ELEMENTS(viscosities); i++) {
    double swept = swing(SPORE_INTEGRATOR_POSITION_BASED, viscosities[i]),
           solved = swing(SPORE_INTEGRATOR_IMPLICIT_MIDPOINT, viscosities[i]);
    g_test_message("viscosity of %g s: swings by %.3g m, and by %.3g m solved", viscosities[i], swept, solved);
    g_assert_cmpfloat(fabs(swept - solved), <, 0.2 * solved);
  }
}

/* A body that no sweep meets has the largest step of symplectic Euler. */
static void others_are_refused(void) {
  for (unsigned i = 0; i < G_N_ELEMENTS(solids); i++) {
    Rig *rig = rig_new();
    SporeTetrahedralMesh bar;
    shape_block(&bar, 4, 1, 1, spore_vec3(0.08, 0.02, 0.02));
    rig->description.solver.integrator = SPORE_INTEGRATOR_POSITION_BASED;
    rig->description.solver.time_step = 0.05;
    rig_passive(
        rig, "bar",
        rig_solid_model(solids[i].type, &bar, "young_modulus", 1e6, "stiffness_damping", solids[i].viscosity, NULL),
        NULL);
    SporeError error = SPORE_ERROR_INIT;
    if (solids[i].met) {
      g_assert_nonnull(rig_try_build(rig, &error));
    } else {
      g_assert_null(rig_try_build(rig, &error));
      g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
      g_assert_nonnull(strstr(error.message, "position_based"));
    }
    rig_free(rig);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  for (Body body = NET; body < BODIES; body++) {
    const char *name = (const char *[]){"net", "tetrahedra", "viscous", "corotational"}[body];
    g_autofree char *path = g_strdup_printf("/position_based/converges/%s", name);
    g_test_add_data_func(path, GINT_TO_POINTER((int)body), converges);
    g_autofree char *other = g_strdup_printf("/position_based/bears_any_step/%s", name);
    g_test_add_data_func(other, GINT_TO_POINTER((int)body), bears_any_step);
  }
  g_test_add_func("/position_based/says_what_it_misses", says_what_it_misses);
  g_test_add_func("/position_based/others_as_symplectic", others_as_symplectic);
  g_test_add_func("/position_based/viscosity_damps", viscosity_damps);
  g_test_add_func("/position_based/others_are_refused", others_are_refused);
  g_test_add_data_func("/position_based/rests_in_contact/one", GUINT_TO_POINTER(1), rests_in_contact);
  g_test_add_data_func("/position_based/rests_in_contact/two", GUINT_TO_POINTER(2), rests_in_contact);
  g_test_add_func("/position_based/friction_holds", friction_holds);
  g_test_add_func("/position_based/contact_bears_any_step", contact_bears_any_step);
  g_test_add_func("/position_based/strikes_without_gain", strikes_without_gain);
  g_test_add_func("/position_based/contact_converges", contact_converges);
  g_test_add_func("/position_based/same_bits", same_bits);
  g_test_add_func("/position_based/rigid_falls_back", rigid_falls_back);
  return g_test_run();
}
