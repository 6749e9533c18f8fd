/* Interpolation between device states. Private to core/haptic. */
#ifndef SPORE_HAPTIC_MOTION_H
#define SPORE_HAPTIC_MOTION_H

#include "core/haptic/device.h"
#include "core/math/quat.h"

/* State at fraction 0..1 of the way from one to the other: linear in position and grip, along the shortest arc in
 * orientation; buttons and flags of `from` before the end. Velocities are zero. */
SporeDeviceState spore_motion_between(const SporeDeviceState *from, const SporeDeviceState *to, double fraction);

/* Rotation vector (rad, world axes) of the shortest turn between two orientations, which need not be of unit length. */
SporeVec3 spore_motion_turn(const double from[4], const double to[4]);

/* Velocity and spin of `state` as those that lead to it from `before` in dt_s; zero where dt_s is not positive. */
void spore_motion_set_velocity(SporeDeviceState *state, const SporeDeviceState *before, double dt_s);

#endif
