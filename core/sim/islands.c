/* Islands: bodies that terms tie together this step. What physics does not move ties nothing: it takes part in the
 * terms of every island it touches. */
#include <math.h>
#include <string.h>

#include "core/sim/world_private.h"

static uint32_t find_root(uint32_t *parent, uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/* The lower index becomes the root, so that islands come in the order of their first bodies. */
static void tie(uint32_t *parent, const SporeEnd *a, const SporeEnd *b) {
  if (a->prescribed || b->prescribed || a->body == b->body) return;
  uint32_t i = find_root(parent, a->body), j = find_root(parent, b->body);
  if (i < j) parent[j] = i;
  else parent[i] = j;
}

static void tie_bodies(SporeWorld *world) {
  for (uint32_t b = 0; b < world->body_count; b++) world->parent[b] = b;
  for (size_t i = 0; i < world->contact_count; i++) tie(world->parent, &world->contacts[i].a, &world->contacts[i].b);
  size_t springs = spore_world_spring_count(world);
  for (size_t i = 0; i < springs; i++)
    if (world->spring_active[i]) tie(world->parent, &world->springs[i].a, &world->springs[i].b);
}

/* Bodies that choose alike move by what they choose. Implicit ones that do not, by the method that damps most; others
 * are mixed, by implicit Euler where they couple. */
static void add_choice(SporeIsland *island, const SporeBody *body) {
  const SporeIntegrator *its = spore_integrator(body->integrator), *before = spore_integrator(island->integrator);
  bool alike = body->integrator == island->integrator && body->substeps == island->substeps;
  bool explicit_one = !its->implicit || !before->implicit;
  bool static_one = (body->integrator == SPORE_INTEGRATOR_STATIC) != (island->integrator == SPORE_INTEGRATOR_STATIC);
  if (island->mixed || (explicit_one && !alike) || static_one) {
    island->mixed = true;
    island->integrator = SPORE_INTEGRATOR_IMPLICIT_EULER;
    return;
  }
  if (its->damping > before->damping) island->integrator = body->integrator;
  if (body->substeps > island->substeps) island->substeps = body->substeps;
}

/* Numbers the islands and counts their bodies. */
static void number_islands(SporeWorld *world) {
  world->island_count = 0;
  for (uint32_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    world->island_of[b] = SPORE_NO_BODY;
    if (!spore_body_moves(body)) continue;
    uint32_t root = find_root(world->parent, b);
    if (root == b) {
      world->islands[world->island_count] = (SporeIsland){.integrator = body->integrator, .substeps = body->substeps};
      world->island_of[b] = (uint32_t)world->island_count++;
    } else {
      world->island_of[b] = world->island_of[root];
    }
    SporeIsland *island = &world->islands[world->island_of[b]];
    island->body_count++;
    island->q_count += body->q_count;
    island->v_count += 3 * body->block_count;
    add_choice(island, body);
  }
}

static uint32_t island_of_term(const SporeWorld *world, const SporeEnd *a, const SporeEnd *b) {
  if (!a->prescribed) return world->island_of[a->body];
  return b->prescribed ? SPORE_NO_BODY : world->island_of[b->body];
}

static uint32_t island_of_contact(const SporeWorld *world, size_t i) {
  return island_of_term(world, &world->contacts[i].a, &world->contacts[i].b);
}

static uint32_t island_of_spring(const SporeWorld *world, size_t i) {
  if (!world->spring_active[i]) return SPORE_NO_BODY;
  return island_of_term(world, &world->springs[i].a, &world->springs[i].b);
}

static void count_terms(SporeWorld *world, size_t springs) {
  for (size_t i = 0; i < world->contact_count; i++) {
    uint32_t island = island_of_contact(world, i);
    if (island != SPORE_NO_BODY) world->islands[island].contact_count++;
  }
  for (size_t i = 0; i < springs; i++) {
    uint32_t island = island_of_spring(world, i);
    if (island != SPORE_NO_BODY) world->islands[island].spring_count++;
  }
}

/* Joints are stiff: however the bodies move otherwise, by joints they move implicitly. */
static void mix_jointed(SporeWorld *world) {
  for (size_t i = 0; i < world->link_count; i++) {
    const SporeLink *link = &world->links[i];
    uint32_t island = link->kind == SPORE_LINK_SPRING ? SPORE_NO_BODY : island_of_spring(world, link->term_start);
    if (island == SPORE_NO_BODY || spore_integrator(world->islands[island].integrator)->implicit) continue;
    world->islands[island].mixed = true;
    world->islands[island].integrator = SPORE_INTEGRATOR_IMPLICIT_EULER;
  }
}

static void set_starts(SporeWorld *world) {
  SporeIsland end = {0};
  for (size_t i = 0; i < world->island_count; i++) {
    SporeIsland *island = &world->islands[i];
    island->body_start = end.body_start;
    island->contact_start = end.contact_start;
    island->lanes_start = end.lanes_start;
    island->spring_start = end.spring_start;
    island->q_start = end.q_start;
    island->v_start = end.v_start;
    end.body_start += island->body_count;
    end.contact_start += island->contact_count;
    end.lanes_start += spore_lanes_for(island->contact_count);
    end.spring_start += island->spring_count;
    end.q_start += island->q_count;
    end.v_start += island->v_count;
    island->kept_count = island->body_count;
    island->body_count = island->contact_count = island->spring_count = 0;
  }
}

static void fill_islands(SporeWorld *world, size_t springs) {
  for (uint32_t b = 0; b < world->body_count; b++) {
    if (world->island_of[b] == SPORE_NO_BODY) continue;
    SporeIsland *island = &world->islands[world->island_of[b]];
    world->island_bodies[island->body_start + island->body_count++] = b;
  }
  for (size_t i = 0; i < world->contact_count; i++) {
    uint32_t index = island_of_contact(world, i);
    if (index == SPORE_NO_BODY) continue;
    SporeIsland *island = &world->islands[index];
    world->contact_order[island->contact_start + island->contact_count++] = (uint32_t)i;
  }
  for (size_t i = 0; i < springs; i++) {
    uint32_t index = island_of_spring(world, i);
    if (index == SPORE_NO_BODY) continue;
    SporeIsland *island = &world->islands[index];
    world->spring_order[island->spring_start + island->spring_count++] = (uint32_t)i;
  }
}

void spore_world_group(SporeWorld *world) {
  size_t springs = spore_world_spring_count(world);
  tie_bodies(world);
  number_islands(world);
  count_terms(world, springs);
  mix_jointed(world);
  set_starts(world);
  fill_islands(world, springs);
}

static bool remembers(const SporeWorld *world, const SporeIsland *island, const SporeBody *body) {
  return body->history_s > 0 && body->history_step == world->step && body->history_kind == island->integrator;
}

/* What all bodies of the island remember, of steps of one size; the smallest where a method chooses its own. */
static void gather_history(SporeWorld *world, SporeIsland *island) {
  island->history =
      (SporeHistory){.a = world->local_history_a + island->v_start, .b = world->local_history_b + island->v_start};
  double step_s = HUGE_VAL;
  bool own_size = spore_integrator(island->integrator)->chooses_step;
  for (size_t i = 0; i < island->kept_count; i++) {
    uint32_t b = world->island_bodies[island->body_start + i];
    const SporeBody *body = &world->bodies[b];
    if (!remembers(world, island, body)) return;
    if (!own_size && i > 0 && body->history_s != step_s) return;
    step_s = fmin(step_s, body->history_s);
    size_t at = world->local_sites[b].v, size = 3 * body->block_count * sizeof(double);
    memcpy(island->history.a + at, world->history_a + body->v_offset, size);
    memcpy(island->history.b + at, world->history_b + body->v_offset, size);
  }
  island->history.step_s = step_s;
}

void spore_island_remember(SporeWorld *world, const SporeIsland *island) {
  if (!spore_integrator(island->integrator)->remembers) return;
  for (size_t i = 0; i < island->kept_count; i++) {
    uint32_t b = world->island_bodies[island->body_start + i];
    SporeBody *body = &world->bodies[b];
    size_t at = world->local_sites[b].v, size = 3 * body->block_count * sizeof(double);
    body->history_kind = island->integrator;
    body->history_s = island->history.step_s;
    body->history_step = world->step + 1;
    memcpy(world->history_a + body->v_offset, island->history.a + at, size);
    memcpy(world->history_b + body->v_offset, island->history.b + at, size);
  }
}

/* Gives the bodies their places next to each other; true when that is how they lie in the world's vectors. */
static bool place_bodies(SporeWorld *world, SporeIsland *island) {
  const uint32_t *bodies = world->island_bodies + island->body_start;
  const SporeBody *first = &world->bodies[bodies[0]];
  bool adjoin = true;
  island->q_count = island->v_count = 0;
  for (size_t i = 0; i < island->kept_count; i++) {
    const SporeBody *body = &world->bodies[bodies[i]];
    world->local_sites[bodies[i]] = (SporeSite){island->q_count, island->v_count};
    adjoin &=
        body->q_offset - first->q_offset == island->q_count && body->v_offset - first->v_offset == island->v_count;
    island->q_count += body->q_count;
    island->v_count += 3 * body->block_count;
  }
  return adjoin;
}

static void copy_together(SporeWorld *world, const SporeIsland *island) {
  for (size_t i = 0; i < island->kept_count; i++) {
    uint32_t b = world->island_bodies[island->body_start + i];
    const SporeBody *body = &world->bodies[b];
    const SporeSite *site = &world->local_sites[b];
    memcpy(world->local_q0 + island->q_start + site->q, world->q + body->q_offset, body->q_count * sizeof(double));
    memcpy(world->local_v0 + island->v_start + site->v, world->v + body->v_offset,
           3 * body->block_count * sizeof(double));
  }
}

void spore_island_gather(SporeWorld *world, SporeIsland *island) {
  const uint32_t *bodies = world->island_bodies + island->body_start;
  const SporeBody *first = &world->bodies[bodies[0]];
  double mass = 0;
  island->attempts++;
  for (size_t i = 0; i < island->kept_count; i++) mass += world->bodies[bodies[i]].total_mass;
  island->gravity_momentum = sqrt(mass) * spore_vec3_length(world->gravity);
  island->in_place = place_bodies(world, island);
  if (spore_integrator(island->integrator)->remembers && island->kept_count > 0) gather_history(world, island);
  if (island->in_place) {
    island->q0 = world->q + first->q_offset;
    island->v0 = world->v + first->v_offset;
    island->q1 = world->next_q + first->q_offset;
    island->v1 = world->next_v + first->v_offset;
    return;
  }
  copy_together(world, island);
  island->q0 = world->local_q0 + island->q_start;
  island->v0 = world->local_v0 + island->v_start;
  island->q1 = world->local_q1 + island->q_start;
  island->v1 = world->local_v1 + island->v_start;
}
