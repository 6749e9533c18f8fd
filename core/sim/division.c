/* Tetrahedra that are divided by cuts. Scissors say where while a step begins; at its end, when the next state is
 * known, nodes are divided: their copies, held out of the way until then, take the state of those that they are of, the
 * matrix gets the pattern that the model has now, and spheres and links go with the tetrahedra that they hang on.
 *
 * All of that lies in room made before, so that a step allocates nothing. A factor is another matter: its fill differs.
 * A parted body does without, by conjugate gradients, until that is analysed between two steps. */
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/constraint/pin.h"
#include "core/sim/world_private.h"

static bool has_scissors(const SporeWorldDescription *description) {
  for (size_t i = 0; i < description->tool_count; i++)
    if (description->tools[i].kind == SPORE_TOOL_SCISSORS) return true;
  return false;
}

/* Blades pass through what changes its level: a finer or coarser one would not know of the cut. */
static bool has_levels(const SporeBodyDescription *body) {
  for (size_t i = 0; i < SPORE_LEVEL_FINE; i++)
    if (body->levels.model[i]) return true;
  return false;
}

bool spore_world_reserve_division(const SporeWorldDescription *description, SporeError *error) {
  if (!has_scissors(description)) return true;
  for (size_t b = 0; b < description->body_count; b++) {
    SporeModel *model = description->bodies[b].model;
    if (!model || !model->type->reserve || has_levels(&description->bodies[b]) || model->type->reserve(model, error))
      continue;
    char place[200];
    snprintf(place, sizeof place, "bodies/%s", description->bodies[b].name);
    spore_error_at(error, place);
    return false;
  }
  return true;
}

/* Setting up. */

static size_t nodes_in_use(const SporeBody *body) { return body->model->node_count - body->model->spare_count; }

void spore_body_list_held(SporeBody *body) {
  body->held_count = 0;
  for (size_t i = 0; i < nodes_in_use(body); i++)
    if (body->division.pinned[i]) body->held[body->held_count++] = (uint32_t)i;
  body->pin_count = body->held_count;
  for (size_t i = nodes_in_use(body); i < body->block_count; i++) body->held[body->held_count++] = (uint32_t)i;
  for (size_t i = 0; body->held_flags && i < body->block_count; i++)
    body->held_flags[i] = i >= nodes_in_use(body) || body->division.pinned[i];
}

static bool hold_spares(SporeWorld *world, SporeBody *body) {
  SporeDivision *division = &body->division;
  division->pinned = SPORE_NEW_ARRAY(uint8_t, body->block_count);
  uint32_t *held = spore_reallocate(body->held, body->held_count, body->block_count, sizeof *held);
  if (held) body->held = held;
  if (!held || !division->pinned) return false;
  for (size_t i = 0; i < body->held_count; i++) division->pinned[body->held[i]] = 1;
  spore_body_list_held(body);
  spore_pin_filter(body->held, body->held_count, world->rest_v + body->v_offset);
  world->dof -= 3 * body->model->spare_count;
  return true;
}

/* The matrix again, with room. */
static bool make_roomy(SporeBody *body) {
  SporeDivision *division = &body->division;
  spore_block_matrix_clear(&body->matrix);
  spore_block_pattern_init(&division->pattern, body->block_count);
  return body->model->type->pattern(body->model, &division->pattern) &&
         spore_block_matrix_create_roomy(&body->matrix, &division->pattern, body->block_count,
                                         division->pattern.pair_count, &division->room);
}

static bool add_hang(SporeWorld *world, uint32_t index, SporeMapping *mapping) {
  if (mapping->kind != SPORE_MAPPING_LINEAR) return true;
  const SporeModel *model = world->bodies[index].model;
  SporeHang *hang = &world->hangs[world->hang_count++];
  size_t count;
  const uint32_t *corners = model->type->corners(model, &count);
  *hang = (SporeHang){.body = index, .mapping = mapping};
  return spore_mapping_find_places(mapping, corners, count, model->node_count, &hang->places);
}

static bool hang_links(SporeWorld *world, uint32_t index) {
  for (size_t i = 0; i < world->link_term_count; i++) {
    const SporeSpringTerm *term = &world->springs[i];
    if (term->a.body == index && !add_hang(world, index, &world->spring_mappings[2 * i])) return false;
    if (term->b.body == index && !add_hang(world, index, &world->spring_mappings[2 * i + 1])) return false;
  }
  return true;
}

static bool prepare(SporeWorld *world, uint32_t index) {
  SporeBody *body = &world->bodies[index];
  body->division.possible = true;
  return hold_spares(world, body) && make_roomy(body) && add_hang(world, index, &body->spheres) &&
         hang_links(world, index);
}

