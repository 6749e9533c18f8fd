/* Islands: sets of bodies that terms couple in this step. A body that physics does not move couples nothing. It takes
 * part in the terms of every island that it touches. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/sim/world_private.h"

static uint32_t find_root(uint32_t *parent, uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/* The lower index becomes the root, so that islands come in the order of their first bodies. */
static void tie(uint32_t *parent, const SporeEnd *a, const SporeEnd *b) {
  assert(a->prescribed || b->prescribed || (a->body != SPORE_NO_BODY && b->body != SPORE_NO_BODY));
  if (a->prescribed || b->prescribed || a->body == b->body) return;
  uint32_t i = find_root(parent, a->body), j = find_root(parent, b->body);
  if (i < j) parent[j] = i;
  else parent[i] = j;
}

static void tie_bodies(SporeWorld *world) {
  for (uint32_t b = 0; b < world->body_count; b++) world->solve.parent[b] = b;
  for (size_t i = 0; i < world->contact.count; i++)
    tie(world->solve.parent, &world->contact.terms[i].a, &world->contact.terms[i].b);
  size_t springs = spore_world_spring_count(world);
  for (size_t i = 0; i < springs; i++)
    if (world->links.active[i]) tie(world->solve.parent, &world->links.springs[i].a, &world->links.springs[i].b);
}

/* Adds the body's choice of a method. Bodies with the same choice move by it. Implicit bodies with different choices
 * move by the method that damps most. Other islands are multirate: implicit Euler couples their bodies. */
static void add_choice(SporeIsland *island, const SporeBody *body) {
  assert(body->method.substeps >= 1 && island->substeps >= 1);
  const SporeIntegrator *its = spore_integrator(body->method.integrator),
                        *before = spore_integrator(island->integrator);
  bool alike = body->method.integrator == island->integrator && body->method.substeps == island->substeps;
  bool explicit_one = !its->implicit || !before->implicit;
  bool static_one =
      (body->method.integrator == SPORE_INTEGRATOR_STATIC) != (island->integrator == SPORE_INTEGRATOR_STATIC);
  if (island->multirate || (explicit_one && !alike) || static_one) {
    island->multirate = true;
    island->integrator = SPORE_INTEGRATOR_IMPLICIT_EULER;
    return;
  }
  if (its->damping > before->damping) island->integrator = body->method.integrator;
  if (body->method.substeps > island->substeps) island->substeps = body->method.substeps;
}

/* Numbers the islands and counts their bodies. */
static void number_islands(SporeWorld *world) {
  world->solve.island_count = 0;
  for (uint32_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    world->solve.island_of[b] = SPORE_NO_BODY;
    if (!spore_body_moves(body)) continue;
    uint32_t root = find_root(world->solve.parent, b);
    assert(root <= b);
    if (root == b) {
      world->solve.islands[world->solve.island_count] =
          (SporeIsland){.integrator = body->method.integrator, .substeps = body->method.substeps};
      world->solve.island_of[b] = (uint32_t)world->solve.island_count++;
    } else {
      world->solve.island_of[b] = world->solve.island_of[root];
    }
    SporeIsland *island = &world->solve.islands[world->solve.island_of[b]];
    island->body_count++;
    island->q_count += body->q_count;
    island->v_count += 3 * body->block_count;
    add_choice(island, body);
  }
}

static uint32_t island_of_term(const SporeWorld *world, const SporeEnd *a, const SporeEnd *b) {
  assert(a->prescribed || a->body < world->body_count);
  assert(b->prescribed || b->body < world->body_count);
  if (!a->prescribed) return world->solve.island_of[a->body];
  return b->prescribed ? SPORE_NO_BODY : world->solve.island_of[b->body];
}

static uint32_t island_of_contact(const SporeWorld *world, size_t i) {
  assert(i < world->contact.count);
  return island_of_term(world, &world->contact.terms[i].a, &world->contact.terms[i].b);
}

static uint32_t island_of_spring(const SporeWorld *world, size_t i) {
  assert(i < spore_world_spring_count(world));
  if (!world->links.active[i]) return SPORE_NO_BODY;
  return island_of_term(world, &world->links.springs[i].a, &world->links.springs[i].b);
}

static void count_terms(SporeWorld *world, size_t springs) {
  assert(springs == spore_world_spring_count(world));
  for (size_t i = 0; i < world->contact.count; i++) {
    uint32_t island = island_of_contact(world, i);
    if (island != SPORE_NO_BODY) world->solve.islands[island].contact_count++;
  }
  for (size_t i = 0; i < springs; i++) {
    uint32_t island = island_of_spring(world, i);
    if (island != SPORE_NO_BODY) world->solve.islands[island].spring_count++;
  }
}

