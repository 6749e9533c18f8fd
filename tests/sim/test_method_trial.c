/* A method tried on one body: its largest step is the one of linear theory, damping and all, and an instability that is
 * built into a model is found at any step. */
#include <glib.h>
#include <math.h>

#include "core/sim/solve/method_trial.h"
#include "tests/sim/chain_model.h"

#define FREQUENCY 200. /* rad/s */

/* A mass of .5 kg on a spring to its place. damping: as a part of the critical damping. */
static SporeWorld *spring_and_mass(double damping) {
  ChainFields fields = {.count = 1,
                        .mass = 0.5,
                        .spacing = 0.01,
                        .anchor = 0.5 * FREQUENCY * FREQUENCY,
                        .damping = 2 * damping * 0.5 * FREQUENCY,
                        .poison_at = HUGE_VAL};
  SporeBodyDescription body = passive_body("mass", chain_create(fields), spore_vec3(0, 0, 0));
  SporeWorldDescription description = world_description(&body, 1);
  description.gravity = spore_vec3(0, -9.81, 0);
  SporeError error = SPORE_ERROR_INIT;
  SporeWorld *world = spore_world_create(&description, NULL, &error);
  if (!world) g_error("%s", error.message);
  return world;
}

static SporeMethodOutcome outcome(SporeWorld *world, SporeIntegratorKind kind, double step_s, size_t steps) {
  return spore_world_try_method(world, 0, &(SporeMethodTrial){kind, step_s, steps}).outcome;
}

/* Just below `limit` every motion stays bounded, and just above none does. */
static void assert_limit(double damping, SporeIntegratorKind kind, double limit_s) {
  SporeWorld *world = spring_and_mass(damping);
  g_assert_cmpint(outcome(world, kind, 0.99 * limit_s, 200), ==, SPORE_METHOD_BOUNDED);
  g_assert_cmpint(outcome(world, kind, 1.01 * limit_s, 200), !=, SPORE_METHOD_BOUNDED);
  spore_world_free(world);
}

static void test_undamped(void) {
  assert_limit(0, SPORE_INTEGRATOR_SYMPLECTIC_EULER, 2 / FREQUENCY);
  assert_limit(0, SPORE_INTEGRATOR_VERLET, 2 / FREQUENCY);
  assert_limit(0, SPORE_INTEGRATOR_RK4, 2 * sqrt(2) / FREQUENCY); /* on the imaginary axis */
}

/* An overdamped mass has real eigenvalues w (z +- (z^2 - 1)^1/2); the stability region of the classical Runge-Kutta
 * method meets the real axis at 2.7853, that of explicit Euler at 2 (Hairer and Wanner 1996, IV.2). */
static void test_overdamped(void) {
  double fastest = FREQUENCY * (10 + sqrt(99));
  assert_limit(10, SPORE_INTEGRATOR_RK4, 2.7853 / fastest);
  assert_limit(10, SPORE_INTEGRATOR_EXPLICIT_EULER, 2 / fastest);
}

/* Symplectic Euler with damping d: w^2 h^2 + 2 d h = 4. Explicit Euler, underdamped: h = d / w^2. */
static void test_damped(void) {
  double d = 2 * 0.1 * FREQUENCY, w2 = FREQUENCY * FREQUENCY;
  assert_limit(0.1, SPORE_INTEGRATOR_SYMPLECTIC_EULER, (sqrt(d * d + 4 * w2) - d) / w2);
  assert_limit(0.1, SPORE_INTEGRATOR_EXPLICIT_EULER, d / w2);
}

/* Explicit Euler makes energy at any step where nothing damps. */
static void test_explicit_euler(void) {
  SporeWorld *world = spring_and_mass(0);
  for (double h = 0.3 / FREQUENCY; h > 0.01 / FREQUENCY; h *= 0.5)
    g_assert_cmpint(outcome(world, SPORE_INTEGRATOR_EXPLICIT_EULER, h, 200), ==, SPORE_METHOD_GREW);
  spore_world_free(world);
}

static void test_implicit(void) {
  const SporeIntegratorKind kinds[] = {SPORE_INTEGRATOR_IMPLICIT_EULER, SPORE_INTEGRATOR_IMPLICIT_MIDPOINT,
                                       SPORE_INTEGRATOR_BDF2, SPORE_INTEGRATOR_TR_BDF2};
  SporeWorld *world = spring_and_mass(0.01);
  for (gsize i = 0; i < G_N_ELEMENTS(kinds); i++)
    for (double h = 1e-4; h <= 0.1; h *= 10)
      g_assert_cmpint(outcome(world, kinds[i], h, 100), ==, SPORE_METHOD_BOUNDED);
  spore_world_free(world);
}

