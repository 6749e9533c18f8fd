/* The guard between device and world, and the pointer device. */
#include <glib.h>
#include <math.h>
#include <pthread.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/haptic/guard.h"
#include "core/haptic/pointer.h"
#include "core/haptic/track.h"

static const SporeGuardLimits limits = {.speed = 2, .spin = 10, .force = 5, .torque = 0.5};

static SporeDeviceState at(double x, double y, double z) {
  return (SporeDeviceState){.position = {x, y, z}, .orientation = {1, 0, 0, 0}};
}

static void test_passes(void) {
  SporeGuard guard = {0};
  SporeDeviceState said = at(5, 6, 7), taken;
  said.buttons = 3;
  said.grip_rad = 0.2;
  said.velocity[0] = 99; /* claimed, not believed */
  g_assert_true(spore_guard_input(&guard, &limits, 0, &said, &taken));
  g_assert_cmpmem(taken.position, 24, said.position, 24);
  g_assert_cmpfloat(taken.velocity[0], ==, 0);
  said.position[0] += 1e-3;
  g_assert_true(spore_guard_input(&guard, &limits, 1e-3, &said, &taken));
  g_assert_cmpmem(taken.position, 24, said.position, 24);
  g_assert_cmpfloat(fabs(taken.velocity[0] - 1), <, 1e-9);
  g_assert_cmpuint(taken.buttons, ==, 3);
  g_assert_cmpfloat(taken.grip_rad, ==, 0.2);
  g_assert_true(spore_guard_input(&guard, &limits, 2e-3, NULL, &taken)); /* silent: stands still */
  g_assert_cmpmem(taken.position, 24, said.position, 24);
  g_assert_cmpfloat(taken.velocity[0], ==, 0);
  g_assert_cmpuint(guard.refused + guard.limited, ==, 0);
}

/* Case 19: whatever field is not finite, the last pose is held and it is counted. */
static void test_not_finite(void) {
  SporeGuard guard = {0};
  SporeDeviceState good = at(1, 2, 3), taken;
  spore_guard_input(&guard, &limits, 0, &good, &taken);
  static const double odd[] = {NAN, INFINITY, -INFINITY};
  static const size_t fields[] = {
      offsetof(SporeDeviceState, position),     offsetof(SporeDeviceState, position) + 16,
      offsetof(SporeDeviceState, orientation),  offsetof(SporeDeviceState, orientation) + 24,
      offsetof(SporeDeviceState, velocity) + 8, offsetof(SporeDeviceState, spin),
      offsetof(SporeDeviceState, grip_rad)};
  guint64 count = 0;
  for (size_t f = 0; f < G_N_ELEMENTS(fields); f++)
    for (size_t k = 0; k < G_N_ELEMENTS(odd); k++) {
      SporeDeviceState bad = at(1.001, 2, 3);
      memcpy((char *)&bad + fields[f], &odd[k], sizeof odd[k]);
      count++;
      g_assert_false(spore_guard_input(&guard, &limits, (double)count * 1e-3, &bad, &taken));
      g_assert_cmpmem(taken.position, 24, good.position, 24);
      g_assert_cmpfloat(taken.velocity[0], ==, 0);
      g_assert_cmpuint(guard.refused, ==, count);
    }
  SporeDeviceState no_turn = good;
  no_turn.orientation[0] = 0;
  g_assert_false(spore_guard_input(&guard, &limits, 1, &no_turn, &taken));
  g_assert_cmpfloat(taken.orientation[0], ==, 1);
}

static void test_nothing_sound(void) {
  SporeGuard guard = {0};
  SporeDeviceState bad = at(NAN, 0, 0), taken;
  g_assert_true(spore_guard_input(&guard, &limits, 0, NULL, &taken));
  g_assert_false(spore_guard_input(&guard, &limits, 0, &bad, &taken));
  g_assert_false(guard.started);
  g_assert_cmpfloat(taken.orientation[0], ==, 1);
}

