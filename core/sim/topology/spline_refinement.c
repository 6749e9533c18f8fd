/* Spline refinement: lines get control points where they bend, and lose them where they are straight.
 *
 * At the end of a step, when the next state is known, the model decides about its nodes. Where they change, the state
 * is transferred to the new nodes, and the matrix and a banded factor get the new pattern. Spheres, links and curve
 * joints stay at their parameters of the line. All arrays have room from the start, so that a step allocates nothing.
 *
 * Momentum of a free body is kept to rounding: the part that lumping the mass loses is given back as a rigid motion.
 * Kinetic energy does not grow. A body that pins hold gets no such motion. */
#include <assert.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/body/momentum.h"
#include "core/constraint/pin.h"
#include "core/sim/world_private.h"

static bool changes_nodes(const SporeBody *body) {
  return body->model && !body->lod && body->model->q_room > body->model->q_count;
}

/* Makes the matrix anew, with room, and lists the blocks that pins hold now and at time 0. */
static bool make_room(SporeWorld *world, SporeBody *body) {
  assert(!body->changing.pinned && body->block_count <= body->model->block_room);
  const SporeModel *model = body->model;
  SporeChangingMatrix *changing = &body->changing;
  changing->pinned = SPORE_NEW_ARRAY(uint8_t, 2 * model->block_room);
  uint32_t *held = spore_reallocate(body->held.blocks, body->held.count, model->block_room, sizeof *held);
  if (held) body->held.blocks = held;
  if (!held || !changing->pinned) return false;
  for (size_t i = 0; i < body->held.count; i++) changing->pinned[held[i]] = 1;
  memcpy(changing->pinned + model->block_room, changing->pinned, model->block_room);
  spore_block_matrix_clear(&body->preconditioner.matrix);
  spore_block_pattern_init(&changing->pattern, body->block_count);
  return spore_block_pattern_reserve(&changing->pattern, model->pair_room) &&
         model->type->pattern(model, &changing->pattern) &&
         spore_block_matrix_create_roomy(&body->preconditioner.matrix, &changing->pattern, model->block_room,
                                         model->pair_room, &changing->room);
}

static void show_knots(SporeWorld *world, uint32_t index) {
  assert(world->bodies[index].refinement.possible);
  SporeBody *body = &world->bodies[index];
  SporeSplineKnots knots = body->model->type->line->path(body->model);
  assert(body->refinement.break_start + knots.span_count < world->topology.lines.break_count);
  world->topology.lines.span_count[index] = (uint32_t)knots.span_count;
  memcpy(world->topology.lines.breaks + body->refinement.break_start, knots.breaks,
         (knots.span_count + 1) * sizeof *knots.breaks);
  world->topology.lines.number++;
  body->refinement.state.points = knots.span_count + 3;
  if (body->refinement.state.points > body->refinement.state.peak)
    body->refinement.state.peak = body->refinement.state.points;
}

bool spore_world_create_refinement(SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (!changes_nodes(body)) continue;
    body->refinement.possible = true;
    body->refinement.break_start = world->topology.lines.break_count;
    body->refinement.state.reserve = body->model->line_room;
    world->topology.lines.break_count += body->model->block_room;
    world->topology.line_count++;
    if (!make_room(world, body)) return false;
  }
  if (world->topology.line_count == 0) return true;
  world->topology.lines.breaks = SPORE_NEW_ARRAY(double, world->topology.lines.break_count);
  world->topology.lines.span_count = SPORE_NEW_ARRAY(uint32_t, world->body_count);
  if (!world->topology.lines.breaks || !world->topology.lines.span_count) return false;
  for (uint32_t b = 0; b < world->body_count; b++)
    if (world->bodies[b].refinement.possible) show_knots(world, b);
  return true;
}

