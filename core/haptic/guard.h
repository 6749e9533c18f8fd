/* What stands between a device and the world: a device that goes mad must not blow the simulation up, nor the
 * simulation hurt the hand. */
#ifndef SPORE_HAPTIC_GUARD_H
#define SPORE_HAPTIC_GUARD_H

#include "core/haptic/device.h"
#include "core/math/quat.h"

typedef struct SporeGuardLimits {
  double speed;  /* m/s: a tool that is told to be elsewhere gets there no faster */
  double spin;   /* rad/s */
  double force;  /* N */
  double torque; /* N m */
} SporeGuardLimits;

/* Faster than any hand; the force is what a common desktop device can give. */
#define SPORE_GUARD_LIMITS ((SporeGuardLimits){.speed = 20, .spin = 200, .force = 10, .torque = 0.5})

/* A plain value: copy it before a step that may be taken again. */
typedef struct SporeGuard {
  bool started;
  double time_s;           /* of `taken` */
  SporeDeviceState target; /* the last state that was sound */
  SporeDeviceState taken;  /* what the world was given */
  uint64_t refused;        /* states that were not finite: the last one was held */
  uint64_t limited;        /* states too far from the last: followed at the limits */
} SporeGuard;

/* Begins where the tool stands at time_s, earlier than the first input, so that the first state cannot throw it.
 * Without it the first sound state is taken as it is. Counts are kept. */
void spore_guard_start(SporeGuard *guard, double time_s, SporePose pose);

/* What the world takes when the device said `said` (NULL: nothing, the last target holds) for time_s. True: the pose as
 * it was said, or nothing was. False: refused or limited, and counted. Velocity and spin are those of what was taken,
 * from one call to the next, whatever the device claims: so a recording of what was taken, played back at the same
 * times, is taken as the same bits. Where nothing sound was ever said and the guard was not started, guard->started is
 * false and *taken a state at the origin. */
bool spore_guard_input(SporeGuard *guard, const SporeGuardLimits *limits, double time_s, const SporeDeviceState *said,
                       SporeDeviceState *taken);

/* Shortens force, torque and grip to the limits; zero where not finite. False: something had to be changed. */
bool spore_guard_command(const SporeGuardLimits *limits, SporeDeviceCommand *command);

#endif
