/* Where a snapshot has the vertices of visual meshes. */
#include <assert.h>

#include "core/base/text.h"
#include "core/runtime/runtime_private.h"

const SporeRuntimeVisual *spore_runtime_visual(const SporeRuntime *runtime, size_t i) {
  assert(i < runtime->scene.visual_count);
  return &runtime->scene.visuals[i];
}

/* The mapping at a level of detail, adapted to the knots that the body's line has in the snapshot. */
static const SporeMapping *mapping_at(SporeRuntime *runtime, size_t i, SporeLodGrade level,
                                      const SporeSnapshot *snapshot, SporeError *error) {
  const SporeRuntimeVisual *visual = &runtime->scene.visuals[i];
  SporeRuntimeMap *map = &runtime->maps[SPORE_LOD_COUNT * i + level];
  bool first = !map->made;
  if (first && !spore_world_map_drawn(runtime->world, visual->body, level, visual->mesh, &map->mapping, error))
    return NULL;
  map->made = true;
  if (!first && map->knots == snapshot->lines.number) return &map->mapping;
  const SporeSplineKnots knots = spore_snapshot_knots(runtime->world, snapshot, visual->body);
  if (!spore_world_follow_knots(runtime->world, visual->body, knots, &map->mapping)) {
    spore_error_set(error, SPORE_ERROR_MEMORY, spore_world_body_name(runtime->world, visual->body),
                    _("not enough memory for its drawn vertices"));
    return NULL;
  }
  map->knots = snapshot->lines.number;
  return &map->mapping;
}

bool spore_runtime_vertices(SporeRuntime *runtime, size_t i, const SporeSnapshot *snapshot, double *vertices,
                            SporeError *error) {
  const SporeRuntimeVisual *visual = spore_runtime_visual(runtime, i);
  const SporeLodGrade level = snapshot->level ? (SporeLodGrade)snapshot->level[visual->body]
                                              : spore_world_first_lod(runtime->world, visual->body);
  const SporeMapping *mapping = mapping_at(runtime, i, level, snapshot, error);
  if (!mapping) return false;
  spore_mapping_positions(mapping, snapshot->q + spore_world_q_offset(runtime->world, visual->body), vertices);
  spore_squeeze_points(snapshot->squeezes, snapshot->squeeze_count, visual->body, vertices, visual->mesh->vertex_count);
  return true;
}
