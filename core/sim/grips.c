/* What friction holds from one step to the next: how far the spring of each pair of spheres is stretched. */
#include "core/base/memory.h"
#include "core/sim/world_private.h"

/* Pairs that sleep are not contacts, but hold; there is room for them beside as many contacts. */
#define GRIPS_PER_CONTACT 4
/* A contact whose normal has turned by more than to this cosine holds nothing of what it held. */
#define SAME_SIDE 0.7

static uint64_t pair_of(uint32_t sphere_a, uint32_t sphere_b) { return (uint64_t)sphere_a << 32 | sphere_b; }

static uint64_t pair_of_grip(const SporeGrip *grip) { return pair_of(grip->sphere_a, grip->sphere_b); }

bool spore_grips_reserve(SporeWorld *world, size_t old_contacts, size_t contacts) {
  size_t old = GRIPS_PER_CONTACT * old_contacts, wanted = GRIPS_PER_CONTACT * contacts;
  SporeGrip *grips = spore_reallocate(world->grips, old, wanted, sizeof *grips);
  if (grips) world->grips = grips;
  SporeGrip *kept = spore_reallocate(world->kept_grips, old, wanted, sizeof *kept);
  if (kept) world->kept_grips = kept;
  return grips && kept;
}

static bool sleeps(const SporeWorld *world, const SporeGrip *grip) {
  const uint32_t *body = world->spheres.body;
  return world->bodies[body[grip->sphere_a]].asleep || world->bodies[body[grip->sphere_b]].asleep;
}

static void keep(SporeWorld *world, size_t *count, SporeGrip grip) {
  bool holds = spore_vec3_dot(grip.stretch, grip.stretch) > 0;
  if (holds && *count < GRIPS_PER_CONTACT * world->contact_capacity) world->kept_grips[(*count)++] = grip;
}

/* Contacts, and grips, are in the order of their pairs. */
void spore_world_keep_grips(SporeWorld *world) {
  size_t count = 0, old = 0, old_count = world->grip_count;
  for (size_t i = 0; i < world->contact_count; i++) {
    const SporeContactTerm *term = &world->contacts[i];
    uint64_t pair = pair_of(term->grip_a, term->grip_b);
    for (; old < old_count && pair_of_grip(&world->grips[old]) <= pair; old++)
      if (pair_of_grip(&world->grips[old]) < pair && sleeps(world, &world->grips[old]))
        keep(world, &count, world->grips[old]);
    SporeVec3 stretch = spore_contact_term_stretch(term, world->world_sites, world->q);
    keep(world, &count, (SporeGrip){term->grip_a, term->grip_b, stretch, term->normal});
  }
  for (; old < old_count; old++)
    if (sleeps(world, &world->grips[old])) keep(world, &count, world->grips[old]);
  SporeGrip *grips = world->grips;
  world->grips = world->kept_grips;
  world->kept_grips = grips;
  world->grip_count = count;
}

/* The stretch turned into the plane that the pair touches in now. */
static SporeVec3 turn_stretch(SporeVec3 stretch, SporeVec3 normal) {
  SporeVec3 flat = spore_vec3_add_scaled(stretch, -spore_vec3_dot(stretch, normal), normal);
  return spore_vec3_scale(spore_vec3_length(stretch), spore_vec3_normalise(flat, (SporeVec3){0, 0, 0}));
}

/* Of the grips of the contact's pair, from `first` on, the one of the same side; NULL: none. */
static const SporeGrip *grip_of(const SporeWorld *world, size_t first, uint64_t pair, SporeVec3 normal) {
  const SporeGrip *found = NULL;
  double best = SAME_SIDE;
  for (size_t i = first; i < world->grip_count && pair_of_grip(&world->grips[i]) == pair; i++) {
    double cosine = spore_vec3_dot(world->grips[i].normal, normal);
    if (cosine > best) best = cosine, found = &world->grips[i];
  }
  return found;
}

void spore_world_take_grips(SporeWorld *world) {
  size_t next = 0;
  for (size_t i = 0; i < world->contact_count; i++) {
    SporeContactTerm *term = &world->contacts[i];
    uint64_t pair = pair_of(term->grip_a, term->grip_b);
    while (next < world->grip_count && pair_of_grip(&world->grips[next]) < pair) next++;
    const SporeGrip *grip = grip_of(world, next, pair, term->normal);
    term->stretch = grip ? turn_stretch(grip->stretch, term->normal) : (SporeVec3){0, 0, 0};
  }
}
