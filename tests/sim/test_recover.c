/* What becomes of a step that is not solved: smaller ones are tried within a budget, the best attempt stands, and what
 * did not help is not tried again at once. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/sim/world_private.h"
#include "tests/sim/chain_model.h"

#define PARTICLES 12
#define N (3 * PARTICLES)
#define STEPS 100
#define NEWTON 2
#define PARTS                                                                                                          \
  (2 + 4 + 8) /* of all smaller steps: where no attempt is worth a step each takes an iteration at least               \
               */

/* A chain held at one end that falls from level, as few iterations as the tests ask for. */
static SporeWorld *make(double stiffness, int64_t newton, int64_t linear) {
  SporeModel *model = chain_create((ChainFields){
      .count = PARTICLES, .mass = 0.1, .spacing = 0.1, .stiffness = stiffness, .damping = 0, .poison_at = HUGE_VAL});
  SporeBodyDescription body = passive_body("chain", model, (SporeVec3){0, 0, 0});
  static const SporeLinkDescription pin = {
      .name = "p", .type = &spore_link_pin, .body_a = 0, .point_a = {0, 0, 0}, .radius = 0.01};
  SporeWorldDescription description = world_description(&body, 1);
  description.gravity = (SporeVec3){0, -9.81, 0};
  description.links = &pin;
  description.link_count = 1;
  description.solver.integrator = SPORE_INTEGRATOR_IMPLICIT_EULER;
  description.solver.time_step = 0.01;
  description.solver.newton_iterations = newton;
  description.solver.linear_iterations = linear;
  description.solver.tolerance = 1e-10;
  SporeWorld *world = spore_world_create(&description, NULL, NULL);
  g_assert_nonnull(world);
  return world;
}

/* The phases of a step, after some others, up to the first attempt, which is kept in q, v. */
static SporeIsland *attempt(SporeWorld *world, unsigned before, double *q, double *v) {
  for (unsigned i = 0; i < before; i++) spore_world_step(world);
  world->bodies[0].pause.left = 0;
  spore_world_link(world);
  spore_world_find_islands(world);
  SporeIsland *island = &world->solve.islands[0];
  spore_island_gather(world, island);
  island->taken = island->integrator;
  island->result = spore_island_advance(world, island, island->integrator, island->substeps, NULL);
  spore_island_examine(world, island);
  memcpy(q, island->q1, N * sizeof *q);
  memcpy(v, island->v1, N * sizeof *v);
  return island;
}

static double energy(const SporeWorld *world, const double *q, const double *v) {
  const SporeBody *body = &world->bodies[0];
  return spore_body_kinetic_energy(world, body, v) + spore_body_gravity_energy(world, body, q) +
         body->model->type->potential(body->model, q);
}

/* Whatever is tried, what stands misses no more than the first attempt, unless that one gained energy and this does
 * not, is that attempt where nothing was better, and the iterations of all of it are counted and bounded. */
static void test_best(void) {
  unsigned kept = 0, mended = 0, unsolved = 0;
  for (int64_t newton = 1; newton <= 12; newton++)
    for (unsigned before = 0; before <= 40; before += 20)
      for (double stiffness = 1e2; stiffness < 1e7; stiffness *= 10) {
        SporeWorld *world = make(stiffness, newton, 3);
        double q[N], v[N];
        SporeIsland *island = attempt(world, before, q, v);
        double first = island->result.residual;
        size_t spent = island->result.newton_iterations;
        bool tried = !island->result.converged && first > 1e-3;
        spore_island_recover(world, island);
        const SporeStepResult *result = &island->result;
        g_assert_cmpuint(result->newton_iterations, <=, 4 * (size_t)newton + MAX(3 * (size_t)newton, PARTS));
        g_assert_cmpuint(result->newton_iterations, >=, spent);
        if (tried && newton >= 3) g_assert_cmpuint(result->newton_iterations, >, spent);
        if (tried && first < 0.1) {
          double before_j = energy(world, world->state.q, world->state.v);
          bool gained = energy(world, q, v) > before_j, gains = energy(world, island->q1, island->v1) > before_j;
          g_assert_true(result->residual <= first || (gained && !gains));
          bool same = !memcmp(q, island->q1, sizeof q) && !memcmp(v, island->v1, sizeof v);
          kept += same;
          mended += !same;
        }
        unsolved += tried && !result->converged;
        if (tried) g_assert_cmpint(island->trouble, ==, SPORE_TROUBLE_NOT_CONVERGED);
        g_assert_cmpuint(island->kept_count, ==, 1);
        spore_world_free(world);
      }
  g_test_message("the first attempt stood %u times, a smaller step %u times; not solved %u times", kept, mended,
                 unsolved);
  g_assert_cmpuint(kept, >, 0);
  g_assert_cmpuint(mended, >, 0);
}