/* Case 20: a jump of 1 m is followed at the limit, straight, and ends where it should. */
static void test_jump(void) {
  SporeGuard guard = {0};
  SporeDeviceState start = at(0, 0, 0), end = at(0.6, 0.8, 0), taken;
  spore_guard_input(&guard, &limits, 0, &start, &taken);
  int steps = 0;
  double before = 0;
  while (++steps < 2000) {
    bool whole = spore_guard_input(&guard, &limits, steps * 1e-3, steps == 1 ? &end : NULL, &taken);
    double way = hypot(taken.position[0], taken.position[1]);
    double speed = hypot(taken.velocity[0], taken.velocity[1]);
    g_assert_cmpfloat(way - before, <=, limits.speed * 1e-3 * (1 + 1e-9));
    g_assert_cmpfloat(speed, <=, limits.speed * (1 + 1e-9));
    g_assert_cmpfloat(fabs(taken.position[0] * 0.8 - taken.position[1] * 0.6), <, 1e-12);
    before = way;
    if (whole) break;
  }
  g_assert_cmpint(steps, >=, 500);
  g_assert_cmpint(steps, <=, 501);
  g_assert_cmpmem(taken.position, 24, end.position, 24);
  g_assert_cmpuint(guard.limited, ==, (guint64)steps - 1);
  SporeDeviceState absurd = at(1e308, -1e308, 1e308);
  g_assert_false(spore_guard_input(&guard, &limits, 3, &absurd, &taken));
  g_assert_true(isfinite(taken.position[0]));
  g_assert_cmpfloat(fabs(taken.position[0]), <, 10);
}

static void test_turn(void) {
  SporeGuard guard = {0};
  SporeDeviceState start = at(0, 0, 0), turned = start, taken;
  spore_quat_store(turned.orientation, spore_quat_from_rotation_vector((SporeVec3){0, 1, 0}));
  spore_guard_input(&guard, &limits, 0, &start, &taken);
  g_assert_false(spore_guard_input(&guard, &limits, 0.01, &turned, &taken));
  g_assert_cmpfloat(fabs(taken.spin[1] - limits.spin), <, 1e-9);
  for (int i = 2; i <= 9; i++) g_assert_false(spore_guard_input(&guard, &limits, 0.01 * i, &turned, &taken));
  spore_guard_input(&guard, &limits, 0.11, &turned, &taken);
  g_assert_cmpmem(taken.orientation, 32, turned.orientation, 32);
}

static void test_start(void) {
  SporeGuard guard = {0};
  SporeDeviceState said = at(1, 0, 0), taken;
  spore_guard_start(&guard, 0, (SporePose){{0, 0, 0}, {2, 0, 0, 0}});
  g_assert_false(spore_guard_input(&guard, &limits, 1e-3, &said, &taken));
  g_assert_cmpfloat(fabs(taken.position[0] - 2e-3), <, 1e-15);
  g_assert_cmpfloat(taken.orientation[0], ==, 1);
}

/* A guard is a value: a step taken again from a copy comes out the same. Time that stands still moves nothing. */
static void test_again(void) {
  SporeGuard guard = {0};
  SporeDeviceState start = at(0, 0, 0), end = at(1, 0, 0), first, second;
  spore_guard_input(&guard, &limits, 0, &start, &first);
  SporeGuard copy = guard;
  spore_guard_input(&guard, &limits, 1e-3, &end, &first);
  spore_guard_input(&copy, &limits, 1e-3, &end, &second);
  g_assert_cmpmem(&first, sizeof first, &second, sizeof second);
  spore_guard_input(&guard, &limits, 1e-3, &end, &second);
  g_assert_cmpmem(first.position, 24, second.position, 24);
  g_assert_true(isfinite(second.velocity[0]));
}

