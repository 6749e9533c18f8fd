/* Energy watch: bodies that physics moves have no more energy than when the watch began, but for the work of what
 * drives them.
 *
 * Whatever a step gets wrong makes energy or loses it, and energy that grows out of nothing grows without end. Energy
 * is kinetic, of the models, of links, contacts and gravity. Damping, friction, breaking and cutting only lower it.
 * Devices do the work F.v h at the ends that they drive, and thermostats the work of their power. All other changes
 * from outside (parameters, gravity, particles that come and go, levels of detail) begin the watch anew. So gain = E -
 * E_0 - work is made of nothing where it is positive. It is measured against the energy that is at work: what was there
 * at the start, the largest change of each kind since, what devices turned over, and what gravity gives in a few steps.
 *
 * A look costs as much as a force, so explicit steps are looked at every 64th time. Before that, looks only find what
 * grows fast: explicit Euler makes m g^2 h t / 2 in free fall, a large share at first, and less than a hundredth of
 * what falls after 50 steps. Implicit steps cost more than a look, and a single one may go wrong. */
#include <assert.h>
#include <math.h>

#include "core/base/text.h"
#include "core/sim/world_private.h"

#define GAIN 0.01 /* of the energy at work: steps that make more are not solved */
/* A body that gains more goes on by implicit Euler. Below the largest stable step, the energy of a mode swings by a
 * factor (1 + h w / 2) / (1 - h w / 2), 14 at most where h w < 1.73 (Hairer, Lubich and Wanner, Acta Numerica 12, 2003,
 * section 1: the modified energy of Stoermer and Verlet). Methods that damp modes that they do not resolve let none
 * swing. */
#define GAIN_TO_MEND 20
#define GAIN_TO_MEND_DAMPED 2
#define SMALLEST_SPEED 1e-6 /* m/s: below, it is rounding */
#define FEW_STEPS 4
#define FEW_LOOKS 16 /* steps after which a gain is believed */

/* A method that damps in full makes no energy. */
static bool may_gain(const SporeBody *body) {
  return spore_body_moves(body) && spore_integrator(body->method.integrator)->damping < SPORE_DAMPING_FULL;
}

static bool is_explicit(const SporeBody *body) {
  return spore_body_moves(body) && !spore_integrator(body->method.integrator)->implicit;
}

static uint32_t steps_between(const SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++)
    if (is_explicit(&world->bodies[b])) return SPORE_STEPS_BETWEEN_LOOKS;
  return 1;
}

static void add_turnover(SporeEnergyWatch *watch, double work) {
  watch->work += work;
  watch->turnover += fabs(work);
}

/* Work of the force on a prescribed end, done by what drives the end. */
static void add_end(SporeEnergyWatch *watch, const SporeEnd *end, SporeVec3 force, double h) {
  if (end->prescribed) add_turnover(watch, -h * spore_vec3_dot(force, end->velocity));
}

static void add_work(SporeWorld *world) {
  SporeEnergyWatch *watch = &world->solve.watch;
  double h = world->solver.time_step;
  for (size_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    if (spore_body_moves(body) && body->model->type->power)
      add_turnover(watch, h * body->model->type->power(body->model));
  }
  for (size_t i = 0; i < world->contact.count; i++) {
    const SporeContactTerm *term = &world->contact.terms[i];
    add_end(watch, &term->a, term->force, h);
    add_end(watch, &term->b, spore_vec3_scale(-1, term->force), h);
  }
  size_t springs = spore_world_spring_count(world);
  for (size_t i = 0; i < springs; i++) {
    if (!world->links.active[i]) continue;
    const SporeSpringTerm *term = &world->links.springs[i];
    add_end(watch, &term->a, term->force, h);
    add_end(watch, &term->b, spore_vec3_scale(-1, term->force), h);
  }
}

static double own_energy(const SporeWorld *world, const SporeBody *body) {
  return spore_body_kinetic_energy(world, body, world->state.v + body->v_offset) +
         body->model->type->potential(body->model, world->state.q + body->q_offset);
}

/* What gravity gives in a few steps, and rounding, J. */
static double least_energy(const SporeWorld *world) {
  double speed = SMALLEST_SPEED + FEW_STEPS * world->solver.time_step * spore_vec3_length(world->state.gravity),
         mass = 0;
  for (size_t b = 0; b < world->body_count; b++)
    if (spore_body_moves(&world->bodies[b])) mass += world->bodies[b].total_mass;
  return 0.5 * mass * speed * speed;
}

static double total(const SporeEnergy *energy) {
  return energy->kinetic + energy->internal + energy->gravity + energy->contact;
}

