/* Levels of detail: makes them before the world runs, and exchanges one for another. */
#include "core/sim/world_private.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"

#define WEIGHT_APART 0.1 /* of a body's mass, by which a level may differ from it */

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a body's levels"));
}

static bool refuse(const SporeBody *body, int grade, const char *reason, SporeError *error) {
  assert(grade >= 0 && grade < SPORE_LOD_COUNT);
  char place[200];
  snprintf(place, sizeof place, "bodies/%s", body->name);
  return spore_error_set(error, SPORE_ERROR_INPUT, place, _("level %s: %s"), spore_lod_names[grade], reason);
}

/* Sizes. */

static bool check_model(const SporeBody *body, int grade, SporeError *error) {
  assert(body->model && body->lod->level[grade].model);
  const SporeModel *fine = body->model, *model = body->lod->level[grade].model;
  if (fine->type->particles || spore_model_is_rigid(fine))
    return refuse(body, grade,
                  _("the body does not deform as one piece, so that it has no levels; take them out of its fidelity"),
                  error);
  if (model->type != fine->type)
    return refuse(body, grade, _("it is of another model than the body; this is a fault of the scene"), error);
  double mass = spore_model_total_mass(model);
  if (fabs(mass - body->total_mass) <= WEIGHT_APART * body->total_mass) return true;
  char reason[300];
  snprintf(reason, sizeof reason,
           _("it weighs %.4g kg, and the body %.4g kg; expected the same to a tenth; give it the same density and a "
             "geometry of the same size"),
           mass, body->total_mass);
  return refuse(body, grade, reason, error);
}

static bool make_room(SporeLod *levels, const SporeModel *model) {
  if (model->q_room > levels->q_room) levels->q_room = model->q_room;
  if (3 * model->block_room > levels->v_room) levels->v_room = 3 * model->block_room;
  return true;
}

bool spore_lod_make(SporeWorld *world, SporeBody *body, const SporeBodyDescription *from, SporeError *error) {
  assert(!body->lod);
  SporeModel *const *model = from->lod.model;
  if (!model[SPORE_LOD_COARSE] && !model[SPORE_LOD_MEDIUM]) return true;
  if (!body->model)
    return refuse(body, model[SPORE_LOD_COARSE] ? SPORE_LOD_COARSE : SPORE_LOD_MEDIUM,
                  _("the body does not move by physics, so that it has no levels; take them out"), error);
  SporeLod *levels = body->lod = SPORE_NEW(SporeLod);
  if (!levels) return no_memory(error);
  levels->tolerance = from->lod.tolerance;
  levels->first = from->lod.first;
  levels->automation.rule = from->lod.rule;
  levels->level[SPORE_LOD_FINE].model = body->model;
  make_room(levels, body->model);
  for (int k = 0; k < SPORE_LOD_FINE; k++) {
    if (!model[k]) continue;
    levels->level[k].model = model[k];
    model[k]->map_slack = levels->tolerance;
    if (!check_model(body, k, error)) return false;
    make_room(levels, model[k]);
  }
  if (!levels->level[levels->first].model)
    return refuse(body, (int)levels->first, _("the body begins at it, and has no such level; add it, or begin at fine"),
                  error);
  body->model->map_slack = levels->tolerance;
  world->has_lod = true;
  return true;
}

/* Exchange. */

/* The parts of a level move out of the body and into it. Only pointers are copied. */

static void put_away(SporeWorld *world, SporeBody *body) {
  assert(body->lod->level[body->grade].model == body->model);
  SporeLodLevel *level = &body->lod->level[body->grade];
  level->spheres = body->collision.spheres;
  level->whole_weight = body->collision.whole_weight;
  level->matrix = body->preconditioner.matrix;
  level->factor = body->preconditioner.factor;
  level->held_flags = body->held.flags;
  level->held = body->held.blocks;
  level->held_count = body->held.count;
  level->pin_count = body->held.pin_count;
  for (size_t e = 0; level->ends && e < body->lod->end_count; e++)
    level->ends[e] = world->links.mappings[body->lod->ends[e]];
}