static void set_starts(SporeWorld *world) {
  SporeIsland end = {0};
  for (size_t i = 0; i < world->solve.island_count; i++) {
    SporeIsland *island = &world->solve.islands[i];
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
  assert(springs == spore_world_spring_count(world));
  for (uint32_t b = 0; b < world->body_count; b++) {
    if (world->solve.island_of[b] == SPORE_NO_BODY) continue;
    SporeIsland *island = &world->solve.islands[world->solve.island_of[b]];
    world->solve.island_bodies[island->body_start + island->body_count++] = b;
  }
  for (size_t i = 0; i < world->contact.count; i++) {
    uint32_t index = island_of_contact(world, i);
    if (index == SPORE_NO_BODY) continue;
    SporeIsland *island = &world->solve.islands[index];
    world->contact.order[island->contact_start + island->contact_count++] = (uint32_t)i;
  }
  for (size_t i = 0; i < springs; i++) {
    uint32_t index = island_of_spring(world, i);
    if (index == SPORE_NO_BODY) continue;
    SporeIsland *island = &world->solve.islands[index];
    world->links.order[island->spring_start + island->spring_count++] = (uint32_t)i;
  }
}

void spore_world_find_islands(SporeWorld *world) {
  size_t springs = spore_world_spring_count(world);
  tie_bodies(world);
  number_islands(world);
  count_terms(world, springs);
  set_starts(world);
  fill_islands(world, springs);
}

static bool remembers(const SporeWorld *world, const SporeIsland *island, const SporeBody *body) {
  return body->history.step_s > 0 && body->history.step == world->state.step &&
         body->history.kind == island->integrator;
}

/* Gathers the history, if all bodies have one of the same step size; the smallest size if the method chooses its own.
 */
static void gather_history(SporeWorld *world, SporeIsland *island) {
  assert(island->body_start + island->body_count <= world->body_count);
  island->history = (SporeHistory){.a = world->solve.local_history_a + island->v_start,
                                   .b = world->solve.local_history_b + island->v_start};
  double step_s = HUGE_VAL;
  bool own_size = spore_integrator(island->integrator)->chooses_step;
  for (size_t i = 0; i < island->kept_count; i++) {
    uint32_t b = world->solve.island_bodies[island->body_start + i];
    const SporeBody *body = &world->bodies[b];
    if (!remembers(world, island, body)) return;
    if (!own_size && i > 0 && body->history.step_s != step_s) return;
    step_s = fmin(step_s, body->history.step_s);
    size_t at = world->solve.local_sites[b].v, size = 3 * body->block_count * sizeof(double);
    memcpy(island->history.a + at, world->solve.history_a + body->v_offset, size);
    memcpy(island->history.b + at, world->solve.history_b + body->v_offset, size);
  }
  island->history.step_s = step_s;
}

void spore_island_remember(SporeWorld *world, const SporeIsland *island) {
  assert(island->kept_count <= island->body_count);
  assert(island->body_start + island->body_count <= world->body_count);
  if (!spore_integrator(island->integrator)->remembers) return;
  for (size_t i = 0; i < island->kept_count; i++) {
    uint32_t b = world->solve.island_bodies[island->body_start + i];
    SporeBody *body = &world->bodies[b];
    size_t at = world->solve.local_sites[b].v, size = 3 * body->block_count * sizeof(double);
    body->history.kind = island->integrator;
    body->history.step_s = island->history.step_s;
    body->history.step = world->state.step + 1;
    memcpy(world->solve.history_a + body->v_offset, island->history.a + at, size);
    memcpy(world->solve.history_b + body->v_offset, island->history.b + at, size);
  }
}

/* Places the bodies next to each other. True: they lie like that in the world's vectors too. */
static bool place_bodies(SporeWorld *world, SporeIsland *island) {
  const uint32_t *bodies = world->solve.island_bodies + island->body_start;
  const SporeBody *first = &world->bodies[bodies[0]];
  bool adjoin = true;
  island->q_count = island->v_count = 0;
  for (size_t i = 0; i < island->kept_count; i++) {
    const SporeBody *body = &world->bodies[bodies[i]];
    world->solve.local_sites[bodies[i]] = (SporeSite){island->q_count, island->v_count};
    adjoin &=
        body->q_offset - first->q_offset == island->q_count && body->v_offset - first->v_offset == island->v_count;
    island->q_count += body->q_count;
    island->v_count += 3 * body->block_count;
  }
  return adjoin;
}

static void copy_together(SporeWorld *world, const SporeIsland *island) {
  for (size_t i = 0; i < island->kept_count; i++) {
    uint32_t b = world->solve.island_bodies[island->body_start + i];
    const SporeBody *body = &world->bodies[b];
    const SporeSite *site = &world->solve.local_sites[b];
    memcpy(world->solve.local_q0 + island->q_start + site->q, world->state.q + body->q_offset,
           body->q_count * sizeof(double));
    memcpy(world->solve.local_v0 + island->v_start + site->v, world->state.v + body->v_offset,
           3 * body->block_count * sizeof(double));
  }
}

void spore_island_gather(SporeWorld *world, SporeIsland *island) {
  assert(island->body_count >= 1 && island->kept_count <= island->body_count);
  assert(island->body_start + island->body_count <= world->body_count);
  const uint32_t *bodies = world->solve.island_bodies + island->body_start;
  const SporeBody *first = &world->bodies[bodies[0]];
  double mass = 0;
  island->attempts++;
  island->equations.count = 0;
  for (size_t i = 0; i < island->kept_count; i++) mass += world->bodies[bodies[i]].total_mass;
  island->gravity_momentum = sqrt(mass) * spore_vec3_length(world->state.gravity);
  island->least_force = island->gravity_momentum > 0 ? 0 : sqrt(mass) * SPORE_LEAST_GRAVITY;
  island->in_place = place_bodies(world, island);
  if (spore_integrator(island->integrator)->remembers && island->kept_count > 0) gather_history(world, island);
  if (island->in_place) {
    island->q0 = world->state.q + first->q_offset;
    island->v0 = world->state.v + first->v_offset;
    island->q1 = world->state.next_q + first->q_offset;
    island->v1 = world->state.next_v + first->v_offset;
    return;
  }
  copy_together(world, island);
  island->q0 = world->solve.local_q0 + island->q_start;
  island->v0 = world->solve.local_v0 + island->v_start;
  island->q1 = world->solve.local_q1 + island->q_start;
  island->v1 = world->solve.local_v1 + island->v_start;
}

bool spore_body_is_hopeless(const SporeWorld *world, const SporeBody *body) {
  return body->hopeless > 0 && world->state.step <= body->hopeless_step + body->pause.length + 1;
}

bool spore_island_is_hopeless(const SporeWorld *world, const SporeIsland *island) {
  assert(island->kept_count <= island->body_count);
  for (size_t i = 0; i < island->kept_count; i++)
    if (spore_body_is_hopeless(world, &world->bodies[world->solve.island_bodies[island->body_start + i]])) return true;
  return false;
}

bool spore_world_create_solve(SporeWorld *world) {
  assert(world->state.v_count % 3 == 0);
  SporeSolve *solve = &world->solve;
  size_t bodies = world->body_count, q = world->state.q_count, v = world->state.v_count;
  solve->scratch_per_block = spore_multirate_scratch();
  solve->parent = SPORE_NEW_ARRAY(uint32_t, bodies);
  solve->island_of = SPORE_NEW_ARRAY(uint32_t, bodies);
  solve->island_bodies = SPORE_NEW_ARRAY(uint32_t, bodies);
  solve->islands = SPORE_NEW_ARRAY(SporeIsland, bodies);
  solve->local_sites = SPORE_NEW_ARRAY(SporeSite, bodies);
  solve->scratch = spore_allocate(v / 3, solve->scratch_per_block * sizeof(double));
  solve->precondition = SPORE_NEW_ARRAY(double, 3 * v);
  solve->lanes = SPORE_NEW_ARRAY(double, spore_world_has_coupled_rooms(world) ? SPORE_LANES *v : 0);
  bool made = solve->parent && solve->island_of && solve->island_bodies && solve->islands && solve->local_sites &&
              solve->scratch && solve->precondition && solve->lanes;
  double **like_q[] = {&solve->local_q0, &solve->local_q1, &solve->best_q};
  double **like_v[] = {&solve->local_v0,  &solve->local_v1,        &solve->best_v,          &solve->history_a,
                       &solve->history_b, &solve->local_history_a, &solve->local_history_b, &solve->still};
  for (size_t i = 0; i < sizeof like_q / sizeof *like_q; i++) made &= (*like_q[i] = SPORE_NEW_ARRAY(double, q)) != NULL;
  for (size_t i = 0; i < sizeof like_v / sizeof *like_v; i++) made &= (*like_v[i] = SPORE_NEW_ARRAY(double, v)) != NULL;
  for (size_t i = 0; i < 2 * SPORE_EQUATIONS; i++) {
    made &= (solve->kept_q[i] = SPORE_NEW_ARRAY(double, q)) != NULL;
    made &= (solve->kept_va[i] = SPORE_NEW_ARRAY(double, v)) != NULL;
    made &= (solve->kept_v[i] = SPORE_NEW_ARRAY(double, v)) != NULL;
    made &= (solve->evaluated[i].q = SPORE_NEW_ARRAY(double, q)) != NULL;
    made &= (solve->evaluated[i].v = SPORE_NEW_ARRAY(double, v)) != NULL;
    made &= (solve->evaluated[i].f = SPORE_NEW_ARRAY(double, v)) != NULL;
  }
  return made;
}

void spore_solve_clear(SporeSolve *solve) {
  void *arrays[] = {solve->parent,   solve->island_of,       solve->island_bodies, solve->islands,
                    solve->scratch,  solve->local_sites,     solve->precondition,  solve->local_q0,
                    solve->local_q1, solve->best_q,          solve->local_v0,      solve->local_v1,
                    solve->best_v,   solve->history_a,       solve->history_b,     solve->local_history_a,
                    solve->still,    solve->local_history_b, solve->lanes};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) spore_free(arrays[i]);
  for (size_t i = 0; i < 2 * SPORE_EQUATIONS; i++) {
    spore_free(solve->kept_q[i]);
    spore_free(solve->kept_va[i]);
    spore_free(solve->kept_v[i]);
    spore_free(solve->evaluated[i].q);
    spore_free(solve->evaluated[i].v);
    spore_free(solve->evaluated[i].f);
  }
}
