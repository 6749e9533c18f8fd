/* A place of a body that is followed while the world runs. */
#include "core/measure/watch.h"

#include <assert.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"

/* Tetrahedra whose nodes a cut may split, now; NULL: the model has none. */
static const uint32_t *corners_of(const SporeModel *model, size_t *count) {
  const SporeModelCut *cut = model ? model->type->cut : NULL;
  return cut && cut->corners ? cut->corners(model, count) : NULL;
}

/* Of a thread whose control points come and go: what lies beside its line would jump with them, so that the line itself
 * is followed, from the place nearest to the point. */
static bool keep_to_line(const SporeModel *model, SporeMapping *mapping) {
  if (!mapping->anchors) return true;
  for (int k = 1; k < 4; k++) mapping->anchors[k] = 0;
  return model->type->line->follow(model, model->type->line->path(model), mapping);
}

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory to watch a point"));
}

static bool map_level(SporeWatch *watch, const SporeWorld *world, SporeLodGrade level, const double point[3],
                      SporeError *error) {
  const SporeModel *model = spore_world_lod_model(world, watch->body, level);
  size_t count = 0;
  if (!model && !(level == SPORE_LOD_FINE && spore_world_body_role(world, watch->body) != SPORE_PASSIVE)) return true;
  if (!spore_world_map_lod(world, watch->body, level, point, 1, &watch->mapping[level], error)) return false;
  if (!keep_to_line(model, &watch->mapping[level])) return no_memory(error);
  const uint32_t *corners = corners_of(model, &count);
  return !corners ||
         spore_mapping_find_places(&watch->mapping[level], corners, count, model->node_count, &watch->places[level]) ||
         no_memory(error);
}

bool spore_watch_init(SporeWatch *watch, const SporeWorld *world, uint32_t body, SporeVec3 at, SporeError *error) {
  assert(spore_world_step_count(world) == 0);
  *watch = (SporeWatch){.body = body};
  double point[3];
  spore_vec3_store(point, spore_pose_apply_inverse(spore_world_start_pose(world, body), at));
  for (int level = 0; level < SPORE_LOD_COUNT; level++)
    if (!map_level(watch, world, (SporeLodGrade)level, point, error)) {
      spore_watch_clear(watch);
      return false;
    }
  return true;
}

void spore_watch_clear(SporeWatch *watch) {
  for (int level = 0; level < SPORE_LOD_COUNT; level++) {
    if (watch->mapping[level].point_count > 0) spore_mapping_clear(&watch->mapping[level]);
    spore_free(watch->places[level]);
  }
  *watch = (SporeWatch){0};
}

/* Nodes may have been split, and control points of a line may have come and gone. */
static void follow_changes(SporeWatch *watch, const SporeWorld *world, SporeLodGrade level) {
  const SporeModel *model = spore_world_body_model(world, watch->body);
  SporeMapping *mapping = &watch->mapping[level];
  SporeLineState line;
  size_t count;
  if (watch->places[level]) spore_mapping_follow(mapping, watch->places[level], corners_of(model, &count));
  if (spore_world_line_state(world, watch->body, &line))
    spore_world_follow_knots(world, watch->body, model->type->line->path(model), mapping);
}

void spore_watch_measure(SporeWatch *watch, const SporeWorld *world, double *position, double *velocity) {
  SporeLodState state = {.level = SPORE_LOD_FINE};
  spore_world_lod_state(world, watch->body, &state);
  follow_changes(watch, world, state.level);
  const SporeMapping *mapping = &watch->mapping[state.level];
  const double *q = spore_world_q(world, watch->body), *v = spore_world_v(world, watch->body);
  const SporeModel *model = spore_world_body_model(world, watch->body);
  spore_vec3_store(position, spore_mapping_position(mapping, 0, q));
  spore_vec3_store(velocity, spore_mapping_velocity(mapping, 0, q, v));
  if (model && model->type->particles && spore_particle_is_out(position))
    for (int k = 0; k < 3; k++) position[k] = velocity[k] = NAN;
}
