/* Multirate integration: an explicit net with substeps lies on implicit tissue, and tissue lies on such a net.
 */
#include <math.h>

#include "tests/stability/rig.h"

static const SporeIntegratorKind kinds[] = {SPORE_INTEGRATOR_SYMPLECTIC_EULER, SPORE_INTEGRATOR_VERLET,
                                            SPORE_INTEGRATOR_RK4};

static SporeBodyDescription *add_block(Rig *rig, double height, double stiffness) {
  SporeTetrahedralMesh mesh;
  shape_block(&mesh, 3, 2, 3, spore_vec3(0.03, 0.02, 0.03));
  const SporeSphereSet *spheres = rig_spheres(rig, mesh.vertices, mesh.vertex_count, 0.005);
  SporeModel *model = rig_tetrahedra_model(&mesh, "young_modulus", 2e4, NULL);
  SporeBodyDescription *body = rig_passive(rig, "block", model, spheres);
  body->pose.position = spore_vec3(-0.015, height, -0.015);
  body->integrator = SPORE_INTEGRATOR_IMPLICIT_EULER;
  body->contact.stiffness = stiffness;
  return body;
}

static SporeBodyDescription *add_net(Rig *rig, double height, SporeIntegratorKind kind, double stiffness) {
  SporeTriangleMesh sheet;
  shape_sheet(&sheet, 9, 9, 0.008, TRUE);
  const SporeSphereSet *spheres = rig_spheres(rig, sheet.vertices, sheet.vertex_count, 0.003);
  SporeBodyDescription *body =
      rig_passive(rig, "net", rig_surface_model(&spore_mass_spring_net, &sheet, NULL), spheres);
  body->pose = (SporePose){{-0.032, height, 0.032}, spore_quat_from_rotation_vector(spore_vec3(-G_PI / 2, 0, 0))};
  body->integrator = kind;
  body->substeps = 20;
  body->contact.stiffness = stiffness;
  return body;
}

/* Energy above the start at most, J; what contacts hold is left out: they are met at full depth where a step finds
 * them. Of the steps, in *touching how many had contacts, and in *solved how many of these needed the solver. */
static double highest(SporeWorld *world, unsigned steps, unsigned *touching, unsigned *solved) {
  SporeEnergy start = spore_world_energy(world);
  double most = -HUGE_VAL;
  for (unsigned i = 0; i < steps; i++) {
    spore_world_step(world);
    SporeEnergy now = spore_world_energy(world);
    most = fmax(most, now.kinetic + now.gravity + now.internal - start.kinetic - start.gravity - start.internal);
    SporeStepCounts counts = spore_world_counts(world);
    *touching += counts.contacts > 0;
    *solved += counts.contacts > 0 && counts.newton_iterations > 0;
  }
  return most;
}

static double lowest(const SporeWorld *world, uint32_t body) {
  const double *q = spore_world_q(world, body);
  double low = HUGE_VAL;
  for (size_t i = 0; i < spore_world_body_model(world, body)->block_count; i++) low = fmin(low, q[3 * i + 1]);
  return low;
}

static void drape(void) {
  unsigned steps = rig_steps(300, 150);
  for (unsigned k = 0; k < G_N_ELEMENTS(kinds); k++)
    for (double stiffness = 1e2; stiffness < 1e6; stiffness *= 1e3) {
      Rig *rig = rig_new();
      unsigned touching = 0, solved = 0;
      rig->description.gravity = spore_vec3(0, -9.81, 0);
      rig_unmovable(rig, "floor", rig_floor(rig, 16, 16, 0.008, 0.006))->contact.stiffness = stiffness;
      add_block(rig, 0.005, stiffness);
      add_net(rig, 0.04, kinds[k], stiffness);
      SporeWorld *world = rig_build(rig);
      double most = highest(world, steps, &touching, &solved),
             fallen = 9.81 * 0.01 * spore_model_total_mass(spore_world_body_model(world, 2));
      const SporeMonitor *monitor = spore_world_monitor(world);
      double spread = spore_world_q(world, 2)[1];
      g_test_message(
          "drape: %s, contacts of %.0e N/m: energy at most %+.1e J above the start (%.1e J a cm), net down to "
          "%.4f m, block to %.4f m, %u recoveries, %u not converged, corner at %.3f m, %s",
          spore_integrator_names[kinds[k]], stiffness, most, fallen, lowest(world, 2), lowest(world, 1),
          (unsigned)monitor->recoveries, (unsigned)monitor->not_converged, spread, rig_last_message(world));
      g_assert_true(rig_finite(world));
      g_assert_false(rig_any_frozen(world));
      g_assert_cmpuint(solved, >, steps / 5);
      g_assert_cmpfloat(most, <=, 0.05 * fallen);
      rig_free(rig);
    }
}

