/* Samples: the material points by which levels are fitted to each other. Those of each level determine its
 * configuration. Those of the spheres and of the surface only measure the error. */
#include <assert.h>
#include <float.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/sim/world_private.h"

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a body's levels"));
}

/* Nodes in the body's frame at rest, without the origin of a frame. */
static bool take_nodes(const SporeModel *model, double **points, size_t *count, size_t *seen) {
  double *q = SPORE_NEW_ARRAY(double, model->q_count), *v = SPORE_NEW_ARRAY(double, 3 * model->block_count);
  *count = model->node_count - !spore_model_is_nodal(model);
  *points = q;
  *seen = *count;
  if (q && v) model->type->place(model, spore_pose_identity(), spore_vec3(0, 0, 0), spore_vec3(0, 0, 0), q, v);
  spore_free(v);
  return q && v;
}

static bool append(double **all, size_t *count, const double *points, size_t more) {
  assert(more == 0 || points);
  double *longer = spore_reallocate(*all, 3 * *count, 3 * (*count + more), sizeof *longer);
  if (!longer) return false;
  if (more) memcpy(longer + 3 * *count, points, 3 * more * sizeof *longer);
  *all = longer;
  *count += more;
  return true;
}

/* Collects the samples of each level's own. */
static bool collect_own(SporeLod *levels, double **all) {
  for (int k = 0; k < SPORE_LOD_COUNT; k++) {
    SporeLodLevel *level = &levels->level[k];
    double *points = NULL;
    if (!level->model) continue;
    bool (*take)(const SporeModel *, double **, size_t *, size_t *) =
        level->model->type->samples ? level->model->type->samples : take_nodes;
    level->sample_start = levels->sample_count;
    bool taken = take(level->model, &points, &level->sample_count, &level->seen_count);
    taken = taken && append(all, &levels->sample_count, points, level->sample_count);
    spore_free(points);
    if (!taken) return false;
  }
  return true;
}

/* The samples of each level have the same weight together. */
static bool weigh(SporeLod *levels) {
  levels->sample_weight = SPORE_NEW_ARRAY(double, levels->sample_count);
  if (!levels->sample_weight) return false;
  for (int k = 0; k < SPORE_LOD_COUNT; k++) {
    const SporeLodLevel *level = &levels->level[k];
    for (size_t s = 0; level->model && s < level->sample_count; s++)
      levels->sample_weight[level->sample_start + s] = 1 / (double)level->sample_count;
  }
  return true;
}

static bool collect(SporeLod *levels, const SporeBodyDescription *from, double **all) {
  if (!collect_own(levels, all)) return false;
  const SporeSphereSet *spheres = from->spheres;
  for (size_t s = 0; spheres && s < spheres->count; s++)
    if (!append(all, &levels->sample_count, spheres->spheres + 4 * s, 1)) return false;
  return append(all, &levels->sample_count, from->lod.surface, from->lod.surface_count) && weigh(levels);
}

static size_t next_to(const double *points, size_t count, const double *at) {
  assert(count > 0);
  size_t nearest = 0;
  double best = DBL_MAX;
  for (size_t s = 0; s < count; s++) {
    double distance = spore_vec3_distance(spore_vec3_load(points + 3 * s), spore_vec3_load(at));
    if (distance < best) best = distance, nearest = s;
  }
  return nearest;
}

/* A node that is itself a sample is its own nearest; other nodes search the samples of their level. */
static bool find_nearest(SporeLodLevel *level, const double *all) {
  assert(level->model && all);
  double *nodes = NULL;
  size_t count = 0, seen;
  bool good = take_nodes(level->model, &nodes, &count, &seen);
  level->nearest = SPORE_NEW_ARRAY(uint32_t, count);
  good = good && level->nearest;
  for (size_t i = 0; good && i < count; i++) {
    size_t own =
        level->model->type->samples ? next_to(all + 3 * level->sample_start, level->sample_count, nodes + 3 * i) : i;
    level->nearest[i] = (uint32_t)(level->sample_start + own);
  }
  spore_free(nodes);
  return good;
}

static bool find_diagonal(const SporeLod *levels, SporeLodLevel *level) {
  assert(level->samples.kind == SPORE_MAPPING_LINEAR && level->samples.point_count == levels->sample_count);
  const SporeMapping *samples = &level->samples;
  level->diagonal = SPORE_NEW_ARRAY(double, level->model->block_count);
  if (!level->diagonal) return false;
  for (size_t s = 0; s < levels->sample_count; s++)
    for (uint32_t k = samples->row_start[s]; k < samples->row_start[s + 1]; k++)
      level->diagonal[samples->block[k]] += levels->sample_weight[s] * samples->weight[k] * samples->weight[k];
  return true;
}

static bool map_level(SporeWorld *world, uint32_t index, int k, const double *all, SporeError *error) {
  assert(k >= 0 && k < SPORE_LOD_COUNT);
  const SporeBody *body = &world->bodies[index];
  SporeLodLevel *level = &body->lod->level[k];
  SporeError reason = SPORE_ERROR_INIT;
  bool mapped = spore_body_map(world, index, (SporeLodGrade)k, all, body->lod->sample_count, world->cancel,
                               &level->samples, &reason);
  if (mapped && level->samples.kind == SPORE_MAPPING_LINEAR)
    return (find_nearest(level, all) && find_diagonal(body->lod, level)) || no_memory(error);
  if (reason.code == SPORE_ERROR_MEMORY) return no_memory(error);
  if (reason.code == SPORE_ERROR_CANCELLED) return spore_error_set(error, reason.code, NULL, "%s", reason.message);
  char place[200];
  snprintf(place, sizeof place, "bodies/%s", body->name);
  return spore_error_set(error, SPORE_ERROR_INPUT, place,
                         _("level %s does not lie where the others do: %s; give it a geometry that follows theirs, or "
                           "a larger level_tolerance"),
                         spore_lod_names[k], mapped ? _("its points follow no nodes") : reason.message);
}

static bool allocate(SporeLod *levels) {
  size_t samples = 3 * levels->sample_count;
  levels->before = SPORE_NEW_ARRAY(double, samples);
  levels->speed = SPORE_NEW_ARRAY(double, samples);
  levels->after = SPORE_NEW_ARRAY(double, samples);
  levels->q = SPORE_NEW_ARRAY(double, levels->q_room);
  levels->v = SPORE_NEW_ARRAY(double, levels->v_room);
  levels->work = SPORE_NEW_ARRAY(double, SPORE_LOD_VECTORS * levels->v_room);
  return levels->before && levels->speed && levels->after && levels->q && levels->v && levels->work;
}

bool spore_lod_sample(SporeWorld *world, const SporeBodyDescription *from, uint32_t index, SporeError *error) {
  assert(index < world->body_count);
  SporeLod *levels = world->bodies[index].lod;
  assert(levels && levels->level[SPORE_LOD_FINE].model);
  double *all = NULL;
  bool good = (collect(levels, from, &all) && allocate(levels)) || no_memory(error);
  for (int k = 0; good && k < SPORE_LOD_COUNT; k++)
    if (levels->level[k].model) good = map_level(world, index, k, all, error);
  spore_free(all);
  return good;
}
