/* Force and torque on each body from the contacts and links of the step. */
#include <string.h>

#include "core/sim/world_private.h"

/* What torque is about: the frame's origin, or for a set of nodes that of its frame at time 0. */
static SporeVec3 origin(const SporeWorld *world, const SporeBody *body) {
  bool frame = !body->model || spore_model_is_rigid(body->model);
  return frame ? spore_vec3_load(world->q + body->q_offset) : body->rest_pose.position;
}

static void add_reaction(SporeWorld *world, uint32_t index, SporeVec3 point, SporeVec3 force) {
  if (index == SPORE_NO_BODY || world->bodies[index].asleep) return;
  SporeVec3 arm = spore_vec3_sub(point, origin(world, &world->bodies[index]));
  spore_vec3_accumulate(world->reaction + 6 * (size_t)index, force);
  spore_vec3_accumulate(world->reaction + 6 * (size_t)index + 3, spore_vec3_cross(arm, force));
}

void spore_world_react(SporeWorld *world) {
  /* What sleeps is held as it was when it fell asleep. */
  for (size_t b = 0; b < world->body_count; b++)
    if (!world->bodies[b].asleep) memset(world->reaction + 6 * b, 0, 6 * sizeof *world->reaction);
  for (size_t i = 0; i < world->contact_count; i++) {
    const SporeContactTerm *term = &world->contacts[i];
    SporeVec3 point = spore_contact_term_point(term);
    add_reaction(world, term->a.body, point, term->force);
    add_reaction(world, term->b.body, point, spore_vec3_scale(-1, term->force));
  }
  size_t springs = spore_world_spring_count(world);
  for (size_t i = 0; i < springs; i++) {
    const SporeSpringTerm *term = &world->springs[i];
    if (!world->spring_active[i]) continue;
    add_reaction(world, term->a.body, term->a.position, term->force);
    add_reaction(world, term->b.body, term->b.position, spore_vec3_scale(-1, term->force));
  }
}
