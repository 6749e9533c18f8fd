/* What leaving out saves: a world beside the same world that leaves nothing out. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/measure/pruning.h"
#include "tests/sim/chain_model.h"

#define STEPS 1200

static SporeWorld *create(const SporeWorldDescription *description) {
  SporeError error = SPORE_ERROR_INIT;
  SporeWorld *world = spore_world_create(description, NULL, &error);
  if (!world) g_error("%s: %s", error.place, error.message);
  return world;
}

static SporeModel *chain(double mass) {
  return chain_create((ChainFields){
      .count = 4, .mass = mass, .spacing = 0.25, .stiffness = 300, .damping = 0.5, .poison_at = HUGE_VAL});
}

static double chain_spheres[4 * 4] = {0, 0, 0, 0.1, 0.25, 0, 0, 0.1, 0.5, 0, 0, 0.1, 0.75, 0, 0, 0.1};
static double floor_spheres[4 * 4] = {0, -1.15, 0, 1, 0.25, -1.15, 0, 1, 0.5, -1.15, 0, 1, 0.75, -1.15, 0, 1};
static const SporeSphereSet chain_set = {4, chain_spheres}, floor_set = {4, floor_spheres};

/* A chain over a floor, twice; the second one with nothing left out. */
static void make(double sleep_speed, double other_mass, SporeWorld *worlds[2]) {
  for (int i = 0; i < 2; i++) {
    SporeBodyDescription bodies[2] = {passive_body("chain", chain(i ? other_mass : 0.1), (SporeVec3){0, 0, 0})};
    bodies[0].spheres = &chain_set;
    bodies[1] = (SporeBodyDescription){.name = "floor",
                                       .role = SPORE_UNMOVABLE,
                                       .pose = spore_pose_identity(),
                                       .spheres = &floor_set,
                                       .contact = bodies[0].contact};
    SporeWorldDescription description = world_description(bodies, 2);
    description.gravity = (SporeVec3){0, -9.81, 0};
    description.solver.sleep_speed = sleep_speed;
    description.unpruned = i == 1;
    worlds[i] = create(&description);
  }
}

static SporePruning measure(SporeWorld *worlds[2]) {
  static double ratios[STEPS];
  SporePruning pruning;
  g_assert_true(spore_pruning_measure(worlds[0], worlds[1], STEPS, ratios, &pruning));
  g_assert_cmpuint(pruning.steps, ==, STEPS);
  g_assert_cmpfloat(pruning.ratio_low, >, 0);
  g_assert_cmpfloat(pruning.ratio_low, <=, pruning.ratio);
  g_assert_cmpfloat(pruning.ratio, <=, pruning.ratio_high);
  g_assert_true(pruning.us > 0 && pruning.unpruned_us > 0);
  return pruning;
}

static void clear(SporeWorld *worlds[2]) {
  spore_world_free(worlds[0]);
  spore_world_free(worlds[1]);
}

/* Leaving out changes no bit; each stage runs where nothing is left out. */
static void test_equal(void) {
  SporeWorld *worlds[2];
  make(0, 0.1, worlds);
  SporePruning pruning = measure(worlds);
  g_assert_cmpuint(spore_world_counts(worlds[0]).contacts, >, 0);
  g_assert_true(pruning.equal);
  g_assert_cmpfloat(pruning.worst, ==, 0);
  g_assert_cmpuint(pruning.most_asleep, ==, 0);
  const SporePlan *plan = spore_world_plan(worlds[1]);
  for (size_t i = 0; i < plan->stage_count; i++) {
    g_assert_true(plan->stages[i].included);
    g_assert_cmpuint(plan->stages[i].profile->count, ==, STEPS);
  }
  g_assert_false(spore_world_plan(worlds[0])->stages[2].included);
  clear(worlds);
}

/* Another scene is not taken for the same. */
static void test_different(void) {
  SporeWorld *worlds[2];
  make(0, 0.2, worlds);
  SporePruning pruning = measure(worlds);
  g_assert_false(pruning.equal);
  g_assert_cmpfloat(pruning.worst, >, 1e-4);
  clear(worlds);
}

/* A body that sleeps stands still where it would creep on. */
static void test_asleep(void) {
  SporeWorld *worlds[2];
  make(1, 0.1, worlds);
  SporePruning pruning = measure(worlds);
  g_assert_cmpuint(pruning.most_asleep, ==, 1);
  g_assert_false(pruning.equal);
  g_assert_cmpfloat(pruning.worst, >, 0);
  g_assert_cmpuint(spore_world_counts(worlds[1]).sleeping, ==, 0);
  clear(worlds);
}

#define PLANTED_NS 200000u
static SporeModelType slow_model;

static void slow_force(const SporeModel *model, const double *q, const double *shape, const double *v, double *f) {
  uint64_t start = spore_clock_ns();
  chain_model.force(model, q, shape, v, f);
  while (spore_clock_ns() - start < PLANTED_NS) continue;
}

/* A planted cost is found in the stage that it is in, and in no other. */
static void test_planted(void) {
  slow_model = chain_model;
  slow_model.force = slow_force;
  SporeModel *model = chain(0.1);
  model->type = &slow_model;
  SporeBodyDescription body = passive_body("slow", model, (SporeVec3){0, 0, 0});
  SporeWorldDescription description = world_description(&body, 1);
  SporeWorld *world = create(&description);
  for (int i = 0; i < 20; i++) spore_world_step(world);
  const SporePlan *plan = spore_world_plan(world);
  double least = INFINITY;
  for (size_t i = 0; i < plan->stage_count; i++) {
    if (!plan->stages[i].included) continue;
    double us = spore_profile_summary(plan->stages[i].profile).median_us;
    if (!strcmp(plan->stages[i].name, "integrate")) g_assert_cmpfloat(us, >=, 1e-3 * PLANTED_NS);
    else least = fmin(least, us);
  }
  g_assert_cmpfloat(least, <, 1e-3 * PLANTED_NS);
  spore_world_free(world);
}

static void test_saved(void) {
  SporeWorld *worlds[2];
  make(0, 0.1, worlds);
  measure(worlds);
  double one = spore_pruning_saved_us(worlds[0], worlds[1], "particles"),
         two = spore_pruning_saved_us(worlds[0], worlds[1], "particles split_nodes");
  g_assert_cmpfloat(one, >=, 0); /* the stage runs in one of them alone */
  g_assert_cmpfloat(two, >=, one);
  g_assert_cmpfloat(spore_pruning_saved_us(worlds[0], worlds[1], "part"), ==, 0);
  g_assert_cmpfloat(spore_pruning_saved_us(worlds[0], worlds[1], ""), ==, 0);
  clear(worlds);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/measure/pruning/equal", test_equal);
  g_test_add_func("/measure/pruning/different", test_different);
  g_test_add_func("/measure/pruning/asleep", test_asleep);
  g_test_add_func("/measure/pruning/planted", test_planted);
  g_test_add_func("/measure/pruning/saved", test_saved);
  return g_test_run();
}
