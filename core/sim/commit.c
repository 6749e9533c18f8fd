/* Makes the candidate state the state. */
#include <string.h>

#include "core/sim/world_private.h"

static void accept_island(SporeWorld *world, const SporeIsland *island) {
  for (size_t i = 0; i < island->kept_count; i++) {
    uint32_t b = world->island_bodies[island->body_start + i];
    const SporeBody *body = &world->bodies[b];
    const SporeSite *site = &world->local_sites[b];
    memcpy(world->q + body->q_offset, world->local_q1 + island->q_start + site->q, body->q_count * sizeof(double));
    memcpy(world->v + body->v_offset, world->local_v1 + island->v_start + site->v,
           3 * body->block_count * sizeof(double));
    if (!spore_model_is_nodal(body->model)) spore_body_update_mass(world, body);
  }
}

void spore_world_commit(SporeWorld *world) {
  for (size_t i = 0; i < world->island_count; i++) accept_island(world, &world->islands[i]);
  for (size_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    if (body->role == SPORE_ACTIVE)
      memcpy(world->q + body->q_offset, world->target_q + body->q_offset, body->q_count * sizeof(double));
    if (body->frozen) memset(world->v + body->v_offset, 0, 3 * body->block_count * sizeof(double));
  }
  spore_world_report_islands(world);
  world->step++;
  spore_snapshot_publish(world);
}
