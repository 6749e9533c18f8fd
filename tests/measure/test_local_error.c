/* The estimated local error, against the error that a step really makes: of a mass on a spring, whose motion is known.
 */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/measure/local_error.h"
#include "tests/sim/chain_model.h"

#define MASS 0.1
#define ANCHOR 40.0 /* N/m: the angular frequency is 20 rad/s */

static SporeWorld *create(SporeIntegratorKind integrator, double step_s, double gravity, double anchor) {
  SporeModel *model = chain_create(
      (ChainFields){.count = 1, .mass = MASS, .spacing = 1, .stiffness = 1, .anchor = anchor, .poison_at = HUGE_VAL});
  SporeBodyDescription body = passive_body("mass", model, (SporeVec3){0, 0, 0});
  body.velocity = (SporeVec3){0.3, 0, 0};
  SporeWorldDescription description = world_description(&body, 1);
  description.gravity = (SporeVec3){0, -gravity, 0};
  description.solver.integrator = integrator;
  description.solver.time_step = step_s;
  description.solver.tolerance = 1e-10;
  SporeError error = SPORE_ERROR_INIT;
  SporeWorld *world = spore_world_create(&description, NULL, &error);
  if (!world) g_error("%s: %s", error.place, error.message);
  return world;
}

/* Free fall by implicit Euler: each step is off by g h^2 / 2, whatever the time. */
static void test_fall(void) {
  SporeLocalError estimate;
  SporeWorld *world = create(SPORE_INTEGRATOR_IMPLICIT_EULER, 0.002, 9.81, 0);
  g_assert_true(spore_local_error_init(&estimate, world, 0.002));
  guint estimates = 0;
  for (int i = 0; i < 200; i++) {
    spore_world_step(world);
    estimates += spore_local_error_step(&estimate, world);
  }
  g_assert_cmpuint(estimates, ==, 4);
  g_assert_cmpuint(estimate.samples, ==, 4);
  g_assert_cmpfloat_with_epsilon(estimate.last, 0.5 * 9.81 * 0.002 * 0.002, 1e-12);
  g_assert_cmpfloat_with_epsilon(estimate.sum, 4 * estimate.most, 1e-12);
  g_assert_cmpuint(estimate.most_body, ==, 0);
  spore_local_error_reset(&estimate);
  g_assert_cmpuint(estimate.samples, ==, 0);
  g_assert_cmpuint(estimate.most_body, ==, SPORE_NO_BODY);
  spore_local_error_clear(&estimate);
  spore_world_free(world);
}

/* What the step did to x, against the exact motion from where the step began. */
static double true_error(double x0, double v0, double x1, double step_s) {
  double omega = sqrt(ANCHOR / MASS), angle = omega * step_s;
  return fabs(x1 - (x0 * cos(angle) + v0 / omega * sin(angle)));
}

typedef struct Case {
  const char *name;
  SporeIntegratorKind kind;
  gboolean first_order;
} Case;

/* Never below the true error but for higher orders of the step; of methods of first order, close to it. Near the
 * turning points of a swing the leading term vanishes: sums over the run are compared. */
static void test_swing(gconstpointer data) {
  const Case *method = data;
  const double step_s = 0.001;
  SporeLocalError estimate;
  SporeWorld *world = create(method->kind, step_s, 0, ANCHOR);
  g_assert_true(spore_local_error_init(&estimate, world, step_s));
  double truth = 0;
  for (int i = 0; i < 64 * 100; i++) {
    double x0 = spore_world_q(world, 0)[0], v0 = spore_world_v(world, 0)[0];
    spore_world_step(world);
    double error = true_error(x0, v0, spore_world_q(world, 0)[0], step_s);
    if (!spore_local_error_step(&estimate, world)) continue;
    truth += error;
    g_assert_cmpfloat(estimate.last, >, 0.7 * error - 1e-12);
  }
  g_test_message("%s: %.3g m a step, estimated %.3g m", method->name, truth / 100, estimate.sum / 100);
  g_assert_cmpuint(estimate.samples, ==, 100);
  g_assert_cmpfloat(estimate.sum, >, 0.9 * truth);
  g_assert_cmpfloat(estimate.sum, <, (method->first_order ? 1.2 : 20) * truth);
  spore_local_error_clear(&estimate);
  spore_world_free(world);
}

/* Estimating is reading: the bits stay. Without memory nothing is estimated, and nothing breaks. */
static void test_reads_only(void) {
  SporeLocalError estimate;
  SporeWorld *watched = create(SPORE_INTEGRATOR_TR_BDF2, 0.001, 9.81, ANCHOR);
  SporeWorld *plain = create(SPORE_INTEGRATOR_TR_BDF2, 0.001, 9.81, ANCHOR);
  spore_local_error_init(&estimate, watched, 0.001);
  for (int i = 0; i < 300; i++) {
    spore_world_step(watched);
    spore_world_step(plain);
    spore_local_error_step(&estimate, watched);
  }
  g_assert_cmpuint(spore_world_hash(watched), ==, spore_world_hash(plain));
  spore_local_error_clear(&estimate);
  g_assert_false(spore_local_error_step(&estimate, watched));
  for (uint64_t n = 1; n <= 4; n++) {
    spore_allocation_fail_at(n);
    g_assert_false(spore_local_error_init(&estimate, watched, 0.001));
    g_assert_cmpuint(estimate.body_count, ==, 0);
  }
  spore_allocation_fail_at(0);
  spore_world_free(watched);
  spore_world_free(plain);
}

int main(int argc, char **argv) {
  static const Case cases[] = {{"implicit Euler", SPORE_INTEGRATOR_IMPLICIT_EULER, TRUE},
                               {"symplectic Euler", SPORE_INTEGRATOR_SYMPLECTIC_EULER, TRUE},
                               {"Verlet", SPORE_INTEGRATOR_VERLET, FALSE},
                               {"implicit midpoint", SPORE_INTEGRATOR_IMPLICIT_MIDPOINT, FALSE},
                               {"BDF2", SPORE_INTEGRATOR_BDF2, FALSE},
                               {"TR-BDF2", SPORE_INTEGRATOR_TR_BDF2, FALSE}};
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/local_error/fall", test_fall);
  for (gsize i = 0; i < G_N_ELEMENTS(cases); i++) {
    g_autofree char *path = g_strdup_printf("/local_error/swing/%s", cases[i].name);
    g_test_add_data_func(path, &cases[i], test_swing);
  }
  g_test_add_func("/local_error/reads_only", test_reads_only);
  return g_test_run();
}