/* What was taken, recorded and played back, is taken again bit for bit. */
static void test_replay(void) {
  enum { STEPS = 400 };
  GRand *random = g_rand_new_with_seed(4);
  SporeTrack track = {0};
  SporeTrackChannel *channel = spore_track_add_channel(&track, "a");
  SporeDeviceState recorded[STEPS], said = at(0, 0, 0);
  SporeGuard guard = {0};
  for (int i = 0; i < STEPS; i++) {
    for (int k = 0; k < 3; k++) said.position[k] += g_rand_double_range(random, -3e-3, 3e-3);
    SporeVec3 turn = {g_rand_double_range(random, -0.02, 0.02), 0.001, g_rand_double_range(random, -0.02, 0.02)};
    SporeQuat q = spore_quat_multiply(spore_quat_from_rotation_vector(turn), spore_quat_load(said.orientation));
    spore_quat_store(said.orientation, q);
    spore_guard_input(&guard, &limits, i * 1e-3, i % 3 ? NULL : &said, &recorded[i]);
    g_assert_true(spore_track_append(channel, i * 1e-3, &recorded[i]));
  }
  g_rand_free(random);
  g_assert_cmpuint(guard.limited, >, 0);
  size_t size;
  SporeTrack again = {0};
  SporeError error = SPORE_ERROR_INIT;
  char *text = spore_track_format(&track, &size);
  g_assert_true(spore_track_parse(&again, "x", text, size, &error));
  SporeDevice *device = spore_track_device_create(&again.channels[0]);
  SporeGuard second = {0};
  guint differing = 0;
  for (int i = 0; i < STEPS; i++) {
    SporeDeviceState played, taken;
    g_assert_true(device->type->exchange(device, i * 1e-3, NULL, &played));
    spore_guard_input(&second, &limits, i * 1e-3, &played, &taken);
    differing += memcmp(taken.position, recorded[i].position, 24) ||
                 memcmp(taken.orientation, recorded[i].orientation, 32) ||
                 memcmp(taken.velocity, recorded[i].velocity, 24) || memcmp(taken.spin, recorded[i].spin, 24);
  }
  g_assert_cmpuint(differing, ==, 0);
  device->type->close(device);
  spore_free(text);
  spore_track_clear(&track);
  spore_track_clear(&again);
}

static void test_command(void) {
  SporeDeviceCommand command = {{3, 0, 4}, {0, 0.1, 0}, -2};
  g_assert_true(spore_guard_command(&limits, &command));
  g_assert_cmpfloat(command.force[2], ==, 4);
  command = (SporeDeviceCommand){{30, 0, 40}, {0, 10, 0}, -20};
  g_assert_false(spore_guard_command(&limits, &command));
  g_assert_cmpfloat(fabs(command.force[0] - 3), <, 1e-12);
  g_assert_cmpfloat(fabs(command.force[2] - 4), <, 1e-12);
  g_assert_cmpfloat(fabs(command.torque[1] - 0.5), <, 1e-12);
  g_assert_cmpfloat(command.grip_N, ==, -5);
  command = (SporeDeviceCommand){{1e308, 1e308, 1e308}, {0}, 0};
  g_assert_false(spore_guard_command(&limits, &command));
  g_assert_cmpfloat(fabs(spore_vec3_length(spore_vec3_load(command.force)) - 5), <, 1e-12);
  command = (SporeDeviceCommand){{1, NAN, 0}, {0.1, 0, 0}, 1};
  g_assert_false(spore_guard_command(&limits, &command));
  g_assert_cmpfloat(command.force[0], ==, 0);
  g_assert_cmpfloat(command.torque[0], ==, 0);
}

static bool ask(SporeDevice *device, double time_s, SporeDeviceState *state) {
  SporeDeviceCommand command = {.force = {time_s, 0, 0}};
  return device->type->exchange(device, time_s, &command, state);
}

