/* State of each pair of spheres from one step to the next: how far friction's tangential spring is stretched, and the
 * part of the depth that motion has not made. */
#include <assert.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/sim/world_private.h"

/* Pairs of sleeping bodies are no contacts, but keep their state. So there is room for more states than contacts. */
#define STATES_PER_CONTACT 4
/* Cosine. A contact whose normal has turned further than this loses its state. */
#define SAME_SIDE 0.7

static uint64_t pair_of(uint32_t sphere_a, uint32_t sphere_b) { return (uint64_t)sphere_a << 32 | sphere_b; }

static uint64_t pair_of_state(const SporePairState *state) { return pair_of(state->sphere_a, state->sphere_b); }

bool spore_pairs_reserve(SporeWorld *world, size_t old_contacts, size_t contacts) {
  assert(contacts >= old_contacts);
  size_t old = STATES_PER_CONTACT * old_contacts, wanted = STATES_PER_CONTACT * contacts;
  SporePairState *states = spore_reallocate(world->contact.pairs, old, wanted, sizeof *states);
  if (states) world->contact.pairs = states;
  SporePairState *kept = spore_reallocate(world->contact.pairs_scratch, old, wanted, sizeof *kept);
  if (kept) world->contact.pairs_scratch = kept;
  return states && kept;
}

static bool sleeps(const SporeWorld *world, const SporePairState *state) {
  assert(state->sphere_a < world->contact.spheres.count && state->sphere_b < world->contact.spheres.count);
  const uint32_t *body = world->contact.spheres.body;
  return world->bodies[body[state->sphere_a]].sleep.asleep || world->bodies[body[state->sphere_b]].sleep.asleep;
}

static void keep(SporeWorld *world, size_t *count, SporePairState state) {
  bool holds = state.overlap > 0 || spore_vec3_dot(state.stretch, state.stretch) > 0;
  if (holds && *count < STATES_PER_CONTACT * world->contact.capacity) world->contact.pairs_scratch[(*count)++] = state;
}

/* Contacts and states are both in the order of their pairs. */
void spore_world_keep_pairs(SporeWorld *world) {
  assert(world->contact.pair_count <= STATES_PER_CONTACT * world->contact.capacity);
  size_t count = 0, old = 0, old_count = world->contact.pair_count;
  for (size_t i = 0; i < world->contact.count; i++) {
    const SporeContactTerm *term = &world->contact.terms[i];
    uint64_t pair = pair_of(term->pair_a, term->pair_b);
    for (; old < old_count && pair_of_state(&world->contact.pairs[old]) <= pair; old++)
      if (pair_of_state(&world->contact.pairs[old]) < pair && sleeps(world, &world->contact.pairs[old]))
        keep(world, &count, world->contact.pairs[old]);
    SporeVec3 stretch = spore_contact_term_stretch(term, world->state.sites, world->state.q);
    keep(world, &count, (SporePairState){term->pair_a, term->pair_b, term->overlap, stretch, term->normal});
  }
  for (; old < old_count; old++)
    if (sleeps(world, &world->contact.pairs[old])) keep(world, &count, world->contact.pairs[old]);
  SporePairState *states = world->contact.pairs;
  world->contact.pairs = world->contact.pairs_scratch;
  world->contact.pairs_scratch = states;
  world->contact.pair_count = count;
}

/* The state of this pair, from index `first` on, whose normal is nearest; NULL: none is near enough. */
static const SporePairState *find_state(const SporeWorld *world, size_t first, uint64_t pair, SporeVec3 normal) {
  const SporePairState *found = NULL;
  double best = SAME_SIDE;
  for (size_t i = first; i < world->contact.pair_count && pair_of_state(&world->contact.pairs[i]) == pair; i++) {
    double cosine = spore_vec3_dot(world->contact.pairs[i].normal, normal);
    if (cosine > best) best = cosine, found = &world->contact.pairs[i];
  }
  return found;
}

/* The largest overlap of this pair, from index `first` on: the normal of deep spheres turns as they part. */
static double find_overlap(const SporeWorld *world, size_t first, uint64_t pair) {
  double most = 0;
  for (size_t i = first; i < world->contact.pair_count && pair_of_state(&world->contact.pairs[i]) == pair; i++)
    most = fmax(most, world->contact.pairs[i].overlap);
  return most;
}

/* Whether something other than motion made the depth of the end's contacts since the last step. */
static bool is_put(const SporeWorld *world, const SporeEnd *end, uint32_t sphere) {
  assert(end->body < world->body_count && sphere < world->contact.spheres.count);
  const SporeCollisionUnit *unit = &world->bodies[end->body].collision;
  return unit->put || unit->pulled || isnan(world->contact.spheres.before[3 * (size_t)sphere]);
}

void spore_world_restore_pairs(SporeWorld *world) {
  assert(world->contact.count <= world->contact.capacity);
  size_t next = 0;
  for (size_t i = 0; i < world->contact.count; i++) {
    SporeContactTerm *term = &world->contact.terms[i];
    uint64_t pair = pair_of(term->pair_a, term->pair_b);
    while (next < world->contact.pair_count && pair_of_state(&world->contact.pairs[next]) < pair) next++;
    const SporePairState *state = find_state(world, next, pair, term->normal);
    term->stretch = state ? spore_contact_turn_stretch(state->stretch, term->normal) : (SporeVec3){0, 0, 0};
    bool put = is_put(world, &term->a, term->sphere_a) || is_put(world, &term->b, term->sphere_b);
    double most = put ? HUGE_VAL : find_overlap(world, next, pair);
    term->overlap = fmin(fmax(term->depth, 0), most); /* smaller as the pair parts */
  }
}
