/* Snapshots through a triple buffer: the writer fills one, the reader holds one, the third waits in the middle.
 *
 * The state of the world is the one in the newest snapshot. The writer reads the state there, as the reader does, and
 * writes the next state into a buffer of its own. States are numbered, and each body keeps the number of the state in
 * which it last changed. A body that has not changed since the buffer was last written need not be copied. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/hash.h"
#include "core/base/memory.h"
#include "core/sim/world_private.h"

#define CONTACTS_MAXIMUM 4096

static bool init_lines(const SporeWorld *world, SporeLines *lines) {
  lines->break_count = world->topology.lines.break_count;
  lines->breaks = SPORE_NEW_ARRAY(double, lines->break_count);
  lines->span_count = SPORE_NEW_ARRAY(uint32_t, world->body_count);
  return lines->breaks && lines->span_count;
}

static bool init_buffer(SporeWorld *world, int index) {
  assert(index >= 0 && index < 3);
  SporeSnapshots *snapshots = &world->state.snapshots;
  SporeSnapshot *snapshot = &snapshots->buffers[index];
  size_t capacity = 2 * world->contact.spheres.count;
  snapshot->contact_capacity = world->contact.grid ? (capacity < CONTACTS_MAXIMUM ? capacity : CONTACTS_MAXIMUM) : 0;
  snapshot->q = snapshots->q[index] = SPORE_NEW_ARRAY(double, world->state.q_count);
  snapshot->v = snapshots->v[index] = SPORE_NEW_ARRAY(double, world->state.v_count);
  snapshot->q_count = world->state.q_count;
  snapshot->v_count = world->state.v_count;
  snapshot->reaction = SPORE_NEW_ARRAY(double, 6 * world->body_count);
  if (world->has_lod) snapshot->level = SPORE_NEW_ARRAY(uint8_t, world->body_count);
  if (world->has_lod && !snapshot->level) return false;
  snapshot->contacts = SPORE_NEW_ARRAY(SporeSnapshotContact, snapshot->contact_capacity);
  snapshot->stain_count = world->stains.count;
  if (world->stains.count > 0) snapshot->stain = SPORE_NEW_ARRAY(float, world->stains.count);
  if (world->stains.count > 0 && !snapshot->stain) return false;
  snapshot->lens_count = world->lenses.count;
  if (world->lenses.count > 0) snapshot->lenses = SPORE_NEW_ARRAY(SporeLensState, world->lenses.count);
  if (world->lenses.count > 0 && !snapshot->lenses) return false;
  size_t squeezes = 0;
  for (size_t i = 0; i < world->tools.count; i++) squeezes += world->tools.all[i]->type->squeeze != NULL;
  if (squeezes > 0) snapshot->squeezes = SPORE_NEW_ARRAY(SporeSqueeze, squeezes);
  if (squeezes > 0 && !snapshot->squeezes) return false;
  snapshot->link_count = world->links.count;
  snapshot->links = SPORE_NEW_ARRAY(SporeSnapshotLink, world->links.count);
  if (!snapshot->links) return false;
  snapshot->cuts.capacity = world->topology.cuts.capacity;
  snapshot->cuts.edges = SPORE_NEW_ARRAY(SporeCutEdge, world->topology.cuts.capacity);
  snapshot->cuts.corner_count = world->topology.cuts.corner_count;
  snapshot->cuts.corners = SPORE_NEW_ARRAY(uint32_t, 4 * world->topology.cuts.corner_count);
  if (world->topology.line_count > 0 && !init_lines(world, &snapshot->lines)) return false;
  return snapshot->q && snapshot->v && snapshot->reaction && snapshot->contacts && snapshot->cuts.edges &&
         snapshot->cuts.corners;
}

static void set_next(SporeWorld *world) {
  SporeSnapshots *snapshots = &world->state.snapshots;
  world->state.next_q = snapshots->q[snapshots->triple.writing];
  world->state.next_v = snapshots->v[snapshots->triple.writing];
}

bool spore_snapshots_init(SporeWorld *world) {
  SporeSnapshots *snapshots = &world->state.snapshots;
  snapshots->triple = SPORE_TRIPLE_INIT;
  for (int i = 0; i < 3; i++)
    if (!init_buffer(world, i)) return false;
  world->state.q = snapshots->q[snapshots->triple.reading];
  world->state.v = snapshots->v[snapshots->triple.reading];
  set_next(world);
  return true;
}

static void clear_snapshots(SporeSnapshots *snapshots) {
  for (int i = 0; i < 3; i++) {
    spore_free(snapshots->q[i]);
    spore_free(snapshots->v[i]);
    spore_free(snapshots->buffers[i].level);
    spore_free(snapshots->buffers[i].reaction);
    spore_free(snapshots->buffers[i].contacts);
    spore_free(snapshots->buffers[i].stain);
    spore_free(snapshots->buffers[i].lenses);
    spore_free(snapshots->buffers[i].squeezes);
    spore_free(snapshots->buffers[i].links);
    spore_free(snapshots->buffers[i].cuts.edges);
    spore_free(snapshots->buffers[i].cuts.corners);
    spore_free(snapshots->buffers[i].lines.breaks);
    spore_free(snapshots->buffers[i].lines.span_count);
  }
}

static void copy_links(const SporeWorld *world, SporeSnapshot *snapshot) {
  for (size_t i = 0; i < world->links.count; i++) {
    const SporeLink *link = &world->links.all[i];
    SporeSnapshotLink *shown = &snapshot->links[i];
    double share = 1 / (double)link->term_count;
    *shown = (SporeSnapshotLink){.broken = link->broken};
    for (size_t t = 0; t < link->term_count; t++) {
      const SporeSpringTerm *term = &world->links.springs[link->term_start + t];
      shown->a = spore_vec3_add_scaled(shown->a, share, term->a.position);
      shown->b = spore_vec3_add_scaled(shown->b, share, term->b.position);
      if (!link->broken) shown->load += spore_vec3_length(term->force);
    }
  }
}

static void copy_squeezes(const SporeWorld *world, SporeSnapshot *snapshot) {
  snapshot->squeeze_count = 0;
  for (size_t i = 0; i < world->tools.count; i++) {
    const SporeTool *tool = world->tools.all[i];
    if (tool->type->squeeze && tool->type->squeeze(world, tool, &snapshot->squeezes[snapshot->squeeze_count]))
      snapshot->squeeze_count++;
  }
}

static void sum_contacts(SporeWorld *world) {
  SporeStepCounts *counts = &world->state.counts;
  counts->contact_depth = counts->contact_force = 0;
  for (size_t i = 0; i < world->contact.count; i++) {
    const SporeContactTerm *term = &world->contact.terms[i];
    counts->contact_depth = fmax(counts->contact_depth, term->depth);
    counts->contact_force += spore_vec3_dot(term->force, term->normal);
  }
}

static void copy_contacts(const SporeWorld *world, SporeSnapshot *snapshot) {
  assert(world->contact.count <= world->contact.capacity);
  snapshot->contact_count = world->contact.count;
  size_t listed = world->contact.count < snapshot->contact_capacity ? world->contact.count : snapshot->contact_capacity;
  for (size_t i = 0; i < listed; i++) {
    const SporeContactTerm *term = &world->contact.terms[i];
    snapshot->contacts[i] =
        (SporeSnapshotContact){spore_contact_term_point(term), term->force, term->sphere_a, term->sphere_b};
  }
}

/* Copies the messages that the buffer does not have yet. */
static void copy_messages(const SporeWorld *world, SporeSnapshot *snapshot) {
  const SporeMonitor *monitor = &world->state.monitor;
  assert(snapshot->message_count <= monitor->message_count);
  uint64_t missing = monitor->message_count - snapshot->message_count;
  if (missing > SPORE_MONITOR_MESSAGES) missing = SPORE_MONITOR_MESSAGES;
  for (uint64_t i = monitor->message_count - missing; i < monitor->message_count; i++)
    snapshot->messages[i % SPORE_MONITOR_MESSAGES] = monitor->messages[i % SPORE_MONITOR_MESSAGES];
  snapshot->message_count = monitor->message_count;
}

