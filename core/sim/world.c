/* The world's interface to its users: freeing, resetting, and queries about its bodies. */
#include "core/sim/world.h"

#include <assert.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/constraint/pin.h"
#include "core/sim/world_private.h"

static void clear_body(SporeBody *body) {
  spore_free(body->name);
  spore_free(body->start);
  spore_mapping_clear(&body->collision.spheres);
  spore_depth_field_clear(&body->collision.field);
  spore_free(body->collision.whole_weight);
  spore_free(body->held.blocks);
  spore_free(body->held.flags);
  spore_block_matrix_clear(&body->preconditioner.matrix);
  spore_block_cholesky_clear(&body->preconditioner.factor);
  spore_free(body->preconditioner.rows);
  spore_free(body->preconditioner.coupled);
  spore_block_pattern_clear(&body->changing.pattern);
  spore_block_room_clear(&body->changing.room);
  spore_free(body->changing.pinned);
  spore_body_clear_effect(body);
  if (body->lod) spore_lod_free(body);
  else if (body->model) body->model->type->destroy(body->model);
}

void spore_world_free(SporeWorld *world) {
  if (!world) return;
  spore_world_clear_tools(world);
  spore_world_clear_topology(world);
  spore_world_clear_links(world);
  spore_solve_clear(&world->solve);
  spore_contacts_clear(&world->contact);
  spore_state_clear(&world->state);
  spore_world_clear_stains(world);
  spore_world_clear_lenses(world);
  spore_commands_clear(&world->commands);
  for (size_t i = 0; world->bodies && i < world->body_count; i++) clear_body(&world->bodies[i]);
  spore_free(world->levels.eyes);
  spore_free(world->bodies);
  spore_free(world);
}

static void reset_body(SporeWorld *world, SporeBody *body) {
  body->method.integrator = body->method.chosen;
  body->reported.deep = body->reported.fast = body->reported.passed = body->reported.error = body->altered = false;
  body->collision.impact = (SporeImpact){0};
  body->sleep.steps = 0;
  spore_body_thaw(body);
  body->reported.notice = false;
  spore_body_forget_steps(world, body);
  body->device.has_input = false;
  body->device.command = (SporeDeviceCommand){0};
  spore_guard_start(&body->device.guard, 0, body->rest_pose);
  body->device.passivity = (SporePassivity){0};
  if (body->model) spore_body_set_mass(world, body);
  if (body->model && body->model->type->forget) body->model->type->forget(body->model);
}

/* Sets the bodies whose beginning is not where their models put them. */
static void set_starts(SporeWorld *world) {
  assert(world->state.step == 0);
  for (uint32_t b = 0; b < world->body_count; b++)
    if (world->bodies[b].start) spore_world_set_state(world, b, world->bodies[b].start, world->state.still);
}

void spore_world_reset(SporeWorld *world) {
  assert(world->state.rest_q && world->state.rest_v);
  assert(world->state.next_q && world->state.next_v);
  spore_world_wake_all(world);
  spore_world_reset_cutting(world);
  spore_world_reset_lod(world);
  spore_world_reset_refinement(world);
  memcpy(world->state.next_q, world->state.rest_q, world->state.q_count * sizeof *world->state.q);
  memcpy(world->state.next_v, world->state.rest_v, world->state.v_count * sizeof *world->state.v);
  for (size_t b = 0; b < world->body_count; b++) spore_body_mark_changed(world, &world->bodies[b]);
  spore_world_advance_state(world);
  memcpy(world->state.target_q, world->state.rest_q, world->state.q_count * sizeof *world->state.q);
  memset(world->state.reaction, 0, 6 * world->body_count * sizeof *world->state.reaction);
  for (size_t b = 0; b < world->body_count; b++) spore_world_release(world, (uint32_t)b);
  spore_world_reset_links(world);
  spore_world_reset_tools(world);
  spore_world_reset_splitting(world);
  spore_world_reset_particles(world);
  world->state.step = 0;
  spore_contacts_forget(world);
  world->state.counts = (SporeStepCounts){0};
  world->schedule.step_us = 0;
  world->schedule.cancelled = false;
  for (size_t b = 0; b < world->body_count; b++) reset_body(world, &world->bodies[b]);
  spore_world_reset_effects(world);
  spore_world_reset_stains(world);
  spore_world_reset_lenses(world);
  spore_monitor_reset(&world->state.monitor);
  spore_world_reset_unsolved(world);
  spore_world_make_plan(world);
  spore_world_map_spheres(world);
  spore_world_link(world);
  spore_world_publish(world);
  set_starts(world);
}