/* Where smaller steps did not help they pause for 1, 2, 4 ... steps, which stand as they are as long as they gain no
 * energy and miss no more than the load; where they did, the next step may have them at once. */
static void test_pause(void) {
  SporeWorld *world = make(1e5, 1, 3);
  const SporeMonitor *monitor = spore_world_monitor(world);
  unsigned helped = 0, useless = 0, in_vain = 0;
  uint32_t pauses = 0;
  uint64_t again = 0;
  for (uint64_t step = 1; step <= STEPS; step++) {
    uint64_t recoveries = monitor->recoveries, unsolved = monitor->not_converged;
    spore_world_step(world);
    double residual = spore_world_counts(world).residual;
    g_assert_cmpint(monitor->not_converged > unsolved, ==, residual > 1e-10);
    g_assert_cmpuint(spore_world_counts(world).newton_iterations, <=, 4 + PARTS);
    if (monitor->recoveries == recoveries) continue;
    g_assert_cmpuint(step, >=, again);
    const SporeBody *body = &world->bodies[0];
    g_assert_cmpuint(body->pause.length, ==, body->pause.length == 0 ? 0 : pauses == 0 ? 1 : 2 * pauses);
    again = step + body->pause.length + 1;
    pauses = body->pause.length;
    helped += pauses == 0;
    useless += pauses > 0;
    in_vain = MAX(in_vain, pauses);
  }
  g_test_message("%u of %u steps not solved; smaller ones helped %u times and %u times not, with pauses up to %u",
                 (unsigned)monitor->not_converged, STEPS, helped, useless, in_vain);
  g_assert_cmpuint(helped, >, 0);
  g_assert_cmpuint(useless, >, 3);
  g_assert_cmpuint(in_vain, >=, 8);
  spore_world_free(world);
}

/* The register of unsolved steps: an entry a body and cause, each step once, the largest figure; empty where all was
 * solved, and after a reset. A few of the steps may be unsolved by rounding alone. */
static void test_register(void) {
  SporeWorld *world = make(1e5, NEWTON, 2);
  g_assert_cmpuint(spore_world_unsolved_count(world), ==, 0);
  for (uint64_t step = 1; step <= STEPS; step++) spore_world_step(world);
  size_t count = spore_world_unsolved_count(world);
  SporeUnsolved entry = spore_world_unsolved(world, 0);
  uint64_t rounded = count > 1 ? spore_world_unsolved(world, 1).steps : 0;
  g_assert_cmpuint(count, <=, 2);
  if (count > 1)
    g_assert_cmpstr(spore_world_unsolved(world, 1).cause, ==, spore_unsolved_cause(SPORE_UNSOLVED_ROUNDING));
  g_assert_cmpuint(entry.body, ==, 0);
  g_assert_cmpuint(entry.steps, >, 10 * rounded);
  g_assert_cmpuint(entry.steps + rounded, ==, spore_world_monitor(world)->not_converged);
  g_assert_cmpfloat(entry.worst, >, 1e-10);
  g_assert_cmpstr(entry.unit, ==, "");
  spore_world_count_unsolved(world, 0, SPORE_UNSOLVED_RESIDUAL, 2 * entry.worst);
  spore_world_count_unsolved(world, 0, SPORE_UNSOLVED_RESIDUAL, entry.worst);
  spore_world_count_unsolved(world, 0, SPORE_UNSOLVED_FROZEN, 0);
  SporeUnsolved again = spore_world_unsolved(world, 0);
  g_assert_cmpuint(again.steps, ==, entry.steps + 1);
  g_assert_cmpfloat(again.worst, ==, 2 * entry.worst);
  g_assert_cmpuint(spore_world_unsolved_count(world), ==, count + 1);
  g_assert_null(spore_world_unsolved(world, count).unit);
  spore_world_count_unsolved(world, 0, SPORE_UNSOLVED_RESIDUAL, NAN);
  g_assert_true(isinf(spore_world_unsolved(world, 0).worst));
  spore_world_reset(world);
  g_assert_cmpuint(spore_world_unsolved_count(world), ==, 0);
  spore_world_free(world);
  world = make(1e2, 50, 200);
  for (uint64_t step = 1; step <= STEPS; step++) spore_world_step(world);
  g_assert_cmpuint(spore_world_unsolved_count(world), ==, 0);
  spore_world_free(world);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/recover/register", test_register);
  g_test_add_func("/recover/best", test_best);
  g_test_add_func("/recover/pause", test_pause);
  return g_test_run();
}
