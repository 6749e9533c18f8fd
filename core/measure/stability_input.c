/* Devices that go mad: they stand in front of a world's own devices. */
#include <math.h>

#include "core/base/memory.h"
#include "core/measure/stability_private.h"

#define TIMES_AS_FAST 10
#define RUSH_SPEED 10.  /* m/s */
#define LEAST_RUSH 0.02 /* m */
#define STEPS_OF_A_JUMP 25

typedef struct PushDevice {
  SporeDevice base;
  SporeWorld *world;
  SporeDevice *inner; /* NULL: the tool stood still */
  SporePushInput input;
  uint32_t body;
  size_t calls, stop_after;
  SporeVec3 home, way; /* m: where the tool is at time 0, and from there to what it rushes to */
  SporeQuat turned;
} PushDevice;

struct SporePushDevices {
  size_t count;
  PushDevice *all;
};

static bool has_hand(const SporeWorld *world, uint32_t body) {
  return spore_world_body_role(world, body) == SPORE_ACTIVE && spore_world_hand(world, body) == body;
}

bool spore_input_is_possible(const SporeWorld *world) {
  for (uint32_t b = 0; b < spore_world_body_count(world); b++)
    if (has_hand(world, b)) return true;
  return false;
}

/* From the point to the nearest sphere of a body that physics moves; 0 where there is none. */
static SporeVec3 way_to_nearest(const SporeWorld *world, SporeVec3 from) {
  const SporeSpheres *spheres = spore_world_spheres(world);
  SporeVec3 way = {0, 0, 0};
  double least = HUGE_VAL;
  for (size_t i = spheres->static_count; i < spheres->count; i++) {
    if (spore_world_body_role(world, spheres->body[i]) != SPORE_PASSIVE) continue;
    SporeVec3 to = spore_vec3_sub(spore_vec3_load(spheres->centre + 3 * i), from);
    double distance = spore_vec3_length(to);
    if (distance < least) least = distance, way = to;
  }
  return way;
}

static double triangle(double way, double length) {
  double phase = fmod(way, 2 * length);
  return phase < length ? phase : 2 * length - phase;
}

static void rush(const PushDevice *push, double time_s, SporeDeviceState *state) {
  double length = spore_vec3_length(push->way), reach = fmax(length, LEAST_RUSH);
  if (length == 0) return;
  double part = triangle(RUSH_SPEED * time_s, reach) / length;
  spore_vec3_store(state->position, spore_vec3_add_scaled(push->home, part, push->way));
}

static bool exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command, SporeDeviceState *state) {
  PushDevice *push = (PushDevice *)device;
  size_t call = push->calls++;
  double at_s = push->input == SPORE_INPUT_FAST ? TIMES_AS_FAST * time_s : time_s;
  bool answered = push->inner && push->inner->type->exchange(push->inner, at_s, command, state);
  if (!answered) {
    spore_vec3_store(state->position, push->home);
    spore_quat_store(state->orientation, push->turned);
  }
  if (push->input == SPORE_INPUT_NAN && call % 3 == 2) state->position[call % 2] = state->velocity[0] = NAN;
  if (push->input == SPORE_INPUT_INFINITE && call % 3 == 2) state->position[1] = call % 2 ? HUGE_VAL : -HUGE_VAL;
  if (push->input == SPORE_INPUT_JUMPS) state->position[0] += (double)(call / STEPS_OF_A_JUMP % 2);
  if (push->input == SPORE_INPUT_RUSH) rush(push, time_s, state);
  return push->input != SPORE_INPUT_STOPS || call < push->stop_after;
}

static void close_nothing(SporeDevice *device) {}

static const SporeDeviceType push_type = {.name = "push", .doc = "", .exchange = exchange, .close = close_nothing};

SporePushDevices *spore_push_devices_new(SporeWorld *world, SporePushInput input, size_t steps) {
  size_t bodies = spore_world_body_count(world);
  SporePushDevices *devices = SPORE_NEW(SporePushDevices);
  PushDevice *all = SPORE_NEW_ARRAY(PushDevice, bodies);
  if (!devices || !all) {
    spore_free(devices);
    spore_free(all);
    return NULL;
  }
  devices->all = all;
  for (uint32_t b = 0; b < bodies; b++) {
    if (!has_hand(world, b)) continue;
    const double *pose = spore_world_q(world, b);
    SporeVec3 home = spore_vec3_load(pose);
    PushDevice *push = &all[devices->count++];
    *push = (PushDevice){.base = {.type = &push_type},
                         .world = world,
                         .inner = spore_world_device(world, b),
                         .input = input,
                         .body = b,
                         .stop_after = steps / 2,
                         .home = home,
                         .way = way_to_nearest(world, home),
                         .turned = spore_quat_load(pose + 3)};
    spore_world_set_device(world, b, &push->base);
  }
  return devices;
}

void spore_push_devices_free(SporePushDevices *devices) {
  if (!devices) return;
  for (size_t i = 0; i < devices->count; i++)
    spore_world_set_device(devices->all[i].world, devices->all[i].body, devices->all[i].inner);
  spore_free(devices->all);
  spore_free(devices);
}
