/* Sleep: islands at rest are not mapped, not checked for contacts among themselves, and not integrated.
 *
 * An island falls asleep when all its bodies were slower than their rest speed for REST_TIME_S, and no body that a
 * device moves touches it. Its velocity is then set to 0. The island loses the rest of the way to its equilibrium: at
 * most the rest speed times its longest time constant where the motion dies away or swings about an equilibrium, and an
 * energy of at most M rest_speed^2 / 2.
 *
 * Bodies that fell asleep together wake together, before anything else is done with them in the step. They wake when a
 * body that moves touches one of them or is linked to it, and when a command or an edit may have changed the forces on
 * them. */
#include <assert.h>
#include <float.h>
#include <string.h>

#include "core/sim/world_private.h"

#define REST_TIME_S 0.5
#define REST_EXTENTS_PER_S                                                                                             \
  1e-3           /* a body that takes less than this time, 1000 s, to move by its own size is not at rest */
#define CHUNK 64 /* values compared together */

/* Widest side of the bounds of `count` balls about `centre` (3 a ball), m. radius may be NULL. */
static double extent_of(const double *centre, const double *radius, size_t count) {
  assert(count == 0 || centre);
  double widest = 0;
  for (size_t k = 0; k < 3; k++) {
    double lower = HUGE_VAL, upper = -HUGE_VAL;
    for (size_t i = 0; i < count; i++) {
      double reach = radius ? radius[i] : 0;
      lower = fmin(lower, centre[3 * i + k] - reach);
      upper = fmax(upper, centre[3 * i + k] + reach);
    }
    if (count) widest = fmax(widest, upper - lower);
  }
  return widest;
}

static double body_extent(const SporeWorld *world, const SporeBody *body) {
  const SporeSpheres *spheres = &world->contact.spheres;
  if (body->collision.spheres.point_count > 0)
    return extent_of(spheres->centre + 3 * body->collision.start, spheres->radius + body->collision.start,
                     body->collision.spheres.point_count);
  return extent_of(world->state.rest_q + body->q_offset, NULL, body->model->node_count);
}

void spore_world_create_sleep(SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    body->sleep.next = (uint32_t)b;
    if (!body->model) continue;
    double extent = body_extent(world, body);
    body->sleep.speed = world->solver.sleep_speed;
    if (extent > 0) body->sleep.speed = fmin(body->sleep.speed, REST_EXTENTS_PER_S * extent);
    body->sleep.spin = body->sleep.speed / (extent > 0 ? extent : 1);
  }
}

static bool all_below(const double *values, size_t count, double limit) {
  assert(limit >= 0);
  for (size_t i = 0; i < count; i += CHUNK) {
    size_t outside = 0, end = i + CHUNK < count ? i + CHUNK : count;
    for (size_t k = i; k < end; k++) outside += !(fabs(values[k]) <= limit);
    if (outside) return false;
  }
  return true;
}

static bool body_rests(const SporeBody *body, const double *v) {
  if (spore_model_is_nodal(body->model)) return all_below(v, 3 * body->block_count, body->sleep.speed);
  for (size_t i = 0; i < body->block_count; i++)
    if (!all_below(v + 3 * i, 3, body->model->block_mass[i] > 0 ? body->sleep.speed : body->sleep.spin)) return false;
  return true;
}

static bool is_driven(const SporeWorld *world, const SporeEnd *end) {
  assert(end->body == SPORE_NO_BODY || end->body < world->body_count);
  return end->body != SPORE_NO_BODY && world->bodies[end->body].role == SPORE_ACTIVE;
}

static bool touches_driven(const SporeWorld *world, const SporeIsland *island) {
  for (size_t i = 0; i < island->contact_count; i++) {
    const SporeContactTerm *term = &world->contact.terms[world->contact.order[island->contact_start + i]];
    if (is_driven(world, &term->a) || is_driven(world, &term->b)) return true;
  }
  for (size_t i = 0; i < island->spring_count; i++) {
    const SporeSpringTerm *term = &world->links.springs[world->links.order[island->spring_start + i]];
    if (is_driven(world, &term->a) || is_driven(world, &term->b)) return true;
  }
  return false;
}

bool spore_island_rests(const SporeWorld *world, const SporeIsland *island) {
  assert(island->kept_count <= island->body_count);
  assert(island->body_start + island->body_count <= world->body_count);
  if (!(world->solver.sleep_speed > 0) || island->trouble != SPORE_TROUBLE_NONE) return false;
  for (size_t i = 0; i < island->kept_count; i++) {
    uint32_t b = world->solve.island_bodies[island->body_start + i];
    if (!body_rests(&world->bodies[b], island->v1 + world->solve.local_sites[b].v)) return false;
  }
  return !touches_driven(world, island);
}

