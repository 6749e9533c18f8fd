/* Position-based steps: they come to the same as others do, they bear any step, and what they cannot meet moves as by
 * symplectic Euler. */
#include <math.h>
#include <string.h>

#include "tests/stability/rig.h"

typedef enum Body { NET, TETRAHEDRA, BODIES } Body;

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
    shape_block(&bar, 6, 2, 2, spore_vec3(0.12, 0.04, 0.04));
    rig_passive(rig, "bar",
                rig_solid_model(&spore_neo_hookean_tetrahedra, &bar, "young_modulus", 1e4 * factor, "poisson_ratio",
                                0.45, "mass_damping", 0.5, "stiffness_damping", 0.0, NULL),
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

static double *state_after(SporeIntegratorKind kind, const char *viscosity, size_t *count) {
  Rig *rig = rig_new();
  SporeTetrahedralMesh bar;
  shape_block(&bar, 4, 1, 1, spore_vec3(0.08, 0.02, 0.02));
  rig->description.solver.integrator = (int)kind;
  rig->description.solver.time_step = 5e-5;
  rig_passive(rig, "bar",
              rig_solid_model(&spore_neo_hookean_tetrahedra, &bar, "stiffness_damping", atof(viscosity), NULL), NULL);
  rig_pin(rig, 0, spore_vec3(0, 0, 0), 1e-3);
  SporeWorld *world = rig_build(rig);
  rig_run(world, 50);
  *count = 3 * spore_world_body_model(world, 0)->node_count;
  double *q = g_memdup2(spore_world_q(world, 0), *count * sizeof *q);
  rig_free(rig);
  return q;
}

/* Viscous tetrahedra cannot be met one after the other. */
static void others_as_symplectic(void) {
  for (int viscous = 0; viscous < 2; viscous++) {
    size_t count;
    const char *viscosity = viscous ? "1e-4" : "0";
    g_autofree double *own = state_after(SPORE_INTEGRATOR_POSITION_BASED, viscosity, &count);
    g_autofree double *other = state_after(SPORE_INTEGRATOR_SYMPLECTIC_EULER, viscosity, &count);
    g_assert_true((memcmp(own, other, count * sizeof *own) == 0) == viscous);
  }
}

/* A body that no sweep meets has the largest step of symplectic Euler. */
static void others_are_refused(void) {
  Rig *rig = rig_new();
  SporeTetrahedralMesh bar;
  shape_block(&bar, 4, 1, 1, spore_vec3(0.08, 0.02, 0.02));
  rig->description.solver.integrator = SPORE_INTEGRATOR_POSITION_BASED;
  rig->description.solver.time_step = 0.05;
  rig_passive(rig, "bar", rig_solid_model(&spore_corotational_tetrahedra, &bar, "young_modulus", 1e6, NULL), NULL);
  SporeError error = SPORE_ERROR_INIT;
  g_assert_null(rig_try_build(rig, &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
  g_assert_nonnull(strstr(error.message, "position_based"));
  rig_free(rig);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  for (Body body = NET; body < BODIES; body++) {
    const char *name = body == NET ? "net" : "tetrahedra";
    g_autofree char *path = g_strdup_printf("/position_based/converges/%s", name);
    g_test_add_data_func(path, GINT_TO_POINTER((int)body), converges);
    g_autofree char *other = g_strdup_printf("/position_based/bears_any_step/%s", name);
    g_test_add_data_func(other, GINT_TO_POINTER((int)body), bears_any_step);
  }
  g_test_add_func("/position_based/says_what_it_misses", says_what_it_misses);
  g_test_add_func("/position_based/others_as_symplectic", others_as_symplectic);
  g_test_add_func("/position_based/others_are_refused", others_are_refused);
  return g_test_run();
}
