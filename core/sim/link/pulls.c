/* Pulls: springs that commands create between a body and a point of the world. */
#include <float.h>

#include "core/sim/world_private.h"

size_t spore_world_pull_index(const SporeWorld *world, uint32_t body) {
  return world->links.term_count + world->links.hold_count + body;
}

/* A mapping for each pull: a rigid body needs room for one point of its frame. Nodes need none, but may come while the
 * world runs: the mapping counts all that there may be. */
bool spore_world_create_pulls(SporeWorld *world) {
  const double origin[3] = {0, 0, 0};
  for (size_t b = 0; b < world->body_count; b++) {
    size_t index = spore_world_pull_index(world, (uint32_t)b);
    const SporeModel *model = world->bodies[b].model;
    SporeMapping *end_a = &world->links.mappings[2 * index], *end_b = end_a + 1;
    if (!model) continue;
    bool made = spore_model_is_rigid(model) ? spore_mapping_init_points(end_a, SPORE_MAPPING_RIGID, origin, 1, NULL)
                                            : spore_mapping_init_identity(end_a, model->block_room);
    if (!made || !spore_mapping_init_points(end_b, SPORE_MAPPING_FIXED, origin, 1, NULL)) return false;
    world->links.springs[index].a = (SporeEnd){.mapping = end_a, .body = (uint32_t)b};
    world->links.springs[index].b = (SporeEnd){.mapping = end_b, .body = SPORE_NO_BODY};
  }
  return true;
}

static size_t nearest_block(const double *q, size_t count, SporeVec3 point) {
  size_t nearest = 0;
  double best = DBL_MAX;
  for (size_t i = 0; i < count; i++) {
    double distance = spore_vec3_distance(spore_vec3_load(q + 3 * i), point);
    if (distance < best) best = distance, nearest = i;
  }
  return nearest;
}

/* Chooses the material point that a pull holds, and a damping that prevents oscillation. */
static void grasp(SporeWorld *world, size_t index, const SporeBody *body, SporeVec3 point, double stiffness) {
  SporeSpringTerm *term = &world->links.springs[index];
  const double *q = world->state.q + body->q_offset;
  double mass;
  if (!spore_model_is_rigid(body->model)) {
    term->a.point = (uint32_t)nearest_block(q, body->model->node_count - body->model->spare_count, point);
    mass = body->model->block_mass[term->a.point];
  } else {
    SporeVec3 arm = spore_vec3_sub(point, spore_vec3_load(q));
    SporeVec3 in_body = spore_quat_rotate(spore_quat_conjugate(spore_quat_load(q + 3)), arm);
    spore_vec3_store(world->links.mappings[2 * index].points, in_body);
    mass = spore_model_total_mass(body->model);
  }
  term->law.damping = 2 * sqrt(stiffness * mass);
}

static void set_pulled(SporeWorld *world, size_t index, bool pulled) {
  if (world->links.active[index] == pulled) return;
  world->links.active[index] = pulled;
  world->bodies[world->links.springs[index].a.body].collision.pulled = pulled;
  if (pulled) world->links.pull_count++;
  else world->links.pull_count--;
  world->schedule.stale = true; /* the link stage may be needed now, or no longer */
}

void spore_world_pull(SporeWorld *world, const SporeCommand *command) {
  const SporeBody *body = &world->bodies[command->body];
  bool good = spore_vec3_is_finite(command->point) && spore_vec3_is_finite(command->vector) && command->number >= 0 &&
              isfinite(command->number);
  if (!good || !spore_body_is_physical(body)) return;
  size_t index = spore_world_pull_index(world, command->body);
  SporeSpringTerm *term = &world->links.springs[index];
  if (!world->links.active[index]) grasp(world, index, body, command->point, command->number);
  term->law.stiffness = command->number;
  spore_vec3_store(world->links.mappings[2 * index + 1].points, command->vector);
  set_pulled(world, index, true);
}

void spore_world_release(SporeWorld *world, uint32_t body) {
  set_pulled(world, spore_world_pull_index(world, body), false);
}

bool spore_world_pulled_point(const SporeWorld *world, uint32_t index, SporeVec3 *point) {
  const SporeSpringTerm *term = &world->links.springs[spore_world_pull_index(world, index)];
  if (!world->links.active[spore_world_pull_index(world, index)]) return false;
  *point = spore_mapping_position(term->a.mapping, term->a.point, world->state.q + world->bodies[index].q_offset);
  return true;
}

void spore_world_pull_by(SporeWorld *world, uint32_t index, SporeVec3 point) {
  size_t pull = spore_world_pull_index(world, index);
  grasp(world, pull, &world->bodies[index], point, world->links.springs[pull].law.stiffness);
}
