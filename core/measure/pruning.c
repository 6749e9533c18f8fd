/* Measures what leaving out saves, and whether the result is the same. */
#include "core/measure/pruning.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/measure/quantile.h"

/* Positions lead q: those of the nodes, and of a frame's origin. */
static double largest_distance(const SporeWorld *world, const SporeWorld *other) {
  double worst = 0;
  for (uint32_t body = 0; body < spore_world_body_count(world); body++) {
    const SporeModel *model = spore_world_body_model(world, body);
    const double *a = spore_world_q(world, body), *b = spore_world_q(other, body);
    size_t nodes = model ? model->node_count : 1;
    for (size_t i = 0; i < nodes; i++)
      worst = fmax(worst, spore_vec3_length(spore_vec3_sub(spore_vec3_load(a + 3 * i), spore_vec3_load(b + 3 * i))));
  }
  return worst;
}

/* Control points come and go by what a world looks at alone, so that the counts of both worlds may differ. */
static bool comparable(const SporeWorld *world, const SporeWorld *other) {
  for (uint32_t body = 0; body < spore_world_body_count(world); body++) {
    const SporeModel *a = spore_world_body_model(world, body), *b = spore_world_body_model(other, body);
    if ((a ? a->node_count : 1) != (b ? b->node_count : 1)) return false;
  }
  return true;
}

static void compare(const SporeWorld *world, const SporeWorld *unpruned, SporePruning *pruning) {
  size_t asleep = spore_world_counts(world).sleeping;
  if (asleep > pruning->most_asleep) pruning->most_asleep = asleep;
  if (spore_world_hash(world) == spore_world_hash(unpruned)) return;
  pruning->equal = false;
  pruning->worst = fmax(pruning->worst, comparable(world, unpruned) ? largest_distance(world, unpruned) : INFINITY);
}

/* A step's time by the clock, us; below 0: it was cancelled. */
static double timed_step(SporeWorld *world) {
  uint64_t start = spore_clock_ns();
  spore_world_step(world);
  double us = 1e-3 * (double)(spore_clock_ns() - start);
  spore_world_tidy(world);
  return spore_world_cancelled(world) ? -1 : us;
}

bool spore_pruning_measure(SporeWorld *world, SporeWorld *unpruned, size_t steps, double *ratios,
                           SporePruning *pruning) {
  assert(spore_world_body_count(world) == spore_world_body_count(unpruned));
  assert(spore_world_step_count(world) == 0 && spore_world_step_count(unpruned) == 0);
  *pruning = (SporePruning){.equal = true};
  for (; pruning->steps < steps; pruning->steps++) {
    bool first = pruning->steps % 2 == 0;
    double before = first ? timed_step(world) : timed_step(unpruned);
    double after = before < 0 ? -1 : first ? timed_step(unpruned) : timed_step(world);
    if (after < 0) return false;
    ratios[pruning->steps] = first ? after / before : before / after;
    compare(world, unpruned, pruning);
  }
  pruning->us = spore_profile_summary(spore_world_profile(world)).median_us;
  pruning->unpruned_us = spore_profile_summary(spore_world_profile(unpruned)).median_us;
  pruning->ratio = spore_quantile(ratios, steps, 0.5);
  pruning->ratio_low = spore_quantile(ratios, steps, 0.25);
  pruning->ratio_high = spore_quantile(ratios, steps, 0.75);
  return true;
}

/* Whether a name is one of the words. */
static bool names(const char *words, const char *name) {
  size_t length = strlen(name);
  for (const char *at = words; (at = strstr(at, name)); at += length)
    if ((at == words || at[-1] == ' ') && (at[length] == '\0' || at[length] == ' ')) return true;
  return false;
}

static double stages_us(const SporeWorld *world, const char *stages) {
  const SporePlan *plan = spore_world_plan(world);
  double sum = 0;
  for (size_t i = 0; i < plan->stage_count; i++)
    if (plan->stages[i].profile && names(stages, plan->stages[i].name))
      sum += spore_profile_summary(plan->stages[i].profile).median_us;
  return sum;
}

double spore_pruning_saved_us(const SporeWorld *world, const SporeWorld *unpruned, const char *stages) {
  return stages_us(unpruned, stages) - stages_us(world, stages);
}