/* Copies the cuts that the buffer does not have yet. */
static void copy_cuts(const SporeWorld *world, SporeSnapshot *snapshot) {
  assert(world->topology.cuts.count <= snapshot->cuts.capacity);
  assert(world->topology.cuts.corner_count == snapshot->cuts.corner_count);
  SporeCuts *cuts = &snapshot->cuts;
  if (snapshot->cut_run != world->topology.cut_run) cuts->count = 0;
  snapshot->cut_run = world->topology.cut_run;
  for (; cuts->count < world->topology.cuts.count; cuts->count++)
    cuts->edges[cuts->count] = world->topology.cuts.edges[cuts->count];
  if (cuts->parted == world->topology.cuts.parted) return;
  cuts->parted = world->topology.cuts.parted;
  memcpy(cuts->corners, world->topology.cuts.corners, 4 * cuts->corner_count * sizeof *cuts->corners);
}

/* Copies the knots of lines where they have changed. */
static void copy_lines(const SporeWorld *world, SporeSnapshot *snapshot) {
  SporeLines *lines = &snapshot->lines;
  assert(lines->break_count == world->topology.lines.break_count);
  if (lines->number == world->topology.lines.number) return;
  lines->number = world->topology.lines.number;
  memcpy(lines->breaks, world->topology.lines.breaks, lines->break_count * sizeof *lines->breaks);
  memcpy(lines->span_count, world->topology.lines.span_count, world->body_count * sizeof *lines->span_count);
}