/* What is predicted for a body is what comes of it. */
static void test_prediction(void) {
  const SporeIntegratorKind kinds[] = {SPORE_INTEGRATOR_SYMPLECTIC_EULER, SPORE_INTEGRATOR_VERLET,
                                       SPORE_INTEGRATOR_RK4};
  ChainFields fields = {.count = 30, .mass = 1e-3, .spacing = 0.01, .stiffness = 500, .poison_at = HUGE_VAL};
  SporeBodyDescription body = passive_body("chain", chain_create(fields), spore_vec3(0, 0, 0));
  SporeWorldDescription description = world_description(&body, 1);
  SporeWorld *world = spore_world_create(&description, NULL, NULL);
  for (gsize i = 0; i < G_N_ELEMENTS(kinds); i++) {
    SporeStepLimit limit;
    g_assert_true(spore_world_predict_step(world, 0, kinds[i], &limit, NULL));
    g_assert_cmpfloat(limit.dt_s, <, limit.whole_dt_s);
    /* Of many springs in a row the fastest mode has the frequency 2 (k/m)^1/2. */
    g_assert_cmpfloat_with_epsilon(limit.frequency, 2 * sqrt(500 / 1e-3), 0.01 * limit.frequency);
    g_assert_cmpint(outcome(world, kinds[i], 0.97 * limit.whole_dt_s, 200), ==, SPORE_METHOD_BOUNDED);
    g_assert_cmpint(outcome(world, kinds[i], 1.05 * limit.whole_dt_s, 200), !=, SPORE_METHOD_BOUNDED);
  }
  spore_world_free(world);
}

/* The same of a mode with little and with much damping. */
static void test_damped_prediction(void) {
  const SporeIntegratorKind kinds[] = {SPORE_INTEGRATOR_EXPLICIT_EULER, SPORE_INTEGRATOR_SYMPLECTIC_EULER,
                                       SPORE_INTEGRATOR_VERLET, SPORE_INTEGRATOR_RK4};
  const double dampings[] = {0.05, 0.4, 1, 3};
  for (gsize d = 0; d < G_N_ELEMENTS(dampings); d++) {
    SporeWorld *world = spring_and_mass(dampings[d]);
    for (gsize i = 0; i < G_N_ELEMENTS(kinds); i++) {
      SporeStepLimit limit;
      g_assert_true(spore_world_predict_step(world, 0, kinds[i], &limit, NULL));
      g_test_message("%s, damping %g: %g s", spore_integrator_names[kinds[i]], dampings[d], limit.whole_dt_s);
      g_assert_cmpint(outcome(world, kinds[i], 0.98 * limit.whole_dt_s, 400), ==, SPORE_METHOD_BOUNDED);
      if (kinds[i] != SPORE_INTEGRATOR_EXPLICIT_EULER) /* what is said of it is a lower bound */
        g_assert_cmpint(outcome(world, kinds[i], 1.02 * limit.whole_dt_s, 400), !=, SPORE_METHOD_BOUNDED);
    }
    spore_world_free(world);
  }
}

/* Damping below 0 feeds energy into all that moves: the planted fault. No method is safe then, at any step. */
static void test_planted(void) {
  const SporeIntegratorKind kinds[] = {SPORE_INTEGRATOR_SYMPLECTIC_EULER, SPORE_INTEGRATOR_VERLET, SPORE_INTEGRATOR_RK4,
                                       SPORE_INTEGRATOR_TR_BDF2};
  SporeWorld *world = spring_and_mass(-0.05);
  for (gsize i = 0; i < G_N_ELEMENTS(kinds); i++)
    for (double part = 0.5; part > 0.1; part *= 0.5)
      g_assert_cmpint(outcome(world, kinds[i], part / FREQUENCY, 200), !=, SPORE_METHOD_BOUNDED);
  spore_world_free(world);
}

static void test_not_finite(void) {
  ChainFields fields = {.count = 1, .mass = 1, .spacing = 1, .anchor = 100, .poison_at = -1};
  SporeBodyDescription body = passive_body("mass", chain_create(fields), spore_vec3(0, 0, 0));
  SporeWorldDescription description = world_description(&body, 1);
  SporeWorld *world = spore_world_create(&description, NULL, NULL);
  SporeMethodResult result =
      spore_world_try_method(world, 0, &(SporeMethodTrial){SPORE_INTEGRATOR_SYMPLECTIC_EULER, 1e-3, 100});
  g_assert_cmpint(result.outcome, ==, SPORE_METHOD_NOT_FINITE);
  g_assert_cmpuint(result.steps, ==, 1);
  spore_world_free(world);
}

/* A trial leaves no trace in the world. */
static void test_no_trace(void) {
  SporeWorld *world = spring_and_mass(0.01), *other = spring_and_mass(0.01);
  for (int kind = 0; kind < SPORE_INTEGRATOR_STATIC; kind++) outcome(world, (SporeIntegratorKind)kind, 0.01, 20);
  for (int i = 0; i < 50; i++) {
    spore_world_step(world);
    spore_world_step(other);
  }
  g_assert_cmphex(spore_world_hash(world), ==, spore_world_hash(other));
  spore_world_free(world);
  spore_world_free(other);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/method_trial/undamped", test_undamped);
  g_test_add_func("/method_trial/overdamped", test_overdamped);
  g_test_add_func("/method_trial/damped", test_damped);
  g_test_add_func("/method_trial/explicit_euler", test_explicit_euler);
  g_test_add_func("/method_trial/implicit", test_implicit);
  g_test_add_func("/method_trial/prediction", test_prediction);
  g_test_add_func("/method_trial/damped_prediction", test_damped_prediction);
  g_test_add_func("/method_trial/planted", test_planted);
  g_test_add_func("/method_trial/not_finite", test_not_finite);
  g_test_add_func("/method_trial/no_trace", test_no_trace);
  return g_test_run();
}
