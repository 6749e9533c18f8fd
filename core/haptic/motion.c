/* Interpolation between two device states. */
#include "core/haptic/motion.h"

static SporeQuat unit_quat(const double q[4]) { return spore_quat_normalise(spore_quat_load(q)); }

SporeVec3 spore_motion_turn(const double from[4], const double to[4]) {
  return spore_quat_to_rotation_vector(spore_quat_multiply(unit_quat(to), spore_quat_conjugate(unit_quat(from))));
}

SporeDeviceState spore_motion_between(const SporeDeviceState *from, const SporeDeviceState *to, double fraction) {
  SporeDeviceState state = fraction < 1 ? *from : *to;
  spore_quat_store(state.orientation, unit_quat(state.orientation));
  if (fraction > 0 && fraction < 1) { /* at the ends it is either state to the last bit */
    SporeVec3 start = spore_vec3_load(from->position), end = spore_vec3_load(to->position);
    spore_vec3_store(state.position, spore_vec3_add_scaled(start, fraction, spore_vec3_sub(end, start)));
    SporeVec3 turn = spore_vec3_scale(fraction, spore_motion_turn(from->orientation, to->orientation));
    SporeQuat turned = spore_quat_multiply(spore_quat_from_rotation_vector(turn), unit_quat(from->orientation));
    spore_quat_store(state.orientation, spore_quat_normalise(turned));
    state.grip_rad = from->grip_rad + fraction * (to->grip_rad - from->grip_rad);
  }
  spore_vec3_store(state.velocity, (SporeVec3){0, 0, 0});
  spore_vec3_store(state.spin, (SporeVec3){0, 0, 0});
  return state;
}

void spore_motion_set_velocity(SporeDeviceState *state, const SporeDeviceState *before, double dt_s) {
  double rate = dt_s > 0 ? 1 / dt_s : 0;
  SporeVec3 way = spore_vec3_sub(spore_vec3_load(state->position), spore_vec3_load(before->position));
  spore_vec3_store(state->velocity, spore_vec3_scale(rate, way));
  spore_vec3_store(state->spin, spore_vec3_scale(rate, spore_motion_turn(before->orientation, state->orientation)));
}