void spore_world_start_watch(SporeWorld *world) {
  if (world->solve.watch.started || !spore_world_may_gain_energy(world)) return;
  SporeEnergy energy = spore_world_energy(world);
  world->solve.watch =
      (SporeEnergyWatch){.started = true,
                         .energy = energy,
                         .had = least_energy(world) + energy.kinetic + fabs(energy.internal) + energy.contact};
  for (size_t b = 0; b < world->body_count; b++)
    if (spore_body_is_physical(&world->bodies[b])) world->bodies[b].own_energy = own_energy(world, &world->bodies[b]);
}

/* The body whose own energy grew most. */
static uint32_t offender(const SporeWorld *world) {
  uint32_t index = SPORE_NO_BODY;
  double most = -HUGE_VAL;
  for (uint32_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    if (!may_gain(body)) continue;
    double grown = own_energy(world, body) - body->own_energy;
    if (index != SPORE_NO_BODY && !(grown > most)) continue;
    most = grown;
    index = b;
  }
  return index;
}

/* A method that made so much energy will make more, so the body goes on by a safe one. Not where elements are met one
 * after the other: what was not met yet is strained, and so has energy, but no step makes it grow. */
static void mend(SporeWorld *world, uint32_t index) {
  SporeBody *body = &world->bodies[index];
  world->state.monitor.energy++;
  if (body->model->type->rates || spore_body_sweeps(body)) return;
  body->method.integrator = SPORE_INTEGRATOR_IMPLICIT_EULER;
  world->solve.watch.started = false;
  spore_world_report(world,
                     _("%s: integrated by %s from now on, because its energy grows beyond what it was given; take a "
                       "smaller time_step, or choose that integrator"),
                     body->name, spore_integrator_names[SPORE_INTEGRATOR_IMPLICIT_EULER]);
}

/* Share of the energy at work that steps may make. It swings at first, and explicit Euler makes m g^2 h t / 2 in free
 * fall, 1 / (2 n) of what is at work after n steps. evaluated: the method only evaluates forces. */
static double bound_after(uint32_t steps, bool evaluated) {
  if (steps < FEW_LOOKS) return HUGE_VAL;
  return evaluated && steps < SPORE_STEPS_BETWEEN_LOOKS ? GAIN * SPORE_STEPS_BETWEEN_LOOKS / steps : GAIN;
}

static void look(SporeWorld *world) {
  SporeEnergyWatch *watch = &world->solve.watch;
  SporeEnergy now = spore_world_energy(world);
  double gain = total(&now) - total(&watch->energy) - watch->work;
  double change = now.kinetic + fabs(now.internal - watch->energy.internal) +
                  fabs(now.gravity - watch->energy.gravity) + fabs(now.contact - watch->energy.contact);
  watch->change = fmax(watch->change, change - fmax(gain, 0));
  double share = gain / (watch->had + watch->change + watch->turnover);
  if (!(share > GAIN)) return;
  uint32_t body = offender(world);
  if (body == SPORE_NO_BODY) return;
  bool evaluated = is_explicit(&world->bodies[body]) && !spore_body_sweeps(&world->bodies[body]);
  if (share > bound_after(watch->steps, evaluated))
    spore_world_count_unsolved(world, body, SPORE_UNSOLVED_ENERGY, share);
  bool damped = spore_integrator(world->bodies[body].method.integrator)->damping == SPORE_DAMPING_FAST;
  if (share > (damped ? GAIN_TO_MEND_DAMPED : GAIN_TO_MEND)) mend(world, body);
}

/* Looks are frequent at first, after 1, 2, 4, 8, ... steps, since a changed body may go wrong at once. */
static bool is_time_to_look(uint32_t steps, uint32_t between) {
  assert(steps >= 1 && between >= 1);
  return steps < between ? (steps & (steps - 1)) == 0 : steps % between == 0;
}

bool spore_world_may_gain_energy(const SporeWorld *world) {
  bool gains = false;
  for (size_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    if (!spore_body_is_physical(body)) continue;
    if (body->method.chosen == SPORE_INTEGRATOR_STATIC) return false;
    gains |= spore_integrator(body->method.chosen)->damping < SPORE_DAMPING_FULL;
  }
  return gains;
}

void spore_world_watch_energy(SporeWorld *world) {
  SporeEnergyWatch *watch = &world->solve.watch;
  if (!watch->started) return; /* something changed since the step began */
  add_work(world);
  if (is_time_to_look(++watch->steps, steps_between(world))) look(world);
}