static void take_out(SporeWorld *world, SporeBody *body, SporeLodGrade grade) {
  assert(body->lod->level[grade].model);
  SporeLodLevel *level = &body->lod->level[grade];
  body->grade = grade;
  body->model = level->model;
  body->q_count = level->model->q_count;
  body->block_count = level->model->block_count;
  body->total_mass = spore_model_total_mass(level->model);
  body->collision.spheres = level->spheres;
  body->collision.whole_weight = level->whole_weight;
  body->preconditioner.matrix = level->matrix;
  body->preconditioner.factor = level->factor;
  body->held.flags = level->held_flags;
  body->held.blocks = level->held;
  body->held.count = level->held_count;
  body->held.pin_count = level->pin_count;
  for (size_t e = 0; level->ends && e < body->lod->end_count; e++)
    world->links.mappings[body->lod->ends[e]] = level->ends[e];
}

static void take_rest(SporeWorld *world, const SporeBody *body) {
  assert(body->q_count <= body->lod->q_room);
  assert(3 * body->block_count <= body->lod->v_room);
  const SporeLodLevel *level = &body->lod->level[body->grade];
  double *q = world->state.rest_q + body->q_offset, *v = world->state.rest_v + body->v_offset;
  memset(q, 0, body->lod->q_room * sizeof *q);
  memset(v, 0, body->lod->v_room * sizeof *v);
  memcpy(q, level->rest_q, body->q_count * sizeof *q);
  memcpy(v, level->rest_v, 3 * body->block_count * sizeof *v);
}

/* Curve joints along the body are placed anew on the level's own line. */
static void seek_curve_joints(SporeWorld *world, uint32_t index) {
  assert(index < world->body_count);
  const SporeModel *model = world->bodies[index].model;
  for (size_t i = 0; model->type->line && i < world->links.count; i++) {
    SporeLink *link = &world->links.all[i];
    const SporeSpringTerm *term = &world->links.springs[link->term_start];
    if (!term->curve || term->b.body != index || term->curve->points) continue;
    link->curve.knots = model->type->line->path(model);
    link->lost = true;
  }
}

void spore_world_exchange_lod(SporeWorld *world, uint32_t index, SporeLodGrade grade) {
  assert(index < world->body_count);
  assert(world->bodies[index].lod);
  SporeBody *body = &world->bodies[index];
  size_t free_before = body->block_count - body->held.count;
  put_away(world, body);
  take_out(world, body, grade);
  seek_curve_joints(world, index);
  world->state.dof += 3 * (body->block_count - body->held.count - free_before);
}

void spore_world_select_lod(SporeWorld *world, uint32_t index, SporeLodGrade grade) {
  assert(index < world->body_count);
  assert((unsigned)grade < SPORE_LOD_COUNT);
  SporeBody *body = &world->bodies[index];
  if (!body->lod || body->grade == grade) return;
  spore_world_exchange_lod(world, index, grade);
  take_rest(world, body);
}

void spore_world_reset_lod(SporeWorld *world) {
  world->levels.change_count = 0;
  world->levels.clock = (SporeLodClock){.changed_body = SPORE_NO_BODY};
  for (uint32_t b = 0; world->has_lod && b < world->body_count; b++) {
    SporeLod *levels = world->bodies[b].lod;
    if (!levels) continue;
    spore_world_select_lod(world, b, levels->first);
    take_rest(world,
              &world->bodies[b]); /* a change while the world runs leaves the rest state of another level there */
    levels->state = (SporeLodState){.level = levels->first};
    levels->automation =
        (SporeLodAutomation){.rule = levels->automation.rule, .stays_fine = levels->automation.stays_fine};
  }
}

/* Making a level: the level is put into the body as if it were its only one. */

static bool remember_rest(const SporeWorld *world, const SporeBody *body, SporeLodLevel *level) {
  assert(!level->rest_q && !level->rest_v);
  level->rest_q = SPORE_NEW_ARRAY(double, body->q_count);
  level->rest_v = SPORE_NEW_ARRAY(double, 3 * body->block_count);
  if (!level->rest_q || !level->rest_v) return false;
  memcpy(level->rest_q, world->state.rest_q + body->q_offset, body->q_count * sizeof(double));
  memcpy(level->rest_v, world->state.rest_v + body->v_offset, 3 * body->block_count * sizeof(double));
  return true;
}

/* Maps the points that links hold and the pull may hold, where the finest level has them. */
static bool map_ends(SporeWorld *world, uint32_t index, SporeMapping *ends, SporeError *error) {
  const SporeBody *body = &world->bodies[index];
  const SporeLod *levels = body->lod;
  const double *fine = levels->level[SPORE_LOD_FINE].rest_q;
  assert(fine);
  for (size_t e = 0; e < levels->end_count; e++) {
    double point[3];
    if (levels->ends[e] == 2 * spore_world_pull_index(world, index)) {
      if (!spore_mapping_init_identity(&ends[e], body->model->node_count)) return no_memory(error);
      continue;
    }
    const SporeMapping *at = &world->links.mappings[levels->ends[e]];
    spore_vec3_store(point, spore_pose_apply_inverse(body->rest_pose, spore_mapping_position(at, 0, fine)));
    if (!spore_world_map(world, index, point, 1, &ends[e], error)) return false;
  }
  return true;
}

