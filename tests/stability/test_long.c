/* Ten million steps: case 24. */
#include <math.h>

#include "tests/stability/chain.h"
#include "tests/stability/rig.h"

#define WINDOW 100000u

/* Mean energy over a window of steps: what goes round within a period averages out, what drifts stays. */
static double mean_energy(SporeWorld *world) {
  double sum = 0;
  for (unsigned i = 0; i < WINDOW; i += 10) {
    rig_run(world, 10);
    sum += rig_energy(world);
  }
  return sum / (WINDOW / 10);
}

/* A weight of 1 g on a stiff spring of 0.1 m, let go 60 degrees from straight down: some 16,000 swings. */
static void case_24_pendulum(void) {
  const double stiffness = 40, mass[2] = {1e-3, 1e-3}, length = 0.1, g = 9.81;
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(g * sin(G_PI / 3), -g * cos(G_PI / 3), 0);
  rig->description.solver.time_step = 1e-3;
  rig->description.solver.integrator = SPORE_INTEGRATOR_SYMPLECTIC_EULER;
  rig_passive(rig, "pendulum", chain_new(1, length, &stiffness, mass, 0), NULL);
  rig_pin(rig, 0, spore_vec3(0, 0, 0), 1e-3);
  SporeWorld *world = rig_build(rig);
  double swing = mass[1] * g * length * (1 - cos(G_PI / 3)); /* J, from the highest to the lowest point */
  unsigned steps = rig_steps(10000000, 1000000);
  double first = mean_energy(world), worst = 0;
  for (unsigned done = WINDOW; done < steps; done += steps / 10) {
    rig_run(world, steps / 10 - WINDOW);
    worst = fmax(worst, fabs(mean_energy(world) - first) / swing);
  }
  g_test_message("case 24: pendulum, %u steps: mean energy off by at most %.2e of a swing's",
                 (unsigned)spore_world_step_count(world), worst);
  g_assert_cmpuint(spore_world_step_count(world), >=, steps);
  g_assert_cmpfloat(worst, <, 1e-3);
  rig_free(rig);
}

/* A drop so cold that none of its particles leaves; they swing against each other some 100,000 times. */
static void case_24_fluid(void) {
  SporeTriangleMesh cube;
  shape_box(&cube, spore_vec3(0, 0, 0), spore_vec3(0.006, 0.006, 0.003));
  SporeModel *model = rig_fluid_model(&cube, 16, "temperature", 0.05, NULL);
  double frequency, damping;
  model->type->rates(model, &frequency, &damping);
  Rig *rig = rig_new();
  rig->description.solver.time_step = 0.25 / frequency;
  rig_passive(rig, "drop", model, NULL);
  SporeWorld *world = rig_build(rig);
  double worst = 0;
  unsigned steps = rig_steps(10000000, 1000000);
  rig_run(world, WINDOW); /* it finds its shape */
  double first = mean_energy(world);
  for (unsigned done = 2 * WINDOW; done < steps; done += steps / 10) {
    rig_run(world, steps / 10 - WINDOW);
    worst = fmax(worst, fabs(mean_energy(world) / first - 1));
  }
  g_test_message("case 24: %u particles, %u steps of %.2g s: mean energy %.3e J, off by at most %.2e",
                 (unsigned)model->block_count, (unsigned)spore_world_step_count(world),
                 rig->description.solver.time_step, first, worst);
  g_assert_cmpuint(spore_world_step_count(world), >=, steps);
  g_assert_cmpfloat(worst, <, 1e-6);
  rig_free(rig);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/stability/24_long/pendulum", case_24_pendulum);
  g_test_add_func("/stability/24_long/fluid", case_24_fluid);
  return g_test_run();
}