static void test_pointer(void) {
  SporeDevice *device = spore_pointer_device_create();
  g_assert_cmpstr(device->type->name, ==, "pointer");
  SporeDeviceState state, target = at(1, 0, 0);
  g_assert_false(ask(device, 0, &state));
  spore_pointer_device_set(device, &target);
  g_assert_true(ask(device, 0.001, &state)); /* the first time it is there at once */
  g_assert_cmpfloat(state.position[0], ==, 1);
  g_assert_cmpfloat(state.velocity[0], ==, 0);
  target.position[0] = 2;
  target.buttons = 1;
  spore_pointer_device_set(device, &target);
  double before = 1;
  for (int i = 2; i < 200; i++) { /* then it glides, and its velocity is that of the glide */
    g_assert_true(ask(device, i * 1e-3, &state));
    g_assert_cmpfloat(state.position[0], >=, before);
    g_assert_cmpfloat(state.position[0], <=, 2);
    g_assert_cmpfloat(fabs(state.velocity[0] - (state.position[0] - before) / 1e-3), <, 1e-9);
    g_assert_cmpuint(state.buttons, ==, 1);
    before = state.position[0];
    if (i == 13) g_assert_cmpfloat(fabs(2 - before - exp(-0.012 / SPORE_POINTER_GLIDE_S)), <, 1e-9);
  }
  g_assert_cmpfloat(2 - before, <, 1e-6);
  spore_pointer_device_release(device);
  g_assert_false(ask(device, 0, &state));
  device->type->close(device);
  spore_pointer_device_set(NULL, &target);
  spore_pointer_device_release(NULL);
  spore_allocation_fail_at(1);
  g_assert_null(spore_pointer_device_create());
}

/* Asked again for the same step, whole or in halves, it says the same; after a reset it begins anew. */
static void test_pointer_again(void) {
  SporeDevice *device = spore_pointer_device_create();
  SporeDeviceState target = at(0, 0, 0), first, again;
  spore_pointer_device_set(device, &target);
  ask(device, 0.010, &first);
  target.position[0] = 1;
  spore_pointer_device_set(device, &target);
  ask(device, 0.020, &first);
  ask(device, 0.020, &again);
  g_assert_cmpmem(&first, sizeof first, &again, sizeof again);
  ask(device, 0.015, &again);
  g_assert_cmpfloat(again.position[0], <, first.position[0]);
  ask(device, 0.020, &again);
  g_assert_cmpfloat(fabs(again.position[0] - first.position[0]), <, 1e-12);
  ask(device, 0, &again);
  g_assert_cmpfloat(again.position[0], ==, 1);
  g_assert_cmpfloat(again.velocity[0], ==, 0);
  device->type->close(device);
}

static gint writing;

static void *move_pointer(void *data) {
  for (int i = 1; i <= 100000; i++) {
    double x = i * 1e-5;
    SporeDeviceState state = {.position = {x, x, x}, .orientation = {1, 0, 0, 0}, .grip_rad = x};
    spore_pointer_device_set(data, &state);
  }
  g_atomic_int_set(&writing, 0);
  return NULL;
}

/* Never a state that is half old and half new. */
static void test_pointer_threads(void) {
  SporeDevice *device = spore_pointer_device_create();
  pthread_t writer;
  writing = 1;
  g_assert_cmpint(pthread_create(&writer, NULL, move_pointer, device), ==, 0);
  SporeDeviceState state;
  double time_s = 0;
  for (int i = 0; g_atomic_int_get(&writing) || i < 1000; i++) {
    time_s += 1;
    if (!ask(device, time_s, &state)) continue;
    g_assert_cmpfloat(state.position[0], ==, state.position[1]);
    g_assert_cmpfloat(state.position[0], ==, state.position[2]);
    g_assert_cmpfloat(state.position[0], ==, state.grip_rad);
  }
  pthread_join(writer, NULL);
  g_assert_true(ask(device, time_s + 1, &state));
  g_assert_cmpfloat(fabs(state.position[0] - 1), <, 1e-12);
  device->type->close(device);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/guard/passes", test_passes);
  g_test_add_func("/guard/not-finite", test_not_finite);
  g_test_add_func("/guard/nothing-sound", test_nothing_sound);
  g_test_add_func("/guard/jump", test_jump);
  g_test_add_func("/guard/turn", test_turn);
  g_test_add_func("/guard/start", test_start);
  g_test_add_func("/guard/again", test_again);
  g_test_add_func("/guard/replay", test_replay);
  g_test_add_func("/guard/command", test_command);
  g_test_add_func("/pointer/glides", test_pointer);
  g_test_add_func("/pointer/again", test_pointer_again);
  g_test_add_func("/pointer/threads", test_pointer_threads);
  return g_test_run();
}
