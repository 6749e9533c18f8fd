/* Input and force-feedback devices. SI; x right, y up, z toward the user. */
#ifndef SPORE_HAPTIC_DEVICE_H
#define SPORE_HAPTIC_DEVICE_H

#include <stdbool.h>
#include <stdint.h>

#include "core/base/error.h"
#include "core/haptic/passivity.h"

/* What a device says. Poses are in the scene's frame. */
typedef struct SporeDeviceState {
  uint64_t t_ns;         /* device clock */
  double position[3];    /* m */
  double orientation[4]; /* quaternion w x y z */
  double velocity[3];    /* m/s */
  double spin[3];        /* rad/s, world axes */
  double grip_rad;
  uint32_t buttons, flags;
} SporeDeviceState;

/* What a device is told. */
typedef struct SporeDeviceCommand {
  double force[3];  /* N */
  double torque[3]; /* N m */
  double grip_N;
} SporeDeviceCommand;

/* A device; its type's own structure begins with one. */
typedef struct SporeDevice SporeDevice;

/* What every device of a kind can do. */
typedef struct SporeDeviceType {
  const char *name;
  const char *doc; /* translatable */
  /* Gives the state for simulation time time_s, and takes the force of the last step: for what shows it. Called once a
   * step by the simulation thread; must neither block nor allocate. False: nothing to give, the last state is held. */
  bool (*exchange)(SporeDevice *device, double time_s, const SporeDeviceCommand *command, SporeDeviceState *state);
  void (*close)(SporeDevice *device);
  /* Of a device that pushes a hand, NULL of others: called right after exchange with the same force, shortened so that
   * the hand never gets more energy than it gave; to be held until the next call. Torque and grip are not looked at. */
  void (*push)(SporeDevice *device, const SporeDeviceCommand *command);
} SporeDeviceType;

/* First member of every device's own structure. */
struct SporeDevice {
  const SporeDeviceType *type;
  SporePassivityLimits hand; /* of a type with push */
};

#endif
