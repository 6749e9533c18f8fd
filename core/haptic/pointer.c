/* A device that another thread moves. */
#include "core/haptic/pointer.h"

#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/base/triple.h"
#include "core/haptic/motion.h"

typedef struct Moment {
  double time_s;
  SporeDeviceState state;
} Moment;

typedef struct SporePointer {
  SporeDevice device;
  SporeTriple target_buffer;
  SporeDeviceState targets[3];

  /* Used by the simulation only. The moment before the last one is kept, because a step may be taken again from there.
   */
  bool has_target, has_moment;
  Moment last, before;
} SporePointer;

/* Simulation time begins, or went back by more than one step: the device jumps, since there is no path to glide along.
 */
static void jump(SporePointer *pointer, double time_s) {
  const SporeDeviceState *target = &pointer->targets[pointer->target_buffer.reading];
  pointer->last = (Moment){time_s, spore_motion_between(target, target, 1)};
  pointer->before = pointer->last;
  pointer->has_moment = true;
}

static void glide(SporePointer *pointer, double time_s) {
  const SporeDeviceState *target = &pointer->targets[pointer->target_buffer.reading];
  if (time_s > pointer->last.time_s) pointer->before = pointer->last;
  double dt_s = time_s - pointer->before.time_s;
  const SporeDeviceState *from = &pointer->before.state;
  SporeDeviceState state = spore_motion_between(from, target, -expm1(-dt_s / SPORE_POINTER_GLIDE_S));
  state.buttons = target->buttons;
  state.flags = target->flags;
  spore_motion_set_velocity(&state, from, dt_s);
  pointer->last = (Moment){time_s, state};
}

static bool pointer_exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command,
                             SporeDeviceState *state) {
  SporePointer *pointer = (SporePointer *)device;
  if (spore_triple_acquire(&pointer->target_buffer)) pointer->has_target = true;
  if (!pointer->has_target) return false;
  if (!pointer->has_moment || time_s < pointer->before.time_s) jump(pointer, time_s);
  else if (time_s != pointer->last.time_s) glide(pointer, time_s);
  *state = pointer->last.state;
  state->t_ns = (uint64_t)(fmax(time_s, 0) * 1e9);
  return true;
}

static void pointer_close(SporeDevice *device) { spore_free(device); }

static const SporeDeviceType pointer_type = {"pointer", N_("Follows the mouse"), pointer_exchange, pointer_close};

SporeDevice *spore_pointer_device_create(void) {
  SporePointer *pointer = SPORE_NEW(SporePointer);
  if (!pointer) return NULL;
  pointer->device.type = &pointer_type;
  pointer->target_buffer = SPORE_TRIPLE_INIT;
  return &pointer->device;
}

void spore_pointer_device_set(SporeDevice *device, const SporeDeviceState *state) {
  SporePointer *pointer = (SporePointer *)device;
  if (!pointer || !state) return;
  pointer->targets[pointer->target_buffer.writing] = *state;
  spore_triple_publish(&pointer->target_buffer);
}

void spore_pointer_device_release(SporeDevice *device) {
  SporePointer *pointer = (SporePointer *)device;
  if (!pointer) return;
  pointer->target_buffer = SPORE_TRIPLE_INIT;
  pointer->has_target = pointer->has_moment = false;
}
