/* A trial gives what its run was: a mass on a spring moves as the formula says, better with smaller steps, and a
 * perturbed start gives a difference of the size of the perturbation. */
#include <glib.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/measure/trial.h"
#include "tests/sim/chain_model.h"

#define FREQUENCY 20. /* rad/s */
#define INTERVAL 0.01
#define SAMPLES 50

/* Two masses, each on a spring of its own; gravity moves their middle down at time 0. */
static SporeWorld *make(SporeIntegratorKind kind, double dt_s) {
  ChainFields fields = {
      .count = 2, .mass = 0.5, .spacing = 0.1, .anchor = 0.5 * FREQUENCY * FREQUENCY, .poison_at = HUGE_VAL};
  SporeBodyDescription body = passive_body("masses", chain_create(fields), spore_vec3(0, 0, 0));
  SporeWorldDescription description = world_description(&body, 1);
  description.gravity = spore_vec3(0, -9.81, 0);
  description.solver.integrator = kind;
  description.solver.time_step = dt_s;
  description.solver.sleep_speed = 0;
  description.solver.tolerance = 1e-12;
  SporeError error = SPORE_ERROR_INIT;
  SporeWorld *world = spore_world_create(&description, NULL, &error);
  if (!world) g_error("%s", error.message);
  return world;
}

static SporeTrial run(SporeTrialPoints *points, SporeIntegratorKind kind, double dt_s, double perturbation) {
  SporeWorld *world = make(kind, dt_s);
  SporeError error = SPORE_ERROR_INIT;
  const SporeTrialSettings settings = {
      .interval_s = INTERVAL, .samples = SAMPLES, .dt_s = dt_s, .perturbation = perturbation};
  SporeTrial trial;
  if (!points->bodies && !spore_trial_points_choose(points, world, SPORE_NO_BODY, &error)) g_error("%s", error.message);
  if (!spore_trial_run(&trial, world, points, &settings, &error)) g_error("%s", error.message);
  spore_world_free(world);
  g_assert_cmpuint(trial.samples, ==, SAMPLES + 1);
  g_assert_cmpuint(trial.steps, ==, (size_t)round(SAMPLES * INTERVAL / dt_s));
  g_assert_true(trial.stable && trial.finite && !trial.cancelled);
  return trial;
}

/* Largest distance from y = -g / w^2 (1 - cos w t). */
static double exact_error(const SporeTrial *trial) {
  double worst = 0;
  for (size_t s = 0; s < trial->samples; s++) {
    double y = -9.81 / (FREQUENCY * FREQUENCY) * (1 - cos(FREQUENCY * INTERVAL * (double)s));
    worst = fmax(worst, fabs(trial->positions[6 * s + 1] - y));
    worst = fmax(worst, fabs(trial->positions[6 * s + 4] - y));
  }
  return worst;
}

static void test_exact(void) {
  static const struct {
    SporeIntegratorKind kind;
    double order;
  } methods[] = {{SPORE_INTEGRATOR_IMPLICIT_EULER, 1},
                 {SPORE_INTEGRATOR_SYMPLECTIC_EULER, 1},
                 {SPORE_INTEGRATOR_TR_BDF2, 2},
                 {SPORE_INTEGRATOR_RK4, 4}};
  SporeTrialPoints points = {0};
  for (size_t i = 0; i < G_N_ELEMENTS(methods); i++) {
    SporeTrial coarse = run(&points, methods[i].kind, 1e-3, 0), fine = run(&points, methods[i].kind, 5e-4, 0);
    double order = log2(exact_error(&coarse) / exact_error(&fine));
    g_assert_cmpfloat_with_epsilon(order, methods[i].order, 0.2);
    g_assert_cmpfloat(coarse.kinetic[20], >, 0);
    spore_trial_clear(&coarse);
    spore_trial_clear(&fine);
  }
  g_assert_cmpfloat_with_epsilon(points.bodies[0].length, 0.1, 1e-12);
  spore_trial_points_clear(&points);
}

/* Linear springs let a perturbation swing, and not grow. */
static void test_difference(void) {
  SporeTrialPoints points = {0};
  SporeTrial a = run(&points, SPORE_INTEGRATOR_RK4, 1e-3, 0), b = run(&points, SPORE_INTEGRATOR_RK4, 1e-3, 1e-6);
  SporeTrialDifference same = spore_trial_difference(&points, &a, &a), other = spore_trial_difference(&points, &a, &b);
  g_assert_cmpfloat(same.rms, ==, 0);
  g_assert_cmpfloat(other.rms, >, 1e-8);
  g_assert_cmpfloat(other.rms, <, 2e-6);
  g_assert_cmpfloat(other.worst, >=, other.rms);
  b.positions[5] = NAN;
  b.finite = false;
  g_assert_true(isinf(spore_trial_difference(&points, &a, &b).rms));
  spore_trial_clear(&a);
  spore_trial_clear(&b);
  spore_trial_points_clear(&points);
}