static void copy_corners(SporeWorld *world, const SporeBody *body) {
  size_t count;
  const uint32_t *corners = body->model->type->corners(body->model, &count);
  memcpy(world->cuts.corners + 4 * body->division.corner_start, corners, 4 * count * sizeof *corners);
}

static bool can_be_parted(const SporeBody *body, size_t *count) {
  return body->role == SPORE_PASSIVE && body->model->type->corners && body->model->type->corners(body->model, count);
}

bool spore_world_compile_division(SporeWorld *world) {
  size_t count, total = 0;
  for (size_t b = 0; b < world->body_count; b++) {
    if (!can_be_parted(&world->bodies[b], &count)) continue;
    world->bodies[b].division.corner_start = total;
    total += count;
  }
  if (total == 0) return true;
  world->cuts.corner_count = total;
  world->cuts.corners = SPORE_NEW_ARRAY(uint32_t, 4 * total);
  world->hangs = SPORE_NEW_ARRAY(SporeHang, world->body_count + 2 * world->link_term_count);
  bool made = world->cuts.corners && world->hangs;
  for (uint32_t b = 0; made && b < world->body_count; b++) {
    if (!can_be_parted(&world->bodies[b], &count)) continue;
    made = prepare(world, b);
    if (made) copy_corners(world, &world->bodies[b]);
  }
  world->cuts.parted = 1;
  return made;
}

void spore_world_clear_division(SporeWorld *world) {
  for (size_t i = 0; i < world->hang_count; i++) spore_free(world->hangs[i].places);
  for (size_t b = 0; world->bodies && b < world->body_count; b++) {
    SporeDivision *division = &world->bodies[b].division;
    spore_block_pattern_clear(&division->pattern);
    spore_block_room_clear(&division->room);
    spore_free(division->pinned);
  }
}

/* Parting. */

/* What hangs on the body goes with its tetrahedra, and its matrix has the pattern that it has now. */
static void follow(SporeWorld *world, uint32_t index) {
  SporeBody *body = &world->bodies[index];
  SporeDivision *division = &body->division;
  size_t count;
  const uint32_t *corners = body->model->type->corners(body->model, &count);
  for (size_t i = 0; i < world->hang_count; i++)
    if (world->hangs[i].body == index) spore_mapping_follow(world->hangs[i].mapping, world->hangs[i].places, corners);
  spore_block_pattern_empty(&division->pattern);
  body->model->type->pattern(body->model, &division->pattern);
  spore_block_matrix_lay_out(&body->matrix, &division->pattern, &division->room);
  body->model->type->settle(body->model, &body->matrix);
  copy_corners(world, body);
  world->cuts.parted++;
}

/* Its numbers may be many more now. */
static void drop_factor(SporeBody *body) { body->factor.block_count = body->factor.band.block_count = 0; }

/* What holds a node holds its copies. */
static void divide(SporeWorld *world, uint32_t index) {
  SporeBody *body = &world->bodies[index];
  size_t before = nodes_in_use(body);
  const uint32_t *from;
  size_t made =
      body->model->type->divide(body->model, world->next_q + body->q_offset, world->next_v + body->v_offset, &from);
  if (made == 0) return;
  for (size_t i = 0; i < made; i++) body->division.pinned[before + i] = body->division.pinned[from[i]];
  spore_body_list_held(body);
  follow(world, index);
  drop_factor(body);
  body->division.parted = body->division.untidy = true;
  body->division.step = world->step;
  spore_body_set_mass(world, body);
  spore_body_changed_model(world, index);
}

void spore_world_divide_bodies(SporeWorld *world) {
  if (world->cuts.corner_count == 0) return;
  for (uint32_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (!body->division.wanted || body->frozen || body->asleep) continue;
    body->division.wanted = false;
    divide(world, b);
  }
}

#define CALM_STEPS 16 /* before a factor is made: as long as the blades go on, it would not last */

bool spore_world_tidy(SporeWorld *world) {
  bool done = false;
  for (uint32_t b = 0; world->cuts.corner_count + world->line_count > 0 && b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (!body->division.untidy || world->step < body->division.step + CALM_STEPS) continue;
    body->division.untidy = false;
    if (!spore_body_compile_factor(world, body, NULL)) continue; /* by conjugate gradients, then */
    spore_body_reset_choice(world, body);
    done = true;
  }
  return done;
}

void spore_world_mend_division(SporeWorld *world) {
  for (uint32_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    body->division.wanted = false;
    if (!body->division.parted) continue;
    size_t used = nodes_in_use(body);
    memset(body->division.pinned + used, 0, body->block_count - used);
    spore_body_list_held(body);
    follow(world, b);
    spore_body_compile_factor(world, body, NULL); /* without memory for it, by conjugate gradients */
    body->division.parted = body->division.untidy = false;
  }
}