void spore_world_set_budget(SporeWorld *world, double budget_us) { world->schedule.budget_us = budget_us; }

void spore_world_set_device(SporeWorld *world, uint32_t body, SporeDevice *device) {
  if (body < world->body_count) world->bodies[body].device.device = device;
}

bool spore_world_body_altered(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  return world->bodies[body].altered;
}

SporeDevice *spore_world_device(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  return world->bodies[body].device.device;
}

const SporeDeviceState *spore_world_input(const SporeWorld *world, uint32_t index, double *time_s) {
  assert(index < world->body_count);
  assert(time_s);
  const SporeBody *body = &world->bodies[index];
  if (!body->device.has_input) return NULL;
  *time_s = body->device.input_time_s;
  return &body->device.input;
}

const SporeDeviceCommand *spore_world_feedback(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  return world->bodies[body].device.device ? &world->bodies[body].device.command : NULL;
}

const double *spore_world_reaction(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  return world->state.reaction + 6 * (size_t)body;
}

SporePose spore_world_start_pose(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  return world->bodies[body].rest_pose;
}

size_t spore_world_body_count(const SporeWorld *world) { return world->body_count; }

uint32_t spore_world_find_body(const SporeWorld *world, const char *name) {
  assert(name);
  for (uint32_t b = 0; b < world->body_count; b++)
    if (!strcmp(world->bodies[b].name, name)) return b;
  return SPORE_NO_BODY;
}

const char *spore_world_body_name(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  return world->bodies[body].name;
}
SporeRole spore_world_body_role(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  return world->bodies[body].role;
}
uint32_t spore_world_hand(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  if (world->bodies[body].role != SPORE_ACTIVE) return SPORE_NO_BODY;
  for (size_t i = 0; i < world->tools.count; i++)
    for (int part = 1; part < SPORE_TOOL_BODIES; part++)
      if (world->tools.all[i]->bodies[part] == body) return world->tools.all[i]->bodies[0];
  return body;
}
const SporeModel *spore_world_body_model(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  return world->bodies[body].model;
}
bool spore_world_body_made_safer(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  return world->bodies[body].method.integrator != world->bodies[body].method.chosen;
}
bool spore_world_body_frozen(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  return world->bodies[body].frozen;
}
bool spore_world_body_asleep(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  return world->bodies[body].sleep.asleep || world->bodies[body].effect.drops.rest.asleep;
}
uint64_t spore_world_step_count(const SporeWorld *world) { return world->state.step; }
SporeBodyMarks spore_world_body_marks(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  return world->bodies[body].marks;
}

size_t spore_world_contact_count(const SporeWorld *world) { return world->contact.count; }

SporeTouch spore_world_contact(const SporeWorld *world, size_t i) {
  assert(i < world->contact.count);
  const SporeContactTerm *term = &world->contact.terms[i];
  return (SporeTouch){term->a.body, term->b.body, spore_vec3_dot(term->force, term->normal)};
}

const SporeSpheres *spore_world_spheres(const SporeWorld *world) { return &world->contact.spheres; }
size_t spore_world_body_sphere_count(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  return world->bodies[body].collision.spheres.point_count;
}
bool spore_world_body_meets_itself(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  return world->bodies[body].collision.fields.self;
}
size_t spore_world_q_offset(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  return world->bodies[body].q_offset;
}
size_t spore_world_corner_start(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  const SporeNodeSplitting *splitting = &world->bodies[body].splitting;
  return splitting->possible ? splitting->corner_start : SIZE_MAX;
}
size_t spore_world_v_offset(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  return world->bodies[body].v_offset;
}
const double *spore_world_q(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  return world->state.q + world->bodies[body].q_offset;
}
const double *spore_world_v(const SporeWorld *world, uint32_t body) {
  assert(body < world->body_count);
  return world->state.v + world->bodies[body].v_offset;
}
const SporeProfilePhase *spore_world_profile(const SporeWorld *world) { return &world->schedule.profile; }
const SporeMonitor *spore_world_monitor(const SporeWorld *world) { return &world->state.monitor; }
SporeStepCounts spore_world_counts(const SporeWorld *world) { return world->state.counts; }
