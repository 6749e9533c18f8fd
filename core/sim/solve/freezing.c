/* Freezing: takes a body that no step helps out of its island, and lets it move again. */
#include <assert.h>
#include <string.h>

#include "core/sim/world_private.h"

static bool stand_still(const SporeEnd *a, const SporeEnd *b) { return a->prescribed && b->prescribed; }

/* A device ends the step where its end of the term is then, however far an attempt came. */
static void end_step(const SporeWorld *world, SporeEnd *end) {
  if (end->prescribed) end->offset = spore_vec3_scale(world->solver.time_step, end->velocity);
}

/* Leaves the end where its body was when the step began. */
static void prescribe(SporeEnd *end, uint32_t body) {
  const SporeVec3 none = {0, 0, 0};
  if (end->body != body) return;
  end->prescribed = true;
  end->velocity = end->offset = none;
}

/* Attempts move the place of a curve joint along its path. The path stands still now, and so does the place. */
static void stop_running(const SporeWorld *world, SporeSpringTerm *term, uint32_t body) {
  if (!term->curve || term->b.body != body) return;
  SporePathPlace place =
      spore_curve_joint_place(term->curve, world->state.q + world->bodies[body].q_offset, term->a.position);
  spore_curve_joint_set(term, &place);
}

/* For the terms of the island the body stands still. A term that nothing else moves leaves the island: its force, which
 * devices may feel, is known. */
static void release_contacts(SporeWorld *world, SporeIsland *island, uint32_t body) {
  assert(island->contact_start + island->contact_count <= world->contact.count);
  uint32_t *order = world->contact.order + island->contact_start;
  size_t kept = 0;
  for (size_t i = 0; i < island->contact_count; i++) {
    SporeContactTerm *term = &world->contact.terms[order[i]];
    prescribe(&term->a, body);
    prescribe(&term->b, body);
    if (!stand_still(&term->a, &term->b)) {
      order[kept++] = order[i];
      continue;
    }
    end_step(world, &term->a);
    end_step(world, &term->b);
    spore_contact_term_hold(term);
  }
  island->contact_count = kept;
}

static void release_springs(SporeWorld *world, SporeIsland *island, uint32_t body) {
  assert(island->spring_start + island->spring_count <= spore_world_spring_count(world));
  uint32_t *order = world->links.order + island->spring_start;
  size_t kept = 0;
  for (size_t i = 0; i < island->spring_count; i++) {
    SporeSpringTerm *term = &world->links.springs[order[i]];
    stop_running(world, term, body);
    prescribe(&term->a, body);
    prescribe(&term->b, body);
    if (!stand_still(&term->a, &term->b)) {
      order[kept++] = order[i];
      continue;
    }
    end_step(world, &term->a);
    end_step(world, &term->b);
    spore_spring_term_hold(term);
  }
  island->spring_count = kept;
}

void spore_island_freeze(SporeWorld *world, SporeIsland *island, uint32_t index) {
  assert(index < world->body_count && !world->bodies[index].frozen);
  assert(island->kept_count >= 1);
  uint32_t *bodies = world->solve.island_bodies + island->body_start;
  world->bodies[index].frozen = true;
  if (!spore_model_is_nodal(world->bodies[index].model))
    spore_body_turn_mass(world, &world->bodies[index], world->state.q + world->bodies[index].q_offset);
  size_t at = 0;
  while (bodies[at] != index) at++;
  assert(at < island->kept_count);
  memmove(bodies + at, bodies + at + 1, (island->kept_count - at - 1) * sizeof *bodies);
  bodies[--island->kept_count] = index;
  release_contacts(world, island, index);
  release_springs(world, island, index);
  island->trouble = SPORE_TROUBLE_NOT_FINITE;
}

void spore_body_thaw(SporeBody *body) {
  body->frozen = false;
  body->hopeless = 0;
  body->pause = body->impatience = (SporePause){0, 0};
  body->reported.trouble = SPORE_TROUBLE_NONE;
}
