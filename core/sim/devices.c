/* Device input and feedback: poses of active bodies come from devices, and forces on these bodies go back. */
#include <assert.h>
#include <string.h>

#include "core/base/text.h"
#include "core/sim/world_private.h"

static const SporeGuardLimits limits = SPORE_GUARD_LIMITS;

/* Pushes the hand between two readings, with no more force than keeps the device passive. */
static void push(SporeWorld *world, SporeBody *body) {
  assert(body->device.device);
  assert(world->solver.time_step > 0);
  SporeDevice *device = body->device.device;
  if (!device->type->push) return;
  SporeDeviceCommand command = body->device.command;
  bool whole = spore_passivity_limit(&body->device.passivity, &device->hand, body->device.input.position,
                                     world->solver.time_step, command.force);
  world->state.monitor.shortened_forces += !whole;
  device->type->push(device, &command);
}

static void read_device(SporeWorld *world, SporeBody *body) {
  assert(body->role == SPORE_ACTIVE && body->q_count == SPORE_POSE_Q);
  double time_s = (double)(world->state.step + 1) * world->solver.time_step;
  SporeDeviceState fresh = body->device.input;
  bool answered = body->device.device->type->exchange(body->device.device, time_s, &body->device.command, &fresh);
  if (!spore_guard_input(&body->device.guard, &limits, time_s, answered ? &fresh : NULL, &body->device.input) &&
      world->state.monitor.held_inputs++ == 0)
    spore_world_report(world, _("%s: its device said what cannot be; held, or followed at %g m/s; check the device"),
                       body->name, limits.speed);
  push(world, body);
  body->device.input_time_s = time_s;
  body->device.has_input |= answered;
  double *target = world->state.target_q + body->q_offset;
  memcpy(target, body->device.input.position, sizeof body->device.input.position);
  spore_quat_store(target + 3, spore_quat_normalise(spore_quat_load(body->device.input.orientation)));
}

void spore_world_read_devices(SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (body->role != SPORE_ACTIVE) continue;
    if (body->device.device) read_device(world, body);
  }
  for (size_t i = 0; i < world->links.trocar_count; i++) spore_trocar_aim(world, &world->links.trocars[i]);
  for (uint32_t b = 0; b < world->body_count; b++)
    if (world->bodies[b].role == SPORE_ACTIVE) spore_active_set_velocity(world, b);
}

/* Point that torques on the body refer to: the origin of its frame; for a set of nodes, that origin at time 0. */
static SporeVec3 origin(const SporeWorld *world, const SporeBody *body) {
  bool frame = !body->model || spore_model_is_rigid(body->model);
  return frame ? spore_vec3_load(world->state.q + body->q_offset) : body->rest_pose.position;
}

static void add_reaction(SporeWorld *world, uint32_t index, SporeVec3 point, SporeVec3 force) {
  assert(index == SPORE_NO_BODY || index < world->body_count);
  if (index == SPORE_NO_BODY || world->bodies[index].sleep.asleep) return;
  SporeVec3 arm = spore_vec3_sub(point, origin(world, &world->bodies[index]));
  spore_vec3_accumulate(world->state.reaction + 6 * (size_t)index, force);
  spore_vec3_accumulate(world->state.reaction + 6 * (size_t)index + 3, spore_vec3_cross(arm, force));
}

void spore_world_add_reactions(SporeWorld *world) {
  assert(world->state.reaction);
  assert(world->contact.count <= world->contact.capacity);
  /* A sleeping body keeps the reaction that it had when it fell asleep. */
  for (size_t b = 0; b < world->body_count; b++)
    if (!world->bodies[b].sleep.asleep) memset(world->state.reaction + 6 * b, 0, 6 * sizeof *world->state.reaction);
  for (size_t i = 0; i < world->contact.count; i++) {
    const SporeContactTerm *term = &world->contact.terms[i];
    SporeVec3 point = spore_contact_term_point(term);
    add_reaction(world, term->a.body, point, term->force);
    add_reaction(world, term->b.body, point, spore_vec3_scale(-1, term->force));
  }
  size_t springs = spore_world_spring_count(world);
  for (size_t i = 0; i < springs; i++) {
    const SporeSpringTerm *term = &world->links.springs[i];
    if (!world->links.active[i]) continue;
    add_reaction(world, term->a.body, term->a.position, term->force);
    add_reaction(world, term->b.body, term->b.position, spore_vec3_scale(-1, term->force));
  }
}

void spore_world_feed_back(SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (body->role != SPORE_ACTIVE) continue;
    memcpy(body->device.command.force, world->state.reaction + 6 * b, sizeof body->device.command.force);
    memcpy(body->device.command.torque, world->state.reaction + 6 * b + 3, sizeof body->device.command.torque);
    body->device.command.grip_N = 0;
  }
  spore_world_feed_back_tools(world);
  for (size_t b = 0; b < world->body_count; b++)
    if (world->bodies[b].role == SPORE_ACTIVE) spore_guard_command(&limits, &world->bodies[b].device.command);
}
