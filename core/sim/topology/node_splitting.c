/* Node splitting: tetrahedra come apart at cuts.
 *
 * Scissors mark the cuts when a step begins. Nodes are split at its end, when the next state is known. The copy of a
 * node is a spare node, which was held until then, and takes the state of its original. The matrix gets the new pattern
 * of the model. Spheres and links follow the tetrahedra that they are mapped to.
 *
 * All arrays have room from the start, so that a step allocates nothing. Only the factor needs new memory, since its
 * fill changes. A split body is solved by conjugate gradients until its factor is made anew between two steps. */
#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/constraint/pin.h"
#include "core/sim/world_private.h"

static bool has_scissors(const SporeWorldDescription *description) {
  for (size_t i = 0; i < description->tool_count; i++)
    if (description->tools[i].type->cuts) return true;
  return false;
}

/* A body with levels of detail is not split: its other levels would not have the cut. */
static bool has_levels(const SporeBodyDescription *body) {
  for (size_t i = 0; i < SPORE_LOD_FINE; i++)
    if (body->lod.model[i]) return true;
  return false;
}

bool spore_world_reserve_nodes(const SporeWorldDescription *description, SporeError *error) {
  if (!has_scissors(description)) return true;
  for (size_t b = 0; b < description->body_count; b++) {
    SporeModel *model = description->bodies[b].model;
    if (!model || !model->type->cut || !model->type->cut->reserve || has_levels(&description->bodies[b]) ||
        model->type->cut->reserve(model, error))
      continue;
    char place[200];
    snprintf(place, sizeof place, "bodies/%s", description->bodies[b].name);
    spore_error_at(error, place);
    return false;
  }
  return true;
}

/* Setting up. */

static size_t nodes_in_use(const SporeBody *body) {
  assert(body->model->spare_count <= body->model->node_count);
  return body->model->node_count - body->model->spare_count;
}

static bool hold_spares(SporeWorld *world, SporeBody *body) {
  assert(!body->changing.pinned);
  SporeChangingMatrix *changing = &body->changing;
  changing->pinned = SPORE_NEW_ARRAY(uint8_t, body->block_count);
  uint32_t *held = spore_reallocate(body->held.blocks, body->held.count, body->block_count, sizeof *held);
  if (held) body->held.blocks = held;
  if (!held || !changing->pinned) return false;
  for (size_t i = 0; i < body->held.count; i++) changing->pinned[body->held.blocks[i]] = 1;
  spore_body_list_held(body);
  spore_pin_filter(body->held.blocks, body->held.count, world->state.rest_v + body->v_offset);
  world->state.dof -= 3 * body->model->spare_count;
  return true;
}

/* Makes the matrix anew, with room for patterns to come. */
static bool make_roomy(SporeBody *body) {
  SporeChangingMatrix *changing = &body->changing;
  spore_block_matrix_clear(&body->preconditioner.matrix);
  spore_block_pattern_init(&changing->pattern, body->block_count);
  return body->model->type->pattern(body->model, &changing->pattern) &&
         spore_block_matrix_create_roomy(&body->preconditioner.matrix, &changing->pattern, body->block_count,
                                         changing->pattern.pair_count, &changing->room);
}

static bool attach_mapping(SporeWorld *world, uint32_t index, SporeMapping *mapping) {
  assert(index < world->body_count);
  assert(world->topology.attached_count < world->body_count + 2 * world->links.term_count);
  if (mapping->kind != SPORE_MAPPING_LINEAR) return true;
  const SporeModel *model = world->bodies[index].model;
  SporeAttachedMapping *attached = &world->topology.attached[world->topology.attached_count++];
  size_t count;
  const uint32_t *corners = model->type->cut->corners(model, &count);
  *attached = (SporeAttachedMapping){.body = index, .mapping = mapping};
  return spore_mapping_find_places(mapping, corners, count, model->node_count, &attached->places);
}

static bool attach_links(SporeWorld *world, uint32_t index) {
  for (size_t i = 0; i < world->links.term_count; i++) {
    const SporeSpringTerm *term = &world->links.springs[i];
    if (term->a.body == index && !attach_mapping(world, index, &world->links.mappings[2 * i])) return false;
    if (term->b.body == index && !attach_mapping(world, index, &world->links.mappings[2 * i + 1])) return false;
  }
  return true;
}

static bool prepare(SporeWorld *world, uint32_t index) {
  SporeBody *body = &world->bodies[index];
  body->splitting.possible = true;
  return hold_spares(world, body) && make_roomy(body) && attach_mapping(world, index, &body->collision.spheres) &&
         attach_links(world, index);
}

