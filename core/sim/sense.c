/* Active bodies: poses from devices, forces back to them. */
#include <string.h>

#include "core/base/text.h"
#include "core/sim/world_private.h"

static const SporeGuardLimits limits = SPORE_GUARD_LIMITS;

/* Velocity that takes the body from where it is to its target in one step. It is made from the poses, not from what
 * the device says, so that a recorded track gives the same motion again. */
void spore_active_set_velocity(SporeWorld *world, uint32_t index) {
  const SporeBody *body = &world->bodies[index];
  const double *from = world->q + body->q_offset, *to = world->target_q + body->q_offset;
  double rate = 1 / world->solver.time_step, *v = world->next_v + body->v_offset;
  SporeVec3 moved = spore_vec3_sub(spore_vec3_load(to), spore_vec3_load(from));
  SporeQuat turn = spore_quat_multiply(spore_quat_load(to + 3), spore_quat_conjugate(spore_quat_load(from + 3)));
  spore_vec3_store(v, spore_vec3_scale(rate, moved));
  spore_vec3_store(v + 3, spore_vec3_scale(rate, spore_quat_to_rotation_vector(turn)));
}

/* Between reading where a hand is and pushing it. */
static void push(SporeWorld *world, SporeBody *body) {
  SporeDevice *device = body->device;
  if (!device->type->push) return;
  SporeDeviceCommand command = body->command;
  bool whole = spore_passivity_limit(&body->passivity, &device->hand, body->input.position, world->solver.time_step,
                                     command.force);
  world->monitor.shortened_forces += !whole;
  device->type->push(device, &command);
}

static void sense(SporeWorld *world, SporeBody *body) {
  double time_s = (double)(world->step + 1) * world->solver.time_step;
  SporeDeviceState said = body->input;
  bool spoke = body->device->type->exchange(body->device, time_s, &body->command, &said);
  if (!spore_guard_input(&body->guard, &limits, time_s, spoke ? &said : NULL, &body->input) &&
      world->monitor.held_inputs++ == 0)
    spore_world_report(world, _("%s: its device said what cannot be; held, or followed at %g m/s; check the device"),
                       body->name, limits.speed);
  push(world, body);
  body->input_time_s = time_s;
  body->has_input |= spoke;
  double *target = world->target_q + body->q_offset;
  memcpy(target, body->input.position, sizeof body->input.position);
  spore_quat_store(target + 3, spore_quat_normalise(spore_quat_load(body->input.orientation)));
}

void spore_world_sense(SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (body->role != SPORE_ACTIVE) continue;
    if (body->device) sense(world, body);
  }
  for (size_t i = 0; i < world->port_count; i++) spore_port_aim(world, &world->ports[i]);
  for (uint32_t b = 0; b < world->body_count; b++)
    if (world->bodies[b].role == SPORE_ACTIVE) spore_active_set_velocity(world, b);
}

void spore_world_feed_back(SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (body->role != SPORE_ACTIVE) continue;
    memcpy(body->command.force, world->reaction + 6 * b, sizeof body->command.force);
    memcpy(body->command.torque, world->reaction + 6 * b + 3, sizeof body->command.torque);
    body->command.grip_N = 0;
  }
  for (size_t i = 0; i < world->tool_count; i++)
    if (spore_tool_has_jaws(&world->tools[i])) spore_jaws_feed_back(world, &world->tools[i]);
  for (size_t b = 0; b < world->body_count; b++)
    if (world->bodies[b].role == SPORE_ACTIVE) spore_guard_command(&limits, &world->bodies[b].command);
}