/* Curve joints of links and stitches keep their place on the line, by its new control points. */
static void move_curve_joints(SporeWorld *world, uint32_t index, const double *q) {
  assert(index < world->body_count);
  assert(q);
  SporeSplineKnots knots = world->bodies[index].model->type->line->path(world->bodies[index].model);
  for (size_t i = 0; i < world->links.term_count + world->links.hold_count; i++) {
    SporeSpringTerm *term = &world->links.springs[i];
    if (!term->curve || term->curve->points || term->b.body != index) continue;
    term->curve->knots = knots;
    SporePathPlace place = spore_path_at(knots, q, term->curve->start);
    spore_curve_joint_set(term, &place);
  }
}

/* A needle may hold its thread by the last control point, whose index changes. */
static void move_last_point(SporeWorld *world, uint32_t index, size_t last_before, size_t last) {
  size_t tools = world->links.term_count;
  for (size_t i = tools; i < tools + world->links.hold_count; i++) {
    SporeEnd *end = &world->links.springs[i].a;
    bool holds_point = end->body == index && end->mapping && end->mapping->kind == SPORE_MAPPING_IDENTITY;
    if (holds_point && end->point == last_before) end->point = (uint32_t)last;
  }
}

/* Spheres, what is stained, and points of the body that links hold, follow the new control points. */
static void move_ends(SporeWorld *world, uint32_t index) {
  assert(index < world->body_count);
  const SporeModel *model = world->bodies[index].model;
  SporeSplineKnots knots = model->type->line->path(model);
  model->type->line->follow(model, knots, &world->bodies[index].collision.spheres);
  if (world->stains.units && world->stains.units[index].count > 0)
    model->type->line->follow(model, knots, &world->stains.units[index].mapping);
  for (size_t i = 0; i < world->links.term_count; i++)
    for (size_t side = 0; side < 2; side++) {
      const SporeEnd *end = side ? &world->links.springs[i].b : &world->links.springs[i].a;
      if (end->body == index) model->type->line->follow(model, knots, &world->links.mappings[2 * i + side]);
    }
}

static void lay_out_solver(SporeBody *body) {
  SporeChangingMatrix *changing = &body->changing;
  spore_body_lay_out_matrix(body);
  body->preconditioner.bare_c = 0;
  bool had = body->preconditioner.factor.block_count > 0 || changing->factor_is_old;
  changing->factor_is_old =
      had && !spore_block_cholesky_lay_out(&body->preconditioner.factor, &body->preconditioner.matrix);
}

/* Updates the body after its model changed its nodes; q: the new configuration. */
static void take_nodes(SporeWorld *world, uint32_t index, const double *q) {
  SporeBody *body = &world->bodies[index];
  assert(body->model->q_count <= body->model->q_room && body->model->block_count <= body->model->block_room);
  size_t free_before = body->block_count - body->held.count;
  body->q_count = body->model->q_count;
  body->block_count = body->model->block_count;
  if (body->q_count > body->q_most) body->q_most = body->q_count;
  if (body->block_count > body->block_most) body->block_most = body->block_count;
  body->total_mass = spore_model_total_mass(body->model);
  spore_body_list_held(body);
  world->state.dof += 3 * (body->block_count - body->held.count - free_before);
  lay_out_solver(body);
  body->changing.step = world->state.step;
  move_ends(world, index);
  move_last_point(world, index, body->refinement.state.points - 1,
                  body->model->type->line->path(body->model).span_count + 2);
  move_curve_joints(world, index, q);
  show_knots(world, index);
}

static void change(SporeWorld *world, uint32_t index) {
  SporeBody *body = &world->bodies[index];
  assert(body->refinement.possible && body->model->type->adapt);
  SporeModel *model = body->model;
  double *q = world->state.next_q + body->q_offset, *v = world->state.next_v + body->v_offset;
  size_t points = body->refinement.state.points;
  SporeVec3 pulled;
  bool pull = spore_world_pulled_point(world, index, &pulled);
  SporeMotion before = spore_model_motion(model, q, v, NULL);
  model->type->adapt->change_nodes(model, q, v, body->changing.pinned);
  take_nodes(world, index, q);
  if (body->held.count == 0) spore_model_keep_momentum(model, q, &before, before.kinetic, v);
  spore_pin_filter(body->held.blocks, body->held.count, v);
  spore_body_clear_unused(world, body);
  SporeLineState *state = &body->refinement.state;
  if (state->points > points) state->inserted += state->points - points;
  else state->removed += points - state->points;
  spore_body_forget_steps(world, body);
  spore_body_set_mass(world, body);
  if (pull) spore_world_pull_by(world, index, pulled);
}