/* Copies the stains where they have changed. */
static void copy_stains(const SporeWorld *world, SporeSnapshot *snapshot) {
  assert(snapshot->stain_count == world->stains.count);
  if (snapshot->stained == world->stains.number) return;
  snapshot->stained = world->stains.number;
  memcpy(snapshot->stain, world->stains.amount, snapshot->stain_count * sizeof *snapshot->stain);
}

void spore_body_mark_changed(const SporeWorld *world, SporeBody *body) {
  body->changed = world->state.snapshots.newest + 1;
}

void spore_body_clear_unused(SporeWorld *world, const SporeBody *body) {
  assert(body->q_count <= body->q_most && body->block_count <= body->block_most);
  size_t q = body->q_count, v = 3 * body->block_count;
  memset(world->state.next_q + body->q_offset + q, 0, (body->q_most - q) * sizeof(double));
  memset(world->state.next_v + body->v_offset + v, 0, (3 * body->block_most - v) * sizeof(double));
}

void spore_world_advance_state(SporeWorld *world) {
  SporeSnapshots *snapshots = &world->state.snapshots;
  uint64_t *there = &snapshots->number[snapshots->triple.writing];
  assert(*there <= snapshots->newest);
  for (size_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    if (body->q_most > body->q_count || body->block_most > body->block_count) spore_body_clear_unused(world, body);
    if (body->changed > snapshots->newest || body->changed <= *there) continue;
    memcpy(world->state.next_q + body->q_offset, world->state.q + body->q_offset, body->q_count * sizeof(double));
    memcpy(world->state.next_v + body->v_offset, world->state.v + body->v_offset,
           3 * body->block_count * sizeof(double));
  }
  *there = ++snapshots->newest;
  world->state.q = world->state.next_q;
  world->state.v = world->state.next_v;
}

/* The velocity takes the body from its pose to its target in one step. It is computed from the two poses and not from
 * the velocity that the device reports, so that a recorded track gives the same motion again. */
void spore_active_set_velocity(SporeWorld *world, uint32_t index) {
  assert(index < world->body_count);
  assert(world->bodies[index].role == SPORE_ACTIVE);
  assert(world->solver.time_step > 0);
  const SporeBody *body = &world->bodies[index];
  const double *from = world->state.q + body->q_offset, *to = world->state.target_q + body->q_offset;
  double rate = 1 / world->solver.time_step, *v = world->state.next_v + body->v_offset;
  SporeVec3 moved = spore_vec3_sub(spore_vec3_load(to), spore_vec3_load(from));
  SporeQuat turn = spore_quat_multiply(spore_quat_load(to + 3), spore_quat_conjugate(spore_quat_load(from + 3)));
  spore_vec3_store(v, spore_vec3_scale(rate, moved));
  spore_vec3_store(v + 3, spore_vec3_scale(rate, spore_quat_to_rotation_vector(turn)));
}

