/* Whether a step still holds the energy of a body. Where an explicit one does not, the body is stiffer than the step
 * bears, and its energy grows without bound; and a method that only keeps the energy of what is linear may gain it
 * where a step does not resolve what is not. No other trouble looks like that, so the bound can be wide: GROWTH times
 * all that the body had when the watch began and has been given since, by gravity and by contacts and links. Below the
 * largest stable step kinetic plus strain energy of a mode swings by a factor (1 + h w / 2) / (1 - h w / 2), 14 at most
 * where h w < 1.73 (Hairer, Lubich and Wanner, Acta Numerica 12, 2003, section 1: the modified energy of Stoermer and
 * Verlet). Rigid bodies are not watched: nothing in them is stiff, and contacts are softened for explicit steps. */
#include "core/sim/world_private.h"

#define GROWTH 20
#define WATCH_STEPS 32      /* energy costs as much as a force, so that it is looked at so seldom */
#define SMALLEST_SPEED 1e-6 /* m/s: below, it is rounding */

/* A model with a Jacobian is elastic: its potential is least, 0, at rest. */
static bool is_watched(const SporeBody *body) {
  return body->model->type->jacobian && spore_integrator(body->integrator)->damping <= SPORE_DAMPING_NEUTRAL;
}

/* What an end's force of this step gave to the body it hangs on, or took. */
static void add_work(SporeWorld *world, const SporeIsland *island, const SporeEnd *end, SporeVec3 force) {
  if (end->prescribed) return;
  SporeBody *body = &world->bodies[end->body];
  if (!is_watched(body)) return;
  const SporeSite *site = &world->local_sites[end->body];
  SporeVec3 velocity = spore_mapping_velocity(end->mapping, end->point, island->q1 + site->q, island->v1 + site->v);
  body->watch.given += fabs(spore_vec3_dot(force, velocity)) * world->solver.time_step;
}

static void add_works(SporeWorld *world, const SporeIsland *island) {
  for (size_t i = 0; i < island->contact_count; i++) {
    const SporeContactTerm *term = &world->contacts[world->contact_order[island->contact_start + i]];
    add_work(world, island, &term->a, term->force);
    add_work(world, island, &term->b, term->force);
  }
  for (size_t i = 0; i < island->spring_count; i++) {
    const SporeSpringTerm *term = &world->springs[world->spring_order[island->spring_start + i]];
    add_work(world, island, &term->a, term->force);
    add_work(world, island, &term->b, term->force);
  }
}

/* Slower than this it may be by rounding, and by gravity within the time between two looks. */
static double noise(const SporeWorld *world, const SporeBody *body) {
  double speed = SMALLEST_SPEED + WATCH_STEPS * world->solver.time_step * spore_vec3_length(world->gravity);
  return body->total_mass * speed * speed;
}

/* Often at first, for what was changed may go wrong at once: after 1, 2, 4, 8, ... steps. */
static bool is_time_to_look(uint32_t steps) {
  return steps < WATCH_STEPS ? (steps & (steps - 1)) == 0 : steps % WATCH_STEPS == 0;
}

static bool holds(const SporeWorld *world, SporeBody *body, const double *q, const double *v) {
  SporeEnergyWatch *watch = &body->watch;
  if (watch->started && !is_time_to_look(++watch->steps)) return true;
  double own = spore_body_kinetic_energy(world, body, v) + body->model->type->potential(body->model, q);
  double height = spore_body_gravity_energy(world, body, q);
  if (!watch->started) {
    *watch = (SporeEnergyWatch){.started = true, .own = own, .height = height};
    return true;
  }
  double had = watch->own + watch->given + fmax(watch->height - height, 0);
  return own <= GROWTH * had + noise(world, body);
}

bool spore_island_energy_holds(SporeWorld *world, SporeIsland *island) {
  bool watched = false;
  for (size_t i = 0; i < island->kept_count; i++)
    watched |= is_watched(&world->bodies[world->island_bodies[island->body_start + i]]);
  if (!watched) return true;
  add_works(world, island);
  for (size_t i = 0; i < island->kept_count; i++) {
    uint32_t b = world->island_bodies[island->body_start + i];
    const SporeSite *site = &world->local_sites[b];
    if (!is_watched(&world->bodies[b]) || holds(world, &world->bodies[b], island->q1 + site->q, island->v1 + site->v))
      continue;
    island->offender = b;
    return false;
  }
  return true;
}
