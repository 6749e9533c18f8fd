/* Cutting and tearing: bodies lose ties between their nodes, and their spheres follow. A sphere whose nodes come apart
 * stays with the connected nodes that have the largest weight. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/sim/world_private.h"

#define ROW_MAXIMUM 8 /* nodes that a sphere of such a body follows; a sphere with more stays as it is */

typedef struct Preparation {
  size_t *edges;
  bool made;
} Preparation;

static void prepare_model(SporeModel *model, void *user) {
  assert(model->type->cut && model->type->cut->prepare);
  Preparation *preparation = user;
  preparation->made = preparation->made && model->type->cut->prepare(model, preparation->edges);
}

static bool prepare_body(SporeWorld *world, SporeBody *body) {
  assert(body->model && !body->collision.whole_weight);
  Preparation preparation = {&world->topology.cuts.capacity, true};
  spore_body_each_model(body, prepare_model, &preparation);
  if (!preparation.made) return false;
  if (body->collision.spheres.kind != SPORE_MAPPING_LINEAR) return true;
  size_t count = body->collision.spheres.row_start[body->collision.spheres.point_count];
  body->collision.whole_weight = SPORE_NEW_ARRAY(double, count);
  if (body->collision.whole_weight)
    memcpy(body->collision.whole_weight, body->collision.spheres.weight, count * sizeof(double));
  return body->collision.whole_weight != NULL;
}

bool spore_world_create_cutting(SporeWorld *world) {
  bool cuts = false, made = true;
  for (size_t i = 0; i < world->tools.count; i++) cuts |= world->tools.all[i]->type->cuts;
  for (size_t b = 0; made && b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (!spore_body_can_be_cut(body) || !body->model->type->cut->prepare || !(cuts || body->model->tears)) continue;
    world->topology.tearing_count += body->model->tears;
    made = prepare_body(world, body);
  }
  world->topology.cuts.edges = SPORE_NEW_ARRAY(SporeCutEdge, world->topology.cuts.capacity);
  return made && world->topology.cuts.edges;
}

static void mend(SporeModel *model, void *user) {
  if (model->type->mend) model->type->mend(model);
}

void spore_world_reset_cutting(SporeWorld *world) {
  assert(world->topology.cuts.count <= world->topology.cuts.capacity);
  world->topology.cuts.count = 0;
  world->topology.cut_run++;
  for (size_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    body->reported.torn = false;
    spore_body_each_model(body, mend, NULL);
    if (!body->collision.whole_weight) continue;
    memcpy(body->collision.spheres.weight, body->collision.whole_weight,
           body->collision.spheres.row_start[body->collision.spheres.point_count] * sizeof(double));
  }
}

/* Numbers the connected components of the nodes of a row, from 1. 0: the node never had a tie to another of them. */
static void find_components(const SporeModel *model, const uint32_t *block, size_t count,
                            size_t component[ROW_MAXIMUM]) {
  assert(count <= ROW_MAXIMUM);
  for (size_t i = 0; i < count; i++) component[i] = 0;
  for (size_t i = 0; i < count; i++)
    for (size_t j = 0; j < count; j++)
      if (i != j && component[i] == 0 && model->type->cut->tie(model, block[i], block[j]) != SPORE_TIE_NONE)
        component[i] = i + 1;
  for (size_t i = 0; i < count; i++)
    for (size_t j = 0; j < i; j++) {
      if (component[i] == component[j] || model->type->cut->tie(model, block[i], block[j]) != SPORE_TIE_HOLDS) continue;
      size_t from = component[i], to = component[j];
      for (size_t k = 0; k < count; k++)
        if (component[k] == from) component[k] = to;
    }
}

/* Leaves the sphere to the nodes of one component. Nodes of no component keep their weight. */
static void keep_one_component(const SporeModel *model, const SporeMapping *spheres, size_t point) {
  assert(spheres->kind == SPORE_MAPPING_LINEAR && point < spheres->point_count);
  uint32_t start = spheres->row_start[point];
  size_t count = spheres->row_start[point + 1] - start, component[ROW_MAXIMUM], most = 0;
  double *weight = spheres->weight + start, sum[ROW_MAXIMUM + 1] = {0}, tied = 0;
  if (count > ROW_MAXIMUM) return;
  find_components(model, spheres->block + start, count, component);
  for (size_t i = 0; i < count; i++) sum[component[i]] += weight[i];
  for (size_t i = 0; i < count; i++) tied += component[i] > 0 ? weight[i] : 0;
  for (size_t i = 1; i <= count; i++)
    if (sum[i] / tied > sum[most] / tied || most == 0) most = i;
  if (count == 0 || fabs(sum[most] - tied) < 1e-12) return;
  for (size_t i = 0; i < count; i++)
    if (component[i] > 0) weight[i] = component[i] == most ? weight[i] * tied / sum[most] : 0;
}

/* What the body remembers of earlier steps belongs to the uncut body, so it is dropped. */
void spore_body_changed_model(SporeWorld *world, uint32_t index) {
  assert(index < world->body_count);
  SporeBody *body = &world->bodies[index];
  spore_world_wake(world, index);
  body->altered = true;
  spore_body_forget_steps(world, body);
}

void spore_body_was_cut(SporeWorld *world, uint32_t index) {
  assert(index < world->body_count);
  SporeBody *body = &world->bodies[index];
  if (body->splitting.possible) { /* split later in the step: see node_splitting.c */
    body->splitting.wanted = true;
    spore_world_wake(world, index);
    return;
  }
  spore_body_changed_model(world, index);
  for (size_t i = 0; body->collision.whole_weight && i < body->collision.spheres.point_count; i++)
    keep_one_component(body->model, &body->collision.spheres, i);
}

static void report_tear(SporeWorld *world, SporeBody *body, size_t edge) {
  assert(world->topology.cuts.count <= world->topology.cuts.capacity);
  if (body->reported.torn || edge == world->topology.cuts.count) return;
  const double *q = world->state.q + body->q_offset;
  const SporeCutEdge *cut = &world->topology.cuts.edges[edge];
  body->reported.torn = true;
  SporeVec3 at = spore_vec3_scale(
      0.5, spore_vec3_add(spore_vec3_load(q + 3 * (size_t)cut->a), spore_vec3_load(q + 3 * (size_t)cut->b)));
  spore_world_report(world, _("%s: begins to tear at %.4g, %.4g, %.4g m"), body->name, at.x, at.y, at.z);
}

void spore_world_tear(SporeWorld *world) {
  for (uint32_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (!spore_body_can_be_cut(body) || !body->model->tears || !spore_body_moves(body)) continue;
    size_t edge = world->topology.cuts.count;
    size_t count = body->model->type->cut->tear(body->model, world->state.q + body->q_offset, b, &world->topology.cuts);
    if (count == 0) continue;
    world->state.monitor.torn_springs += count;
    report_tear(world, body, edge);
    spore_body_was_cut(world, b);
  }
}
