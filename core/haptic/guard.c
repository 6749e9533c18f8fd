/* Limits on what a device asks of the simulation, and on what the simulation asks of the hand. */
#include "core/haptic/guard.h"

#include <stddef.h>

#include "core/haptic/motion.h"

#define ROUNDING 1e-6

static bool all_finite(const double *values, int count) {
  for (int i = 0; i < count; i++)
    if (!isfinite(values[i])) return false;
  return true;
}

static bool is_sound(const SporeDeviceState *state) {
  const double *q = state->orientation;
  return all_finite(state->position, 3) && all_finite(q, 4) && all_finite(state->velocity, 3) &&
         all_finite(state->spin, 3) && isfinite(state->grip_rad) && (q[0] != 0 || q[1] != 0 || q[2] != 0 || q[3] != 0);
}

/* Brings a vector to at most that length; true when it was longer. */
static bool shorten(double *vector, double longest) {
  SporeVec3 v = spore_vec3_load(vector);
  double largest = fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
  if (largest == 0) return false;
  SporeVec3 unit = {v.x / largest, v.y / largest, v.z / largest}; /* no overflow of squares */
  double length = spore_vec3_length(unit);
  if (length * largest <= longest) return false;
  spore_vec3_store(vector, spore_vec3_scale(longest / length, unit));
  return true;
}

/* The part of the way to the target that the limits allow; 1: the whole way. */
static double allowed_part(const SporeGuard *guard, const SporeGuardLimits *limits, double dt_s) {
  const double *from = guard->taken.position, *to = guard->target.position;
  double way = hypot(hypot(to[0] - from[0], to[1] - from[1]), to[2] - from[2]);
  double turn = spore_vec3_length(spore_motion_turn(guard->taken.orientation, guard->target.orientation));
  double part = 1;
  /* A motion that was shortened to the limit must pass unchanged when it is played back. */
  if (way > limits->speed * dt_s * (1 + ROUNDING)) part = fmin(part, limits->speed * dt_s / way);
  if (turn > limits->spin * dt_s * (1 + ROUNDING)) part = fmin(part, limits->spin * dt_s / turn);
  return part;
}

void spore_guard_start(SporeGuard *guard, double time_s, SporePose pose) {
  SporeDeviceState state = {0};
  spore_vec3_store(state.position, pose.position);
  spore_quat_store(state.orientation, spore_quat_normalise(pose.orientation));
  guard->taken = guard->target = state;
  guard->time_s = time_s;
  guard->started = true;
}

bool spore_guard_input(SporeGuard *guard, const SporeGuardLimits *limits, double time_s, const SporeDeviceState *said,
                       SporeDeviceState *taken) {
  bool sound = said && is_sound(said);
  if (said && !sound) guard->refused++;
  if (!guard->started && !sound) {
    *taken = (SporeDeviceState){.orientation = {1, 0, 0, 0}};
    return !said;
  }
  if (sound) guard->target = *said;
  double dt_s = fmax(time_s - guard->time_s, 0);
  double part = guard->started ? allowed_part(guard, limits, dt_s) : 1;
  SporeDeviceState state = spore_motion_between(guard->started ? &guard->taken : &guard->target, &guard->target, part);
  state.buttons = guard->target.buttons;
  state.flags = guard->target.flags;
  state.t_ns = guard->target.t_ns;
  if (guard->started) spore_motion_set_velocity(&state, &guard->taken, dt_s);
  guard->taken = state;
  guard->time_s = time_s;
  guard->started = true;
  if (part < 1) guard->limited++;
  *taken = guard->taken;
  return part == 1 && sound == (said != NULL);
}

bool spore_guard_command(const SporeGuardLimits *limits, SporeDeviceCommand *command) {
  if (!all_finite(command->force, 3) || !all_finite(command->torque, 3) || !isfinite(command->grip_N)) {
    *command = (SporeDeviceCommand){0};
    return false;
  }
  bool shortened = shorten(command->force, limits->force);
  shortened = shorten(command->torque, limits->torque) || shortened;
  if (fabs(command->grip_N) > limits->force) {
    command->grip_N = copysign(limits->force, command->grip_N);
    shortened = true;
  }
  return !shortened;
}