static bool fill_level(SporeWorld *world, const SporeWorldDescription *description, uint32_t index, SporeError *error) {
  assert(description->body_count == world->body_count);
  SporeBody *body = &world->bodies[index];
  const SporeBodyDescription *from = &description->bodies[index];
  double *q = world->state.rest_q + body->q_offset, *v = world->state.rest_v + body->v_offset;
  body->model->type->place(body->model, body->rest_pose, from->velocity, from->spin, q, v);
  return spore_body_create_matrix(body, error) && spore_body_map_spheres(world, index, from->spheres, error) &&
         spore_body_create_pins(world, description, index, error) && spore_body_create_factor(world, body, error);
}

static bool keep_whole_weight(const SporeBody *body, SporeLodLevel *level) {
  const SporeBody *fine = body;
  if (!fine->lod->level[SPORE_LOD_FINE].whole_weight || level->spheres.kind != SPORE_MAPPING_LINEAR) return true;
  size_t count = level->spheres.row_start[level->spheres.point_count];
  level->whole_weight = SPORE_NEW_ARRAY(double, count);
  if (level->whole_weight) memcpy(level->whole_weight, level->spheres.weight, count * sizeof(double));
  return level->whole_weight != NULL;
}

static bool make_level(SporeWorld *world, const SporeWorldDescription *description, uint32_t index, SporeLodGrade grade,
                       SporeError *error) {
  assert(grade != SPORE_LOD_FINE && world->bodies[index].grade == SPORE_LOD_FINE);
  SporeBody *body = &world->bodies[index];
  SporeLodLevel *level = &body->lod->level[grade];
  SporeMapping *ends = SPORE_NEW_ARRAY(SporeMapping, body->lod->end_count);
  if (!ends) return no_memory(error);
  put_away(world, body);
  take_out(world, body, grade);
  bool good = fill_level(world, description, index, error);
  good = good && (remember_rest(world, body, level) || no_memory(error));
  good = good && map_ends(world, index, ends, error);
  put_away(world, body);
  take_out(world, body, SPORE_LOD_FINE);
  level->ends = ends;
  return good && (keep_whole_weight(body, level) || no_memory(error));
}

static bool find_ends(SporeWorld *world, uint32_t index) {
  assert(world->bodies[index].lod && !world->bodies[index].lod->ends);
  SporeLod *levels = world->bodies[index].lod;
  size_t springs = world->links.term_count;
  levels->ends = SPORE_NEW_ARRAY(uint32_t, 2 * springs + 1);
  if (!levels->ends) return false;
  for (size_t i = 0; i < springs; i++) {
    if (world->links.springs[i].a.body == index) levels->ends[levels->end_count++] = (uint32_t)(2 * i);
    if (world->links.springs[i].b.body == index && !world->links.springs[i].curve)
      levels->ends[levels->end_count++] = (uint32_t)(2 * i + 1);
  }
  levels->ends[levels->end_count++] = (uint32_t)(2 * spore_world_pull_index(world, index));
  levels->level[SPORE_LOD_FINE].ends = SPORE_NEW_ARRAY(SporeMapping, levels->end_count);
  return levels->level[SPORE_LOD_FINE].ends != NULL;
}

static bool make_levels(SporeWorld *world, const SporeWorldDescription *description, uint32_t index,
                        SporeError *error) {
  SporeBody *body = &world->bodies[index];
  SporeLod *levels = body->lod;
  if (!find_ends(world, index) || !remember_rest(world, body, &levels->level[SPORE_LOD_FINE])) return no_memory(error);
  for (int k = 0; k < SPORE_LOD_FINE; k++) {
    if (!levels->level[k].model || make_level(world, description, index, (SporeLodGrade)k, error)) continue;
    SporeError reason = *error;
    char place[200];
    snprintf(place, sizeof place, "bodies/%s", body->name);
    return spore_error_set(error, reason.code, *reason.place ? reason.place : place, _("level %s: %s"),
                           spore_lod_names[k], reason.message);
  }
  if (!spore_lod_sample(world, &description->bodies[index], index, error)) return false;
  if (levels->automation.rule.by == SPORE_LOD_BY_ERROR) spore_lod_measure_levels(levels);
  return true;
}