/* Tissue falls on a net that is held at its corners. */
static void catch_block(void) {
  unsigned steps = rig_steps(500, 250);
  for (unsigned k = 0; k < G_N_ELEMENTS(kinds); k++) {
    Rig *rig = rig_new();
    unsigned touching = 0, solved = 0;
    rig->description.gravity = spore_vec3(0, -9.81, 0);
    add_block(rig, 0.012, 1e5);
    add_net(rig, 0, kinds[k], 1e5);
    for (int c = 0; c < 4; c++) rig_pin(rig, 1, spore_vec3(c & 1 ? 0.032 : -0.032, 0, c & 2 ? 0.032 : -0.032), 1e-3);
    SporeWorld *world = rig_build(rig);
    double most = highest(world, steps, &touching, &solved),
           fallen = 9.81 * 0.01 * spore_model_total_mass(spore_world_body_model(world, 0));
    g_test_message("catch: %s: energy at most %+.1e J above the start (%.1e J a cm), net down to %.4f m, block to %.4f "
                   "m, %u recoveries, %s",
                   spore_integrator_names[kinds[k]], most, fallen, lowest(world, 1), lowest(world, 0),
                   (unsigned)spore_world_monitor(world)->recoveries, rig_last_message(world));
    g_assert_true(rig_finite(world));
    g_assert_false(rig_any_frozen(world));
    g_assert_cmpuint(solved, >, steps / 5);
    g_assert_cmpfloat(most, <=, 0.05 * fallen);
    g_assert_cmpfloat(lowest(world, 0), >, lowest(world, 1)); /* it lies on it */
    rig_free(rig);
  }
}

/* A drop falls on a floor of the same law, without friction. How many of the steps in which it touches the floor needed
 * the solver. */
static unsigned pour(double stiffness, double damping) {
  Rig *rig = rig_new();
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(-0.004, -0.004, -0.004), spore_vec3(0.004, 0.004, 0.004));
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.time_step = 2e-5;
  SporeModel *model = rig_fluid_model(&box, 60, NULL);
  SporeSphereSet *spheres = g_new0(SporeSphereSet, 1);
  g_assert_true(model->type->spheres(model, spheres, NULL));
  g_ptr_array_add(rig->sets, spheres);
  SporeContactFields law = {.stiffness = stiffness, .damping = damping};
  rig_unmovable(rig, "floor", rig_floor(rig, 8, 8, 0.002, 0.002))->contact = law;
  SporeBodyDescription *blood = rig_passive(rig, "blood", model, spheres);
  blood->contact = law;
  blood->pose.position = spore_vec3(0, 0.0065, 0);
  blood->velocity = spore_vec3(0, -0.1, 0);
  blood->integrator = SPORE_INTEGRATOR_VERLET;
  SporeWorld *world = rig_build(rig);
  unsigned touching = 0, solved = 0;
  double falls = spore_world_energy(world).kinetic, most = highest(world, 1500, &touching, &solved);
  g_test_message(
      "contacts of %g N/m, %g N s/m: %u steps touching, %u of them by the solver; energy at most %+.1e above "
      "the start, in %.1e J of the fall",
      stiffness, damping, touching, solved, most, falls);
  g_assert_true(rig_finite(world));
  g_assert_cmpuint(touching, >, 20);
  g_assert_cmpfloat(most, <, 0.01 * falls);
  rig_free(rig);
  return solved;
}

/* Particles meet contacts whose damping a few substeps resolve in these, and others in a stage of implicit Euler. */
static void few_substeps(void) {
  g_assert_cmpuint(pour(100, 0.02), ==, 0);
  g_assert_cmpuint(pour(100, 0.2), >, 0);
  g_assert_cmpuint(pour(2e4, 0.02), >, 0);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/stability/multirate/drape", drape);
  g_test_add_func("/stability/multirate/catch", catch_block);
  g_test_add_func("/stability/multirate/few-substeps", few_substeps);
  return g_test_run();
}