static void copy_corners(SporeWorld *world, const SporeBody *body) {
  size_t count;
  const uint32_t *corners = body->model->type->cut->corners(body->model, &count);
  assert(body->splitting.corner_start + count <= world->topology.cuts.corner_count);
  memcpy(world->topology.cuts.corners + 4 * body->splitting.corner_start, corners, 4 * count * sizeof *corners);
}

static bool can_be_split(const SporeBody *body, size_t *count) {
  return body->role == SPORE_PASSIVE && body->model->type->cut && body->model->type->cut->corners &&
         body->model->type->cut->corners(body->model, count);
}

bool spore_world_create_splitting(SporeWorld *world) {
  size_t count, total = 0;
  for (size_t b = 0; b < world->body_count; b++) {
    if (!can_be_split(&world->bodies[b], &count)) continue;
    world->bodies[b].splitting.corner_start = total;
    total += count;
  }
  if (total == 0) return true;
  world->topology.cuts.corner_count = total;
  world->topology.cuts.corners = SPORE_NEW_ARRAY(uint32_t, 4 * total);
  world->topology.attached = SPORE_NEW_ARRAY(SporeAttachedMapping, world->body_count + 2 * world->links.term_count);
  bool made = world->topology.cuts.corners && world->topology.attached;
  for (uint32_t b = 0; made && b < world->body_count; b++) {
    if (!can_be_split(&world->bodies[b], &count)) continue;
    made = prepare(world, b);
    if (made) copy_corners(world, &world->bodies[b]);
  }
  world->topology.cuts.parted = 1;
  return made;
}

void spore_world_clear_topology(SporeWorld *world) {
  SporeTopology *topology = &world->topology;
  for (size_t i = 0; i < topology->attached_count; i++) spore_free(topology->attached[i].places);
  spore_free(topology->attached);
  spore_free(topology->cuts.edges);
  spore_free(topology->cuts.corners);
  spore_free(topology->lines.breaks);
  spore_free(topology->lines.span_count);
}

/* Splitting. */

/* Mapped points follow their tetrahedra, and the matrix gets the present pattern. */
static void follow(SporeWorld *world, uint32_t index) {
  assert(world->bodies[index].splitting.possible);
  SporeBody *body = &world->bodies[index];
  size_t count;
  const uint32_t *corners = body->model->type->cut->corners(body->model, &count);
  for (size_t i = 0; i < world->topology.attached_count; i++)
    if (world->topology.attached[i].body == index)
      spore_mapping_follow(world->topology.attached[i].mapping, world->topology.attached[i].places, corners);
  spore_body_lay_out_matrix(body);
  copy_corners(world, body);
  world->topology.cuts.parted++;
}

/* Drops the factor: its fill may be much larger now. */
static void drop_factor(SporeBody *body) {
  body->preconditioner.factor.block_count = body->preconditioner.factor.band.block_count = 0;
}

/* Splits nodes. A pin that holds a node holds its copies too. */
static void split_body(SporeWorld *world, uint32_t index) {
  assert(world->bodies[index].splitting.possible);
  SporeBody *body = &world->bodies[index];
  size_t before = nodes_in_use(body);
  const uint32_t *from;
  size_t made = body->model->type->cut->split(body->model, world->state.next_q + body->q_offset,
                                              world->state.next_v + body->v_offset, &from);
  if (made == 0) return;
  assert(before + made <= body->model->node_count);
  for (size_t i = 0; i < made; i++) body->changing.pinned[before + i] = body->changing.pinned[from[i]];
  spore_body_list_held(body);
  follow(world, index);
  drop_factor(body);
  body->splitting.split = body->changing.factor_is_old = true;
  body->changing.step = world->state.step;
  spore_body_set_mass(world, body);
  spore_body_changed_model(world, index);
}

void spore_world_split_nodes(SporeWorld *world) {
  if (world->topology.cuts.corner_count == 0) return;
  for (uint32_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (!body->splitting.wanted || body->frozen || body->sleep.asleep) continue;
    body->splitting.wanted = false;
    split_body(world, b);
  }
}

void spore_world_reset_splitting(SporeWorld *world) {
  for (uint32_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    body->splitting.wanted = false;
    if (!body->splitting.split) continue;
    size_t used = nodes_in_use(body);
    memset(body->changing.pinned + used, 0, body->block_count - used);
    spore_body_list_held(body);
    follow(world, b);
    spore_body_create_factor(world, body, NULL); /* without memory for it, by conjugate gradients */
    body->splitting.split = body->changing.factor_is_old = false;
  }
}
