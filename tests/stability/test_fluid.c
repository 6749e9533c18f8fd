/* Fluids: case 27. */
#include <math.h>
#include <string.h>

#include "tests/stability/rig.h"

/* Case 27: pairs of particles start at a hundredth of sigma, some at one place. */
static void case_27(void) {
  SporeTriangleMesh cube;
  shape_box(&cube, spore_vec3(0, 0, 0), spore_vec3(0.02, 0.02, 0.02));
  SporeModel *model = rig_fluid_model(&cube, 300, NULL);
  double frequency, damping, mass = model->block_mass[0];
  model->type->rates(model, &frequency, &damping);
  Rig *rig = rig_new();
  rig->description.solver.time_step = 1.65 / frequency; /* all but the largest */
  rig_passive(rig, "blood", model, NULL);
  SporeWorld *world = rig_build(rig);
  size_t n = model->q_count, count = model->block_count;
  double *q = g_memdup2(spore_world_q(world, 0), n * sizeof(double)), *v = g_new0(double, n), *f = g_new0(double, n);
  double sigma = cbrt(0.8442 * mass / 1060), strongest = 0;
  for (size_t i = 0; i + 1 < 40; i += 2) {
    memcpy(q + 3 * (i + 1), q + 3 * i, 3 * sizeof *q);
    q[3 * (i + 1) + i % 3] += i < 30 ? 0.01 * sigma : 0;
  }
  rig_run(world, 10);
  g_assert_cmpuint(spore_world_unsolved_count(world), ==, 0); /* as it was made, nothing is capped */
  spore_world_reset(world);
  spore_world_set_state(world, 0, q, v);
  model->type->force(model, q, q, v, f);
  for (size_t i = 0; i < count; i++) strongest = fmax(strongest, spore_vec3_length(spore_vec3_load(f + 3 * i)));
  double start = rig_energy(world), most = -HUGE_VAL, fastest = 0;
  for (int i = 0; i < 5000; i++) {
    spore_world_step(world);
    most = fmax(most, rig_energy(world));
    for (size_t k = 0; k < count; k++)
      fastest = fmax(fastest, spore_vec3_length(spore_vec3_load(spore_world_v(world, 0) + 3 * k)));
  }
  /* In the core the force grows no more: what two particles at its edge push each other with, from either side. */
  double cap = mass * frequency * frequency / 6 * 0.7 * sigma;
  g_test_message("case 27: 15 pairs at 0.01 sigma and 5 at one place: forces up to %.2e N, capped at %.2e N; energy "
                 "%.3e J at first, %.3e J at most; up to %.1f m/s; %s",
                 strongest, cap, start, most, fastest, rig_last_message(world));
  g_assert_true(rig_finite(world));
  g_assert_false(rig_any_frozen(world));
  g_assert_cmpfloat(strongest, <, 10 * cap); /* a few neighbours at once */
  g_assert_cmpfloat(most, <, 1.5 * start);
  g_assert_true(rig_said(world, "blood: particles are so near each other"));
  g_assert_cmpuint(spore_world_monitor(world)->message_count, ==, 1); /* once */
  bool is_said = false; /* the energy that capped forces make is said too */
  for (size_t i = 0; i < spore_world_unsolved_count(world); i++)
    is_said |= strstr(spore_world_unsolved(world, i).cause, "its model is not meant for") != NULL;
  g_assert_true(is_said);
  g_free(q);
  g_free(v);
  g_free(f);
  rig_free(rig);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/stability/27_too_near", case_27);
  return g_test_run();
}