/* Two clouds of the same body in a sample: which particle is where is no matter, how many there are is. */
static void test_cloud(void) {
  double centre[2][3] = {{0, 0, 0}, {0.3, 0.4, 0}}, spread[2] = {0.1, 0.1}, present[2] = {4, 4};
  SporeTrial a = {.centre = centre[0], .spread = &spread[0], .present = &present[0]};
  SporeTrial b = {.centre = centre[1], .spread = &spread[1], .present = &present[1]};
  g_assert_cmpfloat(spore_trial_cloud_square(&a, 0, &a, 0, 1), ==, 0);
  g_assert_cmpfloat_with_epsilon(spore_trial_cloud_square(&a, 0, &b, 0, 1), 0.25, 1e-12);
  g_assert_cmpfloat_with_epsilon(spore_trial_cloud_square(&a, 0, &b, 0, 0.5), 1, 1e-12);
  spread[1] = 0.2;
  g_assert_cmpfloat_with_epsilon(spore_trial_cloud_square(&a, 0, &b, 0, 1), 0.26, 1e-12);
  present[1] = 2; /* half of them are missing */
  g_assert_cmpfloat_with_epsilon(spore_trial_cloud_square(&a, 0, &b, 0, 1), 0.51, 1e-12);
  present[1] = 0; /* all are: where they would be means nothing */
  g_assert_cmpfloat(spore_trial_cloud_square(&a, 0, &b, 0, 1), ==, 1);
  present[0] = 0;
  g_assert_cmpfloat(spore_trial_cloud_square(&a, 0, &b, 0, 1), ==, 0);
}

static bool at_once(void *data) {
  ++*(int *)data;
  return true;
}

static void test_cancelled(void) {
  int asked = 0;
  const SporeCancel cancel = {at_once, &asked};
  const SporeTrialSettings settings = {.interval_s = INTERVAL, .samples = 10, .dt_s = 1e-3, .cancel = &cancel};
  SporeWorld *world = make(SPORE_INTEGRATOR_RK4, 1e-3);
  SporeTrialPoints points;
  SporeTrial trial;
  g_assert_true(spore_trial_points_choose(&points, world, 0, NULL));
  g_assert_true(spore_trial_run(&trial, world, &points, &settings, NULL));
  g_assert_true(trial.cancelled);
  g_assert_cmpint(asked, ==, 1);
  spore_trial_clear(&trial);
  spore_trial_points_clear(&points);
  spore_world_free(world);
}

/* Each allocation fails in turn. */
static void test_memory(void) {
  SporeWorld *world = make(SPORE_INTEGRATOR_RK4, 1e-3);
  const SporeTrialSettings settings = {.interval_s = INTERVAL, .samples = 2, .dt_s = 1e-3, .perturbation = 1e-8};
  bool done = false;
  for (uint64_t n = 1; !done; n++) {
    SporeTrialPoints points = {0};
    SporeTrial trial = {0};
    SporeError error = SPORE_ERROR_INIT;
    spore_world_reset(world);
    spore_allocation_fail_at(n);
    bool good = spore_trial_points_choose(&points, world, 0, &error) &&
                spore_trial_run(&trial, world, &points, &settings, &error);
    done = n > 60; /* beyond all of them */
    spore_allocation_fail_at(0);
    if (!good) g_assert_cmpint(error.code, ==, SPORE_ERROR_MEMORY);
    if (n < 5) g_assert_false(good);
    if (done) g_assert_true(good);
    spore_trial_clear(&trial);
    spore_trial_points_clear(&points);
  }
  spore_world_free(world);
}

static void test_step(void) {
  g_assert_cmpfloat(spore_trial_step(0.016, 0.004), ==, 0.004);
  g_assert_cmpfloat(spore_trial_step(0.016, 0.1), ==, 0.016);
  g_assert_cmpfloat(spore_trial_step(0.016, 0.003), ==, 0.016 / 6);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/trial/exact", test_exact);
  g_test_add_func("/trial/difference", test_difference);
  g_test_add_func("/trial/cloud", test_cloud);
  g_test_add_func("/trial/cancelled", test_cancelled);
  g_test_add_func("/trial/memory", test_memory);
  g_test_add_func("/trial/step", test_step);
  return g_test_run();
}
