/* Energy watch: detects a body whose energy grows because its step is too long.
 *
 * In explicit steps that are too long for the stiffness, the energy of a body grows without bound. An implicit method
 * that keeps or damps the energy of linear motion may still gain energy where a step does not resolve nonlinear motion:
 * a very stiff body that turns is stretched a little in each step, to the order of the method, and its stiffness turns
 * the stretch into energy. No other trouble looks like that, so the bound can be wide: GROWTH times the energy that the
 * body had when the watch began, plus what gravity, contacts and links have given it since.
 *
 * Below the largest stable step, kinetic plus strain energy of a mode swings by a factor (1 + h w / 2) / (1 - h w / 2),
 * 14 at most where h w < 1.73 (Hairer, Lubich and Wanner, Acta Numerica 12, 2003, section 1: the modified energy of
 * Stoermer and Verlet). Rigid bodies are not watched: nothing in them is stiff, and contacts are softened for explicit
 * steps. */
#include <assert.h>

#include "core/sim/world_private.h"

#define GROWTH 20.
#define GROWTH_DAMPED 2.    /* of methods that damp modes they do not resolve: the energy of these does not swing */
#define WATCH_STEPS 32      /* between two checks in explicit steps, since energy costs as much as a force */
#define SMALLEST_SPEED 1e-6 /* m/s: below, it is rounding */

/* A model with a Jacobian is elastic: its potential is least, 0, at rest. */
static bool is_watched(const SporeBody *body) {
  assert(body->model);
  return body->model->type->jacobian && spore_integrator(body->method.integrator)->damping < SPORE_DAMPING_FULL;
}

/* Adds the work of the end's force on its body in this step, whatever its sign. */
static void add_work(SporeWorld *world, const SporeIsland *island, const SporeEnd *end, SporeVec3 force) {
  assert(end->prescribed || end->body < world->body_count);
  if (end->prescribed) return;
  SporeBody *body = &world->bodies[end->body];
  if (!is_watched(body)) return;
  const SporeSite *site = &world->solve.local_sites[end->body];
  SporeVec3 velocity = spore_mapping_velocity(end->mapping, end->point, island->q1 + site->q, island->v1 + site->v);
  body->watch.given += fabs(spore_vec3_dot(force, velocity)) * world->solver.time_step;
}

static void add_works(SporeWorld *world, const SporeIsland *island) {
  assert(island->contact_start + island->contact_count <= world->contact.count);
  for (size_t i = 0; i < island->contact_count; i++) {
    const SporeContactTerm *term = &world->contact.terms[world->contact.order[island->contact_start + i]];
    add_work(world, island, &term->a, term->force);
    add_work(world, island, &term->b, term->force);
  }
  for (size_t i = 0; i < island->spring_count; i++) {
    const SporeSpringTerm *term = &world->links.springs[world->links.order[island->spring_start + i]];
    add_work(world, island, &term->a, term->force);
    add_work(world, island, &term->b, term->force);
  }
}

/* Most steps between two checks. In an implicit step a check costs little, and a single step may go wrong. */
static uint32_t steps_between(const SporeBody *body) {
  return spore_integrator(body->method.integrator)->implicit ? 1 : WATCH_STEPS;
}

/* Energy that rounding, and gravity between two checks, may give the body, J. */
static double noise(const SporeWorld *world, const SporeBody *body) {
  double speed =
      SMALLEST_SPEED + steps_between(body) * world->solver.time_step * spore_vec3_length(world->state.gravity);
  return body->total_mass * speed * speed;
}

/* Checks are frequent at first, after 1, 2, 4, 8, ... steps, since a changed body may go wrong at once. */
static bool is_time_to_look(uint32_t steps, uint32_t between) {
  assert(steps >= 1 && between >= 1);
  return steps < between ? (steps & (steps - 1)) == 0 : steps % between == 0;
}

static double own_energy(const SporeWorld *world, const SporeBody *body, const double *q, const double *v) {
  return spore_body_kinetic_energy(world, body, v) + body->model->type->potential(body->model, q);
}

/* Begins the watch, from the state that the step began in. */
static void start(const SporeWorld *world, SporeBody *body) {
  const double *q = world->state.q + body->q_offset;
  body->watch = (SporeEnergyWatch){.started = true,
                                   .own = own_energy(world, body, q, world->state.v + body->v_offset),
                                   .height = spore_body_gravity_energy(world, body, q)};
}

static bool holds(const SporeWorld *world, SporeBody *body, const double *q, const double *v) {
  assert(body->watch.started);
  SporeEnergyWatch *watch = &body->watch;
  if (!is_time_to_look(++watch->steps, steps_between(body))) return true;
  double had = watch->own + watch->given + fmax(watch->height - spore_body_gravity_energy(world, body, q), 0);
  double growth = spore_integrator(body->method.integrator)->damping == SPORE_DAMPING_FAST ? GROWTH_DAMPED : GROWTH;
  return own_energy(world, body, q, v) <= growth * had + noise(world, body);
}

bool spore_island_energy_holds(SporeWorld *world, SporeIsland *island) {
  assert(island->kept_count <= island->body_count);
  assert(island->body_start + island->body_count <= world->body_count);
  bool watched = false;
  for (size_t i = 0; i < island->kept_count; i++) {
    SporeBody *body = &world->bodies[world->solve.island_bodies[island->body_start + i]];
    if (!is_watched(body)) continue;
    if (!body->watch.started) start(world, body);
    watched = true;
  }
  if (!watched) return true;
  add_works(world, island);
  for (size_t i = 0; i < island->kept_count; i++) {
    uint32_t b = world->solve.island_bodies[island->body_start + i];
    const SporeSite *site = &world->solve.local_sites[b];
    if (!is_watched(&world->bodies[b]) || holds(world, &world->bodies[b], island->q1 + site->q, island->v1 + site->v))
      continue;
    island->offender = b;
    return false;
  }
  return true;
}
