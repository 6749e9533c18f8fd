/* Energy of bodies and of the world: kinetic, internal, of gravity and of contacts. */
#include <assert.h>

#include "core/sim/world_private.h"

double spore_body_kinetic_energy(const SporeWorld *world, const SporeBody *body, const double *v) {
  assert(world->state.mass && v);
  const double *mass = world->state.mass + 3 * body->v_offset;
  double twice = 0;
  for (size_t i = 0; i < body->block_count; i++, mass += 9, v += 3)
    for (int r = 0; r < 3; r++) twice += v[r] * (mass[3 * r] * v[0] + mass[3 * r + 1] * v[1] + mass[3 * r + 2] * v[2]);
  return 0.5 * twice;
}

double spore_body_gravity_energy(const SporeWorld *world, const SporeBody *body, const double *q) {
  assert(body->model && q);
  SporeVec3 gravity = spore_body_gravity(world, body);
  double energy = 0;
  for (size_t i = 0; i < body->model->node_count; i++)
    energy -= body->model->block_mass[i] * spore_vec3_dot(gravity, spore_vec3_load(q + 3 * i));
  return energy;
}

static bool sleeps(const SporeWorld *world, const SporeEnd *end) {
  return end->body != SPORE_NO_BODY && world->bodies[end->body].sleep.asleep;
}

/* Energy of the contact; 0 in the step in which its island falls asleep: sleep.energy of a body holds it from then on.
 */
static double contact_energy(const SporeWorld *world, const SporeContactTerm *term) {
  if (sleeps(world, &term->a) || sleeps(world, &term->b)) return 0;
  return spore_contact_term_energy(term, world->state.sites, world->state.q);
}

SporeEnergy spore_world_energy(const SporeWorld *world) {
  assert(world->contact.count <= world->contact.capacity);
  SporeEnergy energy = {0, 0, 0, 0};
  for (size_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    if (!body->model || body->effect.on) continue;
    energy.kinetic += spore_body_kinetic_energy(world, body, world->state.v + body->v_offset);
    energy.contact += body->sleep.energy;
    energy.gravity += spore_body_gravity_energy(world, body, world->state.q + body->q_offset);
    energy.internal += body->model->type->potential(body->model, world->state.q + body->q_offset);
  }
  size_t springs = spore_world_spring_count(world);
  for (size_t i = 0; i < springs; i++)
    if (world->links.active[i])
      energy.internal += spore_spring_term_energy(&world->links.springs[i], world->state.sites, world->state.q);
  for (size_t i = 0; i < world->contact.count; i++) energy.contact += contact_energy(world, &world->contact.terms[i]);
  return energy;
}