void spore_world_refine_splines(SporeWorld *world) {
  for (uint32_t b = 0; world->topology.line_count > 0 && b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (!body->refinement.possible || !spore_body_moves(body)) continue;
    /* An explicit step is only known to be stable for the points of time 0. */
    if (!spore_integrator(body->method.integrator)->implicit) continue;
    const double *q = world->state.next_q + body->q_offset;
    SporeSplineRefinement *line = &body->refinement;
    uint64_t start = spore_clock_ns();
    bool changes =
        body->model->type->adapt->weigh_nodes(body->model, world->solver.time_step, q, body->changing.pinned);
    uint64_t looked = spore_clock_ns();
    line->looks++, line->look_ns += looked - start;
    if (!changes) continue;
    change(world, b);
    line->changed++, line->change_ns += spore_clock_ns() - looked;
  }
}

void spore_world_reset_refinement(SporeWorld *world) {
  for (uint32_t b = 0; world->topology.line_count > 0 && b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    SporeLineState *state = &body->refinement.state;
    if (!body->refinement.possible || (state->made > 0 && state->inserted == 0)) continue;
    memcpy(body->changing.pinned, body->changing.pinned + body->model->block_room, body->model->block_room);
    take_nodes(world, b, world->state.rest_q + body->q_offset);
    if (body->changing.factor_is_old)
      spore_body_create_factor(world, body, NULL); /* without memory: conjugate gradients */
    body->changing.factor_is_old = false;
    size_t points = state->points;
    *state = (SporeLineState){.points = points, .made = points, .peak = points, .reserve = state->reserve};
  }
}

/* Bytes of state, scratch and matrix of the blocks that are in reserve at time 0. */
static size_t reserved_memory(const SporeWorld *world, const SporeBody *body) {
  size_t spare = body->model->block_room - body->refinement.state.made, pairs = body->model->pair_room;
  size_t a_block = 8 * 3 + 12 * 3 + 3 * 9 + world->solve.scratch_per_block; /* doubles: as q, as v, as mass */
  return spare * a_block * sizeof(double) + (body->model->block_room + 2 * pairs) * (9 * sizeof(double) + 16);
}

bool spore_world_line_state(const SporeWorld *world, uint32_t body, SporeLineState *state) {
  assert(body < world->body_count);
  assert(state);
  const SporeSplineRefinement *line = &world->bodies[body].refinement;
  *state = line->state;
  if (!line->possible) return false;
  state->memory_bytes = reserved_memory(world, &world->bodies[body]);
  if (line->looks > 0) state->look_us = 1e-3 * (double)line->look_ns / (double)line->looks;
  if (line->changed > 0) state->change_us = 1e-3 * (double)line->change_ns / (double)line->changed;
  return true;
}

SporeSplineKnots spore_snapshot_knots(const SporeWorld *world, const SporeSnapshot *snapshot, uint32_t body) {
  assert(body < world->body_count);
  const SporeBody *line = &world->bodies[body];
  if (!line->refinement.possible) return (SporeSplineKnots){0};
  return (SporeSplineKnots){snapshot->lines.span_count[body], snapshot->lines.breaks + line->refinement.break_start};
}

bool spore_world_follow_knots(const SporeWorld *world, uint32_t body, SporeSplineKnots knots, SporeMapping *mapping) {
  assert(body < world->body_count);
  const SporeModel *model = world->bodies[body].model;
  return knots.span_count == 0 || model->type->line->follow(model, knots, mapping);
}
