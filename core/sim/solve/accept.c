/* Accepts solved steps: writes the islands' states into the next state, and makes it the last good one. */
#include <assert.h>
#include <string.h>

#include "core/sim/world_private.h"

static void accept_body(SporeWorld *world, const SporeIsland *island, uint32_t index) {
  assert(index < world->body_count);
  assert(island->q1 && island->v1);
  SporeBody *body = &world->bodies[index];
  const SporeSite *site = &world->solve.local_sites[index];
  spore_body_mark_changed(world, body);
  if (island->in_place) return;
  memcpy(world->state.next_q + body->q_offset, island->q1 + site->q, body->q_count * sizeof(double));
  memcpy(world->state.next_v + body->v_offset, island->v1 + site->v, 3 * body->block_count * sizeof(double));
}

/* A body that this step has frozen stays at its last good configuration. */
static void hold_body(SporeWorld *world, uint32_t index) {
  assert(index < world->body_count && world->bodies[index].frozen);
  SporeBody *body = &world->bodies[index];
  spore_body_mark_changed(world, body);
  memcpy(world->state.next_q + body->q_offset, world->state.q + body->q_offset, body->q_count * sizeof(double));
  memset(world->state.next_v + body->v_offset, 0, 3 * body->block_count * sizeof(double));
}

static void accept_island(SporeWorld *world, SporeIsland *island) {
  assert(island->kept_count <= island->body_count);
  assert(island->body_start + island->body_count <= world->body_count);
  const uint32_t *bodies = world->solve.island_bodies + island->body_start;
  for (size_t i = 0; i < island->kept_count; i++) accept_body(world, island, bodies[i]);
  for (size_t i = island->kept_count; i < island->body_count; i++) hold_body(world, bodies[i]);
  spore_island_let_sleep(world, island);
}

/* Active bodies go to the poses of their devices. Their velocity was set when the devices were read. */
static void accept_active(SporeWorld *world, SporeBody *body) {
  assert(body->role == SPORE_ACTIVE && body->q_count == SPORE_POSE_Q);
  spore_body_mark_changed(world, body);
  memcpy(world->state.next_q + body->q_offset, world->state.target_q + body->q_offset, body->q_count * sizeof(double));
}

void spore_world_accept(SporeWorld *world) {
  world->state.counts.contacts = world->contact.count;
  for (size_t i = 0; i < world->solve.island_count; i++) accept_island(world, &world->solve.islands[i]);
  for (size_t b = 0; b < world->body_count; b++)
    if (world->bodies[b].role == SPORE_ACTIVE) accept_active(world, &world->bodies[b]);
}

/* Updates what depends on the island's new state, once it is the world's. */
static void settle_island(SporeWorld *world, const SporeIsland *island) {
  for (size_t i = 0; i < island->kept_count; i++) {
    const SporeBody *body = &world->bodies[world->solve.island_bodies[island->body_start + i]];
    spore_body_turn_mass(world, body, world->state.q + body->q_offset);
  }
  if (island->falls_asleep) spore_island_keep_energy(world, island);
}

void spore_world_advance(SporeWorld *world) {
  spore_world_advance_state(world);
  for (size_t i = 0; i < world->solve.island_count; i++) settle_island(world, &world->solve.islands[i]);
}