static void set_asleep(SporeWorld *world, uint32_t index, bool asleep) {
  assert(index < world->body_count && world->bodies[index].sleep.asleep != asleep);
  assert(asleep || world->solve.sleeping_count > 0);
  SporeBody *body = &world->bodies[index];
  body->sleep.asleep = asleep;
  body->sleep.steps = 0;
  body->history.step_s = 0;
  body->sleep.energy = 0;
  if (asleep) world->solve.sleeping_count++;
  else world->solve.sleeping_count--;
  if (world->contact.grid) spore_grid_set_asleep(world->contact.grid, index, asleep);
}

/* Number of consecutive steps at rest, this one included: the least of the bodies, which may have met lately. */
static uint64_t count_rest(SporeWorld *world, const SporeIsland *island) {
  uint64_t least = UINT64_MAX;
  for (size_t i = 0; i < island->kept_count; i++) {
    SporeBody *body = &world->bodies[world->solve.island_bodies[island->body_start + i]];
    body->sleep.steps = island->rests ? body->sleep.steps + 1 : 0;
    if (body->sleep.steps < least) least = body->sleep.steps;
  }
  return least;
}

void spore_island_let_sleep(SporeWorld *world, SporeIsland *island) {
  assert(island->body_start + island->body_count <= world->body_count);
  island->falls_asleep = false;
  if (!(world->solver.sleep_speed > 0) || island->kept_count == 0) return;
  if ((double)count_rest(world, island) * world->solver.time_step < REST_TIME_S) return;
  const uint32_t *bodies = world->solve.island_bodies + island->body_start;
  island->falls_asleep = true;
  for (size_t i = 0; i < island->kept_count; i++) {
    SporeBody *body = &world->bodies[bodies[i]];
    set_asleep(world, bodies[i], true);
    body->sleep.next = bodies[i + 1 < island->kept_count ? i + 1 : 0];
    memset(world->state.next_v + body->v_offset, 0, 3 * body->block_count * sizeof(double));
  }
}

void spore_island_keep_energy(SporeWorld *world, const SporeIsland *island) {
  assert(island->falls_asleep && island->kept_count >= 1);
  double *energy = &world->bodies[world->solve.island_bodies[island->body_start]].sleep.energy;
  for (size_t i = 0; i < island->contact_count; i++) {
    const SporeContactTerm *term = &world->contact.terms[world->contact.order[island->contact_start + i]];
    *energy += spore_contact_term_energy(term, world->state.sites, world->state.q);
  }
}

void spore_world_wake(SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  world->bodies[body].effect.settled = false; /* drops lie no more */
  while (world->bodies[body].sleep.asleep) {
    set_asleep(world, body, false);
    body = world->bodies[body].sleep.next;
  }
}

void spore_world_wake_all(SporeWorld *world) {
  for (uint32_t b = 0; b < world->body_count; b++) spore_world_wake(world, b);
}

/* Wakes a sleeping body if the other body is moved by physics or by a device. True: one was woken. */
static bool wake_either(SporeWorld *world, uint32_t a, uint32_t b) {
  assert(a == SPORE_NO_BODY || a < world->body_count);
  assert(b == SPORE_NO_BODY || b < world->body_count);
  if (a == SPORE_NO_BODY || b == SPORE_NO_BODY) return false;
  const SporeBody *first = &world->bodies[a], *second = &world->bodies[b];
  if (first->sleep.asleep == second->sleep.asleep) return false;
  const SporeBody *other = first->sleep.asleep ? second : first;
  if (!spore_body_moves(other) && other->role != SPORE_ACTIVE) return false;
  spore_world_wake(world, first->sleep.asleep ? a : b);
  return true;
}

static bool wake_tied(SporeWorld *world) {
  size_t springs = spore_world_spring_count(world);
  bool woken = false;
  for (size_t i = 0; i < springs; i++)
    if (world->links.active[i])
      woken |= wake_either(world, world->links.springs[i].a.body, world->links.springs[i].b.body);
  return woken;
}

static bool wake_touched(SporeWorld *world) {
  const SporeContact *contacts = world->contact.grid ? spore_grid_contacts(world->contact.grid) : NULL;
  bool woken = false;
  for (size_t i = 0; i < world->contact.count; i++)
    woken |= wake_either(world, world->contact.spheres.body[contacts[i].a], world->contact.spheres.body[contacts[i].b]);
  return woken;
}

/* A body that wakes may touch others that sleep, so this goes on until none wakes. */
void spore_world_wake_touched(SporeWorld *world) {
  assert(world->solve.sleeping_count <= world->body_count);
  while (world->solve.sleeping_count > 0) {
    bool tied = wake_tied(world), touched = wake_touched(world);
    if (!tied && !touched) return;
    if (world->contact.grid) spore_world_detect(world);
  }
}
