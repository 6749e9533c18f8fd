/* Snapshots through a triple buffer: the writer fills one, the reader holds one, the third waits in the middle. */
#include <string.h>

#include "core/base/memory.h"
#include "core/sim/world_private.h"

#define FRESH 4u /* in `middle`: the reader has not had it yet */
#define CONTACTS_MAXIMUM 4096

static bool init_buffer(const SporeWorld *world, SporeSnapshot *snapshot) {
  size_t capacity = 2 * world->spheres.count;
  snapshot->contact_capacity = world->grid ? (capacity < CONTACTS_MAXIMUM ? capacity : CONTACTS_MAXIMUM) : 0;
  snapshot->q = SPORE_NEW_ARRAY(double, world->q_count);
  snapshot->v = SPORE_NEW_ARRAY(double, world->v_count);
  snapshot->reaction = SPORE_NEW_ARRAY(double, 6 * world->body_count);
  snapshot->contacts = SPORE_NEW_ARRAY(SporeSnapshotContact, snapshot->contact_capacity);
  return snapshot->q && snapshot->v && snapshot->reaction && snapshot->contacts;
}

bool spore_snapshots_init(SporeWorld *world) {
  SporeSnapshots *snapshots = &world->snapshots;
  snapshots->writing = 0;
  snapshots->reading = 1;
  atomic_init(&snapshots->middle, 2);
  for (int i = 0; i < 3; i++)
    if (!init_buffer(world, &snapshots->buffers[i])) return false;
  return true;
}

void spore_snapshots_clear(SporeSnapshots *snapshots) {
  for (int i = 0; i < 3; i++) {
    spore_free(snapshots->buffers[i].q);
    spore_free(snapshots->buffers[i].v);
    spore_free(snapshots->buffers[i].reaction);
    spore_free(snapshots->buffers[i].contacts);
  }
}

static void copy_contacts(const SporeWorld *world, SporeSnapshot *snapshot) {
  snapshot->contact_count = world->contact_count;
  size_t listed = world->contact_count < snapshot->contact_capacity ? world->contact_count : snapshot->contact_capacity;
  for (size_t i = 0; i < listed; i++) {
    const SporeContactTerm *term = &world->contacts[i];
    snapshot->contacts[i] =
        (SporeSnapshotContact){spore_contact_term_point(term), term->force, term->sphere_a, term->sphere_b};
  }
}

/* Energy costs as much as a force: it is not worth taking more often than anybody looks. */
static SporeEnergy recent_energy(SporeWorld *world) {
  uint64_t now = spore_clock_ns();
  if (world->step == 0 || now - world->energy_taken_ns > SPORE_SNAPSHOT_ENERGY_AGE_NS) {
    world->energy = spore_world_energy(world);
    world->energy_taken_ns = now;
  }
  return world->energy;
}

void spore_snapshot_publish(SporeWorld *world) {
  SporeSnapshots *snapshots = &world->snapshots;
  SporeSnapshot *snapshot = &snapshots->buffers[snapshots->writing];
  snapshot->step = world->step;
  snapshot->time_s = spore_world_time_s(world);
  memcpy(snapshot->q, world->q, world->q_count * sizeof *world->q);
  memcpy(snapshot->v, world->v, world->v_count * sizeof *world->v);
  memcpy(snapshot->reaction, world->reaction, 6 * world->body_count * sizeof *world->reaction);
  copy_contacts(world, snapshot);
  snapshot->counts = world->counts;
  snapshot->energy = recent_energy(world);
  snapshot->monitor_messages = world->monitor.message_count;
  snapshot->hash = spore_world_hash(world);
  snapshot->step_us = world->step_us;
  unsigned old = atomic_exchange_explicit(&snapshots->middle, snapshots->writing | FRESH, memory_order_acq_rel);
  snapshots->writing = old & ~FRESH;
}

const SporeSnapshot *spore_world_snapshot_acquire(SporeWorld *world) {
  SporeSnapshots *snapshots = &world->snapshots;
  if (atomic_load_explicit(&snapshots->middle, memory_order_acquire) & FRESH) {
    unsigned old = atomic_exchange_explicit(&snapshots->middle, snapshots->reading, memory_order_acq_rel);
    snapshots->reading = old & ~FRESH;
  }
  return &snapshots->buffers[snapshots->reading];
}
