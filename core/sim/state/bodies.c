/* Bodies: their models at all levels of detail, and mappings of points that are given at rest. */
#include <assert.h>

#include "core/sim/world_private.h"

const char *const spore_lod_names[] = {"coarse", "medium", "fine", NULL};

void spore_body_each_model(const SporeBody *body, void (*call)(SporeModel *model, void *user), void *user) {
  assert(call);
  if (!body->lod && body->model) call(body->model, user);
  for (int k = 0; body->lod && k < SPORE_LOD_COUNT; k++)
    if (body->lod->level[k].model) call(body->lod->level[k].model, user);
}

const SporeModel *spore_world_lod_model(const SporeWorld *world, uint32_t index, SporeLodGrade level) {
  assert(index < world->body_count);
  assert((unsigned)level < SPORE_LOD_COUNT);
  const SporeBody *body = &world->bodies[index];
  if (body->lod) return body->lod->level[level].model;
  return level == SPORE_LOD_FINE ? body->model : NULL;
}

/* Points of an unmovable body are fixed where its pose puts them. */
static bool map_fixed(const SporeBody *body, const double *points, size_t count, SporeMapping *mapping,
                      SporeError *error) {
  assert(body->role == SPORE_UNMOVABLE);
  if (!spore_mapping_init_points(mapping, SPORE_MAPPING_FIXED, points, count, error)) return false;
  for (size_t i = 0; i < count; i++)
    spore_vec3_store(mapping->points + 3 * i, spore_pose_apply(body->rest_pose, spore_vec3_load(points + 3 * i)));
  return true;
}

bool spore_body_map(const SporeWorld *world, uint32_t index, SporeLodGrade level, const double *points, size_t count,
                    const SporeCancel *cancel, SporeMapping *mapping, SporeError *error) {
  assert(count == 0 || points);
  const SporeBody *body = &world->bodies[index];
  const SporeModel *model = spore_world_lod_model(world, index, level);
  assert(body->role != SPORE_PASSIVE || model);
  if (body->role == SPORE_UNMOVABLE) return map_fixed(body, points, count, mapping, error);
  if (body->role == SPORE_ACTIVE) return spore_mapping_init_points(mapping, SPORE_MAPPING_RIGID, points, count, error);
  return model->type->map(model, points, count, cancel, mapping, error);
}

bool spore_world_map_lod(const SporeWorld *world, uint32_t body, SporeLodGrade level, const double *points,
                         size_t count, SporeMapping *mapping, SporeError *error) {
  return spore_body_map(world, body, level, points, count, NULL, mapping, error);
}

bool spore_world_map_drawn(const SporeWorld *world, uint32_t body, SporeLodGrade level, const SporeTriangleMesh *mesh,
                           SporeMapping *mapping, SporeError *error) {
  assert(mesh);
  const SporeModel *model = spore_world_lod_model(world, body, level);
  if (world->bodies[body].role == SPORE_PASSIVE && model->type->line && model->type->line->map_drawn)
    return model->type->line->map_drawn(model, mesh, mapping, error);
  return spore_world_map_lod(world, body, level, mesh->vertices, mesh->vertex_count, mapping, error);
}

bool spore_world_map(const SporeWorld *world, uint32_t body, const double *points, size_t count, SporeMapping *mapping,
                     SporeError *error) {
  assert(body < world->body_count);
  return spore_world_map_lod(world, body, world->bodies[body].grade, points, count, mapping, error);
}

SporeVec3 spore_world_to_frame(const SporeWorld *world, uint32_t body, SporeVec3 at) {
  assert(body < world->body_count);
  return spore_pose_apply_inverse(world->bodies[body].rest_pose, at);
}

bool spore_world_attach(SporeWorld *world, uint32_t body, SporeVec3 at, SporeMapping *mapping, SporeEnd *end,
                        SporeError *error) {
  assert(body == SPORE_NO_BODY || body < world->body_count);
  assert(mapping && end);
  double point[3];
  *end = (SporeEnd){.mapping = mapping, .body = body};
  spore_vec3_store(point, body == SPORE_NO_BODY ? at : spore_world_to_frame(world, body, at));
  if (body == SPORE_NO_BODY) return spore_mapping_init_points(mapping, SPORE_MAPPING_FIXED, point, 1, error);
  return spore_world_map(world, body, point, 1, mapping, error);
}

size_t spore_world_dof(const SporeWorld *world) {
  size_t dof = world->state.dof;
  for (size_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    if (body->effect.on) dof -= 3 * (body->block_count - body->held.pin_count - body->model->spare_count);
  }
  return dof;
}
