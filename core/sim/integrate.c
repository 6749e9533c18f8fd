/* Integrates the islands, each on its own and on any thread. */
#include "core/sim/world_private.h"

static void integrate_island(void *data, size_t index) {
  SporeWorld *world = data;
  SporeIsland *island = &world->islands[index];
  spore_island_gather(world, island);
  island->result = spore_island_advance(world, island, island->integrator, 1);
  if (spore_island_choose(world, island)) {
    spore_island_gather(world, island);
    island->result = spore_island_advance(world, island, island->integrator, 1);
  }
  uint32_t offender;
  island->trouble = spore_island_examine(world, island, &offender);
  if (island->trouble != SPORE_TROUBLE_NONE) spore_island_recover(world, island);
  island->rests = spore_island_rests(world, island);
}

void spore_world_integrate(SporeWorld *world) {
  spore_pool_run(world->pool, world->island_count, integrate_island, world);
  SporeStepCounts *counts = &world->counts;
  *counts = (SporeStepCounts){
      .contacts = world->contact_count, .islands = world->island_count, .sleeping = world->sleeping_count};
  for (size_t i = 0; i < world->island_count; i++) {
    const SporeStepResult *result = &world->islands[i].result;
    counts->newton_iterations += result->newton_iterations;
    counts->linear_iterations += result->linear_iterations;
    counts->force_evaluations += result->force_evaluations;
    if (result->residual > counts->residual) counts->residual = result->residual;
  }
}
