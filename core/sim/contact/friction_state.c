/* State of friction from one step to the next: how far the tangential spring of each pair of spheres is stretched. */
#include <assert.h>

#include "core/base/memory.h"
#include "core/sim/world_private.h"

/* Pairs of sleeping bodies are no contacts, but keep their state. So there is room for more states than contacts. */
#define STATES_PER_CONTACT 4
/* Cosine. A contact whose normal has turned further than this loses its state. */
#define SAME_SIDE 0.7

static uint64_t pair_of(uint32_t sphere_a, uint32_t sphere_b) { return (uint64_t)sphere_a << 32 | sphere_b; }

static uint64_t pair_of_state(const SporeFrictionState *state) { return pair_of(state->sphere_a, state->sphere_b); }

bool spore_friction_reserve(SporeWorld *world, size_t old_contacts, size_t contacts) {
  assert(contacts >= old_contacts);
  size_t old = STATES_PER_CONTACT * old_contacts, wanted = STATES_PER_CONTACT * contacts;
  SporeFrictionState *states = spore_reallocate(world->contact.friction, old, wanted, sizeof *states);
  if (states) world->contact.friction = states;
  SporeFrictionState *kept = spore_reallocate(world->contact.friction_scratch, old, wanted, sizeof *kept);
  if (kept) world->contact.friction_scratch = kept;
  return states && kept;
}

static bool sleeps(const SporeWorld *world, const SporeFrictionState *state) {
  assert(state->sphere_a < world->contact.spheres.count && state->sphere_b < world->contact.spheres.count);
  const uint32_t *body = world->contact.spheres.body;
  return world->bodies[body[state->sphere_a]].sleep.asleep || world->bodies[body[state->sphere_b]].sleep.asleep;
}

static void keep(SporeWorld *world, size_t *count, SporeFrictionState state) {
  bool holds = spore_vec3_dot(state.stretch, state.stretch) > 0;
  if (holds && *count < STATES_PER_CONTACT * world->contact.capacity)
    world->contact.friction_scratch[(*count)++] = state;
}

/* Contacts and states of friction are both in the order of their pairs. */
void spore_world_keep_friction(SporeWorld *world) {
  assert(world->contact.friction_count <= STATES_PER_CONTACT * world->contact.capacity);
  size_t count = 0, old = 0, old_count = world->contact.friction_count;
  for (size_t i = 0; i < world->contact.count; i++) {
    const SporeContactTerm *term = &world->contact.terms[i];
    uint64_t pair = pair_of(term->pair_a, term->pair_b);
    for (; old < old_count && pair_of_state(&world->contact.friction[old]) <= pair; old++)
      if (pair_of_state(&world->contact.friction[old]) < pair && sleeps(world, &world->contact.friction[old]))
        keep(world, &count, world->contact.friction[old]);
    SporeVec3 stretch = spore_contact_term_stretch(term, world->state.sites, world->state.q);
    keep(world, &count, (SporeFrictionState){term->pair_a, term->pair_b, stretch, term->normal});
  }
  for (; old < old_count; old++)
    if (sleeps(world, &world->contact.friction[old])) keep(world, &count, world->contact.friction[old]);
  SporeFrictionState *states = world->contact.friction;
  world->contact.friction = world->contact.friction_scratch;
  world->contact.friction_scratch = states;
  world->contact.friction_count = count;
}

/* The stretch, turned into the present tangent plane of the contact. */
static SporeVec3 turn_stretch(SporeVec3 stretch, SporeVec3 normal) {
  SporeVec3 flat = spore_vec3_add_scaled(stretch, -spore_vec3_dot(stretch, normal), normal);
  return spore_vec3_scale(spore_vec3_length(stretch), spore_vec3_normalise(flat, (SporeVec3){0, 0, 0}));
}

/* The state of this pair, from index `first` on, whose normal is nearest; NULL: none is near enough. */
static const SporeFrictionState *find_state(const SporeWorld *world, size_t first, uint64_t pair, SporeVec3 normal) {
  const SporeFrictionState *found = NULL;
  double best = SAME_SIDE;
  for (size_t i = first; i < world->contact.friction_count && pair_of_state(&world->contact.friction[i]) == pair; i++) {
    double cosine = spore_vec3_dot(world->contact.friction[i].normal, normal);
    if (cosine > best) best = cosine, found = &world->contact.friction[i];
  }
  return found;
}

void spore_world_restore_friction(SporeWorld *world) {
  assert(world->contact.count <= world->contact.capacity);
  size_t next = 0;
  for (size_t i = 0; i < world->contact.count; i++) {
    SporeContactTerm *term = &world->contact.terms[i];
    uint64_t pair = pair_of(term->pair_a, term->pair_b);
    while (next < world->contact.friction_count && pair_of_state(&world->contact.friction[next]) < pair) next++;
    const SporeFrictionState *state = find_state(world, next, pair, term->normal);
    term->stretch = state ? turn_stretch(state->stretch, term->normal) : (SporeVec3){0, 0, 0};
  }
}
