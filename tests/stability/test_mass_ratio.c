/* Joints between rigid bodies of very different mass: case 42. */
#include <math.h>

#include "tests/stability/rig.h"

#define LINKS 10
#define G 9.81
#define STIFFNESS 1e6 /* N/m */

/* How the masses lie along the chain, from the top. */
typedef enum Order { LIGHT_ABOVE_HEAVY, HEAVY_ABOVE_LIGHT, RISING, ORDERS } Order;
static const char *const order_names[ORDERS] = {"one heavy below nine light", "one heavy above nine light",
                                                "rising from light to heavy"};

static double mass_of(Order order, int i, double ratio) {
  if (order == RISING) return 1e-3 * pow(ratio, i / (LINKS - 1.0));
  bool heavy = i == (order == LIGHT_ABOVE_HEAVY ? LINKS - 1 : 0);
  return heavy ? 1e-3 * ratio : 1e-3;
}

static SporeModel *rod(double mass) {
  SporeTriangleMesh mesh;
  shape_box(&mesh, spore_vec3(0, 0, 0), spore_vec3(0.02, 0.1, 0.02));
  return rig_surface_model(&spore_rigid_body, &mesh, "mass", mass, NULL);
}

/* Ten rods of 10 cm, one below the other, each hung from the one above by a ball joint that damps the heaviest
 * critically. below: what hangs on each joint, kg. */
static SporeWorld *hang(Rig *rig, Order order, double ratio, double below[LINKS]) {
  static const char *const names[LINKS] = {"0", "1", "2", "3", "4", "5", "6", "7", "8", "9"};
  rig->description.gravity = spore_vec3(0, -G, 0);
  double sum = 0;
  for (int i = LINKS - 1; i >= 0; i--) below[i] = sum += mass_of(order, i, ratio);
  for (int i = 0; i < LINKS; i++) {
    SporeBodyDescription *body = rig_passive(rig, names[i], rod(mass_of(order, i, ratio)), NULL);
    body->pose.position = spore_vec3(0, -0.1 * i, 0);
    uint32_t above = i > 0 ? (uint32_t)i - 1 : SPORE_NO_BODY;
    SporeLinkDescription *ball =
        rig_link(rig, names[i], &spore_link_ball, (uint32_t)i, above, spore_vec3(0, 0.05 - 0.1 * i, 0));
    ball->stiffness = STIFFNESS;
    ball->damping = 2 * sqrt(STIFFNESS * 1e-3 * ratio);
  }
  return rig_build(rig);
}

/* Largest relative error of the joints' loads after 5 s, which is rest. */
static double load_error(SporeIntegratorKind integrator, double h, Order order, double ratio) {
  Rig *rig = rig_new();
  double below[LINKS], worst = 0;
  rig->description.solver.time_step = h;
  rig->description.solver.integrator = integrator;
  SporeWorld *world = hang(rig, order, ratio, below);
  rig_run(world, (unsigned)lround(5 / h));
  for (int i = 0; i < LINKS; i++)
    worst = fmax(worst, fabs(spore_world_link_state(world, (size_t)i).load / (below[i] * G) - 1));
  const SporeMonitor *monitor = spore_world_monitor(world);
  g_test_message("case 42: %s, %g ms, mass ratio %g, %s: loads off by at most %.1e, not converged %u, taken again %u",
                 spore_integrator_names[integrator], 1e3 * h, ratio, order_names[order], worst,
                 (unsigned)monitor->not_converged, (unsigned)monitor->recoveries);
  g_assert_cmpuint(monitor->not_converged, ==, 0);
  g_assert_cmpuint(monitor->recoveries, ==, 0);
  rig_free(rig);
  return worst;
}

/* Case 42: each joint bears the weight of what hangs below. */
static void case_42(gconstpointer data) {
  SporeIntegratorKind integrator = (SporeIntegratorKind)GPOINTER_TO_INT(data);
  static const double steps[] = {0.01, 0.001};
  for (unsigned s = 0; s < (tests_sanitized ? 1 : G_N_ELEMENTS(steps)); s++)
    for (double ratio = 1; ratio < 2e6; ratio *= 1e3)
      for (Order order = 0; order < ORDERS; order++)
        g_assert_cmpfloat(load_error(integrator, steps[s], order, ratio), <, 0.01);
}

int main(int argc, char **argv) {
  static const SporeIntegratorKind kinds[] = {
      SPORE_INTEGRATOR_VERLET, SPORE_INTEGRATOR_IMPLICIT_EULER, SPORE_INTEGRATOR_IMPLICIT_MIDPOINT,
      SPORE_INTEGRATOR_BDF2,   SPORE_INTEGRATOR_TR_BDF2,        SPORE_INTEGRATOR_STATIC};
  g_test_init(&argc, &argv, NULL);
  for (unsigned k = 0; k < G_N_ELEMENTS(kinds); k++) {
    g_autofree char *name = g_strdup_printf("/stability/42_mass_ratio/%s", spore_integrator_names[kinds[k]]);
    g_test_add_data_func(name, GINT_TO_POINTER(kinds[k]), case_42);
  }
  return g_test_run();
}