bool spore_world_create_lod(SporeWorld *world, const SporeWorldDescription *description, SporeError *error) {
  for (uint32_t b = 0; world->has_lod && b < world->body_count; b++)
    if (world->bodies[b].lod && !make_levels(world, description, b, error)) return false;
  return true;
}

/* Freeing. */

static void free_level(SporeLod *levels, SporeLodLevel *level, bool active) {
  spore_free(level->rest_q);
  spore_free(level->rest_v);
  spore_mapping_clear(&level->samples);
  spore_free(level->nearest);
  spore_free(level->diagonal);
  for (size_t e = 0; !active && level->ends && e < levels->end_count; e++) spore_mapping_clear(&level->ends[e]);
  spore_free(level->ends);
  if (level->model) level->model->type->destroy(level->model);
  if (active) return;
  spore_mapping_clear(&level->spheres);
  spore_free(level->whole_weight);
  spore_block_matrix_clear(&level->matrix);
  spore_block_cholesky_clear(&level->factor);
  spore_free(level->held_flags);
  spore_free(level->held);
}

void spore_lod_free(SporeBody *body) {
  assert(body->lod);
  SporeLod *levels = body->lod;
  for (int k = 0; k < SPORE_LOD_COUNT; k++) free_level(levels, &levels->level[k], (SporeLodGrade)k == body->grade);
  spore_free(levels->ends);
  spore_free(levels->sample_weight);
  spore_free(levels->before);
  spore_free(levels->speed);
  spore_free(levels->after);
  spore_free(levels->q);
  spore_free(levels->v);
  spore_free(levels->work);
  spore_free(levels);
}

void spore_lod_give_up(SporeBody *body) {
  for (int k = 0; body->lod && k < SPORE_LOD_COUNT; k++) body->lod->level[k].model = NULL;
}

/* Queries. */

static size_t mapping_memory(const SporeMapping *mapping) {
  size_t entries = mapping->row_start ? mapping->row_start[mapping->point_count] : 0;
  size_t points = mapping->points ? 3 * sizeof(double) : mapping->row_start ? sizeof(uint32_t) : 0;
  return mapping->point_count * points + entries * (sizeof(uint32_t) + sizeof(double));
}

static size_t waiting_memory(const SporeLodLevel *level) {
  const SporeBlockMatrix *matrix = &level->matrix;
  size_t blocks = matrix->row_start ? matrix->row_start[matrix->block_count] : 0;
  size_t bytes = blocks * (9 * sizeof(double) + sizeof(uint32_t)) + mapping_memory(&level->spheres);
  return bytes + (level->model->q_count + 3 * level->model->block_count) * sizeof(double);
}

size_t spore_world_lod_memory(const SporeWorld *world, uint32_t index) {
  assert(index < world->body_count);
  const SporeBody *body = &world->bodies[index];
  const SporeLod *levels = body->lod;
  size_t bytes = 0;
  for (int k = 0; levels && k < SPORE_LOD_COUNT; k++) {
    const SporeLodLevel *level = &levels->level[k];
    if (!level->model) continue;
    bytes += mapping_memory(&level->samples);
    if ((SporeLodGrade)k != body->grade) bytes += waiting_memory(level);
  }
  if (levels)
    bytes += (10 * levels->sample_count + levels->q_room + (1 + SPORE_LOD_VECTORS) * levels->v_room) * sizeof(double);
  return bytes;
}

SporeLodGrade spore_world_first_lod(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  const SporeLod *levels = world->bodies[body].lod;
  return levels ? levels->first : SPORE_LOD_FINE;
}

bool spore_world_may_be_cut(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  const SporeModel *model = world->bodies[body].model;
  return model && model->type->cut && world->topology.cuts.capacity > 0;
}

uint64_t spore_world_lod_change_count(const SporeWorld *world) { return world->levels.change_count; }

SporeLodChange spore_world_lod_change(const SporeWorld *world, uint64_t i) {
  assert(i < world->levels.change_count && world->levels.change_count - i <= SPORE_LOD_LOG);
  return world->levels.log[i % SPORE_LOD_LOG];
}

bool spore_world_lod_state(const SporeWorld *world, uint32_t body, SporeLodState *state) {
  assert(body < world->body_count);
  assert(state);
  if (!world->bodies[body].lod) return false;
  *state = world->bodies[body].lod->state;
  return true;
}