/* Energy costs as much as a force, so it is computed only when a reader wants it. */
static SporeEnergy recent_energy(SporeWorld *world) {
  if (atomic_exchange_explicit(&world->state.snapshots.energy_wanted, false, memory_order_relaxed) ||
      world->state.step == 0)
    world->state.energy = spore_world_energy(world);
  return world->state.energy;
}

double spore_world_time_s(const SporeWorld *world) { return (double)world->state.step * world->solver.time_step; }

void spore_world_publish(SporeWorld *world) {
  SporeSnapshots *snapshots = &world->state.snapshots;
  SporeSnapshot *snapshot = &snapshots->buffers[snapshots->triple.writing];
  assert(world->state.q == snapshot->q && world->state.v == snapshot->v);
  snapshot->step = world->state.step;
  snapshot->time_s = spore_world_time_s(world);
  memcpy(snapshot->reaction, world->state.reaction, 6 * world->body_count * sizeof *world->state.reaction);
  for (size_t b = 0; snapshot->level && b < world->body_count; b++)
    snapshot->level[b] = (uint8_t)world->bodies[b].grade;
  copy_contacts(world, snapshot);
  sum_contacts(world);
  snapshot->counts = world->state.counts;
  snapshot->tools = world->tools.counts;
  snapshot->energy = recent_energy(world);
  copy_messages(world, snapshot);
  copy_cuts(world, snapshot);
  copy_lines(world, snapshot);
  copy_stains(world, snapshot);
  for (size_t i = 0; i < world->lenses.count; i++) snapshot->lenses[i] = world->lenses.state[i];
  copy_squeezes(world, snapshot);
  copy_links(world, snapshot);
  snapshot->step_us = world->schedule.step_us;
  spore_triple_publish(&snapshots->triple);
  set_next(world);
}

void spore_world_end_step(SporeWorld *world) {
  world->state.step++;
  spore_world_publish(world);
}

const SporeSnapshot *spore_world_snapshot_acquire(SporeWorld *world) {
  SporeSnapshots *snapshots = &world->state.snapshots;
  if (spore_triple_acquire(&snapshots->triple))
    atomic_store_explicit(&snapshots->energy_wanted, true, memory_order_relaxed);
  return &snapshots->buffers[snapshots->triple.reading];
}

static uint64_t hash_state(const double *q, size_t q_count, const double *v, size_t v_count, uint64_t step,
                           double time_s) {
  assert(q_count == 0 || q);
  assert(v_count == 0 || v);
  uint64_t hash = spore_hash(SPORE_HASH_INIT, q, q_count * sizeof *q);
  hash = spore_hash(hash, v, v_count * sizeof *v);
  hash = spore_hash(hash, &step, sizeof step);
  return spore_hash(hash, &time_s, sizeof time_s);
}

uint64_t spore_snapshot_hash(const SporeSnapshot *snapshot) {
  return hash_state(snapshot->q, snapshot->q_count, snapshot->v, snapshot->v_count, snapshot->step, snapshot->time_s);
}

uint64_t spore_world_body_hash(const SporeWorld *world, uint32_t index) {
  assert(index < world->body_count);
  const SporeBody *body = &world->bodies[index];
  uint64_t hash = spore_hash(SPORE_HASH_INIT, world->state.q + body->q_offset, body->q_count * sizeof(double));
  return spore_hash(hash, world->state.v + body->v_offset, 3 * body->block_count * sizeof(double));
}

uint64_t spore_world_hash(const SporeWorld *world) {
  return hash_state(world->state.q, world->state.q_count, world->state.v, world->state.v_count, world->state.step,
                    spore_world_time_s(world));
}

void spore_state_clear(SporeState *state) {
  clear_snapshots(&state->snapshots);
  spore_free(state->rest_q);
  spore_free(state->rest_v);
  spore_free(state->still);
  spore_free(state->sites);
  spore_free(state->target_q);
  spore_free(state->mass);
  spore_free(state->mass_inverse);
  spore_free(state->reaction);
  spore_free(state->unsolved);
}
