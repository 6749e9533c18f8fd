/* Makes the candidate state the state. */
#include <string.h>

#include "core/sim/world_private.h"

static void accept_body(SporeWorld *world, const SporeIsland *island, uint32_t index) {
  SporeBody *body = &world->bodies[index];
  const SporeSite *site = &world->local_sites[index];
  spore_body_mark_changed(world, body);
  if (island->in_place) return;
  memcpy(world->next_q + body->q_offset, island->q1 + site->q, body->q_count * sizeof(double));
  memcpy(world->next_v + body->v_offset, island->v1 + site->v, 3 * body->block_count * sizeof(double));
}

/* A body that this step has frozen stays where it was good. */
static void hold_body(SporeWorld *world, uint32_t index) {
  SporeBody *body = &world->bodies[index];
  spore_body_mark_changed(world, body);
  memcpy(world->next_q + body->q_offset, world->q + body->q_offset, body->q_count * sizeof(double));
  memset(world->next_v + body->v_offset, 0, 3 * body->block_count * sizeof(double));
}

static void accept_island(SporeWorld *world, SporeIsland *island) {
  const uint32_t *bodies = world->island_bodies + island->body_start;
  for (size_t i = 0; i < island->kept_count; i++) accept_body(world, island, bodies[i]);
  for (size_t i = island->kept_count; i < island->body_count; i++) hold_body(world, bodies[i]);
  spore_island_let_sleep(world, island);
}

/* Where the island's new state is the world's. */
static void settle_island(SporeWorld *world, const SporeIsland *island) {
  for (size_t i = 0; i < island->kept_count; i++) {
    const SporeBody *body = &world->bodies[world->island_bodies[island->body_start + i]];
    spore_body_turn_mass(world, body, world->q + body->q_offset);
  }
  if (island->falls_asleep) spore_island_keep_energy(world, island);
}

void spore_world_commit(SporeWorld *world) {
  world->counts.contacts = world->contact_count;
  for (size_t i = 0; i < world->island_count; i++) accept_island(world, &world->islands[i]);
  for (size_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (body->role != SPORE_ACTIVE) continue;
    spore_body_mark_changed(world, body); /* its velocity is what sensing found */
    memcpy(world->next_q + body->q_offset, world->target_q + body->q_offset, body->q_count * sizeof(double));
  }
  if (spore_world_exchanges_particles(world)) spore_world_exchange_particles(world);
  spore_world_divide_bodies(world);
  spore_world_advance_state(world);
  for (size_t i = 0; i < world->island_count; i++) settle_island(world, &world->islands[i]);
  spore_world_keep_grips(world);
  spore_world_break_links(world);
  for (size_t i = 0; i < world->tool_count; i++)
    if (spore_tool_has_jaws(&world->tools[i])) spore_jaws_tear(world, &world->tools[i]);
  spore_world_watch_contacts(world);
  spore_world_report_islands(world);
  spore_world_change_knots(world);
  world->step++;
  spore_snapshot_publish(world);
}
