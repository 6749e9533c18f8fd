/* A device of type "pointer": what a mouse, or any other thread, says now. One thread sets it, the simulation reads it,
 * neither ever waits for the other. The device glides to where it was told to be, so that the steps of a mouse, which
 * speaks less often than the simulation asks, do not become blows. All functions take NULL and then do nothing. */
#ifndef SPORE_HAPTIC_POINTER_H
#define SPORE_HAPTIC_POINTER_H

#include "core/haptic/device.h"

/* Time constant of the glide. */
#define SPORE_POINTER_GLIDE_S 0.012

/* Says nothing (exchange gives false) until it was set for the first time. NULL: no memory. Close it by its type. */
SporeDevice *spore_pointer_device_create(void);
/* Where to be; velocities are ignored: they follow from the glide. From one thread at a time. */
void spore_pointer_device_set(SporeDevice *device, const SporeDeviceState *state);
/* Forgets what was set: it says nothing again. Only while neither side uses it. */
void spore_pointer_device_release(SporeDevice *device);

#endif
