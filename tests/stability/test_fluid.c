/* Fluids: case 27, and a drop that spreads on a slope. */
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

#define TILT 0.2 /* rad */
#define SIDE_M 0.014

typedef struct Spread {
  double along, height, kept; /* m between its 10th and 90th part down the slope; mean over the slope, m; share */
} Spread;

static int compare(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Share of the pairs that were neighbours in `before` and are still. */
static double kept_pairs(const double *before, const double *now, size_t count, double reach) {
  size_t were = 0, are = 0;
  for (size_t i = 0; i < count; i++)
    for (size_t j = 0; j < i; j++) {
      if (spore_vec3_distance(spore_vec3_load(before + 3 * i), spore_vec3_load(before + 3 * j)) > reach) continue;
      were++;
      are += spore_vec3_distance(spore_vec3_load(now + 3 * i), spore_vec3_load(now + 3 * j)) <= reach;
    }
  return were > 0 ? (double)are / (double)were : 1;
}

static const SporeSphereSet *own_spheres(Rig *rig, const SporeModel *model) {
  SporeSphereSet *set = g_new0(SporeSphereSet, 1);
  SporeError error = SPORE_ERROR_INIT;
  if (!model->type->spheres(model, set, &error)) g_error("%s", error.message);
  g_ptr_array_add(rig->sets, set);
  return set;
}

/* A cube of blood, put onto a floor that is tilted by turning gravity. Neighbours are followed over the
 * second half. */
static Spread spread_of(double temperature, double thermostat) {
  SporeTriangleMesh cube;
  shape_box(&cube, spore_vec3(0, 0.5 * SIDE_M + 0.001, 0), spore_vec3(SIDE_M, SIDE_M, SIDE_M));
  Rig *rig = rig_new();
  rig->description.solver.time_step = 1e-4;
  rig->description.gravity = spore_vec3(9.81 * sin(TILT), -9.81 * cos(TILT), 0);
  SporeBodyDescription *slope = rig_unmovable(rig, "slope", rig_floor(rig, 60, 30, 0.005, 0.006));
  slope->contact.damping = 0.05, slope->contact.friction = 1;
  SporeModel *model = rig_fluid_model(&cube, 200, "temperature", temperature, "thermostat", thermostat, NULL);
  SporeBodyDescription *blood = rig_passive(rig, "blood", model, own_spheres(rig, model));
  blood->contact.stiffness = 60, blood->contact.damping = 0.05, blood->contact.friction = 1; /* a liquid sticks */
  SporeWorld *world = rig_build(rig);
  uint32_t body = 1;
  size_t n = model->block_count;
  double *along = g_new(double, n), height = 0;
  unsigned steps = rig_steps(3000, 200);
  rig_run(world, steps);
  double *before = g_memdup2(spore_world_q(world, body), 3 * n * sizeof *before);
  rig_run(world, steps);
  const double *q = spore_world_q(world, body);
  for (size_t i = 0; i < n; i++) along[i] = q[3 * i], height += q[3 * i + 1] / (double)n;
  qsort(along, n, sizeof *along, compare);
  Spread found = {.along = along[9 * n / 10] - along[n / 10], .height = height};
  found.kept = kept_pairs(before, q, n, 1.5 * cbrt(0.8442 * SIDE_M * SIDE_M * SIDE_M / (double)n));
  g_test_message(
      "temperature %.2f, thermostat %g: spread over %.1f mm, %.1f mm high, %.0f %% of neighbours kept; unsolved: %zu",
      temperature, thermostat, 1e3 * found.along, 1e3 * found.height, 100 * found.kept,
      spore_world_unsolved_count(world));
  g_assert_true(rig_finite(world));
  g_assert_cmpuint(spore_world_unsolved_count(world), ==, 0);
  g_free(along);
  g_free(before);
  rig_free(rig);
  return found;
}

/* Blood that is kept warm runs down as a layer whose particles change places. Blood that sets slides as a lump. */
static void test_slope(void) {
  Spread liquid = spread_of(0.7, 200), lump = spread_of(0, 0);
  if (tests_sanitized) return;
  g_assert_cmpfloat(liquid.along, >, 1.5 * lump.along);
  g_assert_cmpfloat(liquid.height, <, lump.height);
  g_assert_cmpfloat(liquid.kept, <, 0.5);
  g_assert_cmpfloat(lump.kept, >, 0.8);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/stability/27_too_near", case_27);
  g_test_add_func("/fluid/slope", test_slope);
  return g_test_run();
}
