/* Recorded input: reading, writing, playing. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/haptic/track.h"

static gboolean parse(SporeTrack *track, const char *text, SporeError *error) {
  *error = SPORE_ERROR_INIT;
  return spore_track_parse(track, "test.track", text, strlen(text), error);
}

static void test_read(void) {
  SporeTrack track = {0};
  SporeError error;
  const char *text = "# recorded\r\n\r\nspore-track 1 # version\r\n"
                     "device probe\r\n"
                     "0 1 2 3 1 0 0 0 0.5 3\r\n"
                     "\t0.001 1e-3 -2 +.5 0 1 0 0 0 4294967295 # pressed\r\n"
                     "device scissors\n"
                     "device camera\n"
                     "5 0 0 0 0.6 0 0.8 0 0 0";
  if (!parse(&track, text, &error)) g_error("%s: %s", error.place, error.message);
  g_assert_cmpuint(track.channel_count, ==, 3);
  const SporeTrackChannel *probe = spore_track_channel(&track, "probe");
  g_assert_cmpuint(probe->count, ==, 2);
  g_assert_cmpfloat(probe->time_s[1], ==, 0.001);
  g_assert_cmpfloat(probe->states[0].position[2], ==, 3);
  g_assert_cmpfloat(probe->states[0].grip_rad, ==, 0.5);
  g_assert_cmpfloat(probe->states[1].position[0], ==, 1e-3);
  g_assert_cmpuint(probe->states[1].buttons, ==, UINT32_MAX);
  g_assert_cmpuint(spore_track_channel(&track, "scissors")->count, ==, 0);
  g_assert_cmpfloat(spore_track_channel(&track, "camera")->states[0].orientation[2], ==, 0.8);
  g_assert_null(spore_track_channel(&track, "none"));
  spore_track_clear(&track);
  g_assert_cmpuint(track.channel_count, ==, 0);
}

static void test_round_trip(void) {
  GRand *random = g_rand_new_with_seed(2);
  SporeTrack track = {0}, again = {0};
  static const char *const names[] = {"a", "b-2", "c"};
  for (int c = 0; c < 3; c++) {
    SporeTrackChannel *channel = spore_track_add_channel(&track, names[c]);
    for (int i = 0; i < 700 * c; i++) {
      SporeDeviceState state = {
          .orientation = {1, 0, 0, 0}, .grip_rad = g_rand_double(random), .buttons = g_rand_int(random)};
      for (int k = 0; k < 3; k++)
        state.position[k] = g_rand_double_range(random, -1, 1) * pow(10, g_rand_int_range(random, -300, 300));
      g_assert_true(spore_track_append(channel, i * 0.001 + 1e-9 * g_rand_double(random), &state));
    }
  }
  g_rand_free(random);
  size_t size, again_size;
  char *text = spore_track_format(&track, &size);
  SporeError error = SPORE_ERROR_INIT;
  g_assert_true(spore_track_parse(&again, "x", text, size, &error));
  g_assert_cmpuint(again.channel_count, ==, 3);
  for (int c = 0; c < 3; c++) {
    const SporeTrackChannel *written = &track.channels[c], *read = &again.channels[c];
    g_assert_cmpstr(read->name, ==, names[c]);
    g_assert_cmpuint(read->count, ==, written->count);
    for (size_t i = 0; i < read->count; i++) {
      g_assert_cmpfloat(read->time_s[i], ==, written->time_s[i]);
      g_assert_cmpmem(read->states[i].position, 24, written->states[i].position, 24);
      g_assert_cmpfloat(read->states[i].grip_rad, ==, written->states[i].grip_rad);
      g_assert_cmpuint(read->states[i].buttons, ==, written->states[i].buttons);
    }
  }
  char *text_again = spore_track_format(&again, &again_size);
  g_assert_cmpstr(text_again, ==, text);
  g_assert_cmpuint(again_size, ==, size);
  spore_free(text);
  spore_free(text_again);
  spore_track_clear(&track);
  spore_track_clear(&again);
}

#define HEAD "spore-track 1\ndevice a\n"

static void test_bad_input(void) {
  static const struct {
    const char *text, *place, *message;
  } cases[] = {
      {"", "test.track:1:1", "is empty"},
      {"# nothing\n\n", "test.track:3:1", "is empty"},
      {"solid liver\n", "test.track:1:1", "not a track"},
      {"spore-tracks 1\n", "test.track:1:1", "not a track"},
      {"spore-track 2\n", "test.track:1:13", "version"},
      {"spore-track\n", "test.track:1:12", "version"},
      {"spore-track 11\n", "test.track:1:13", "version"},
      {"spore-track 1\n0 0 0 0 1 0 0 0 0 0\n", "test.track:2:1", "no device"},
      {"spore-track 1\ndevice\n", "test.track:2:7", "not a name"},
      {"spore-track 1\ndevice a b\n", "test.track:2:8", "not a name"},
      {"spore-track 1\ndevice 1a\n", "test.track:2:8", "not a name"},
      {HEAD "device b\ndevice a\n", "test.track:4:8", "came before"},
      {HEAD "0 0 0 0 1 0 0 0 0\n", "test.track:3:18", "too short"},
      {HEAD "0 0 0 0 1 0 0 0 0 0 0\n", "test.track:3:21", "too long"},
      {HEAD "0 0 x 0 1 0 0 0 0 0\n", "test.track:3:5", "not a number"},
      {HEAD "0 0 0,5 0 1 0 0 0 0 0\n", "test.track:3:5", "not a number"},
      {HEAD "0 0 nan 0 1 0 0 0 0 0\n", "test.track:3:5", "not a number"},
      {HEAD "0 0 inf 0 1 0 0 0 0 0\n", "test.track:3:5", "not a number"},
      {HEAD "0 0 1e999 0 1 0 0 0 0 0\n", "test.track:3:5", "too large"},
      {HEAD "-1 0 0 0 1 0 0 0 0 0\n", "test.track:3:1", "time is out of range"},
      {HEAD "2e9 0 0 0 1 0 0 0 0 0\n", "test.track:3:1", "time is out of range"},
      {HEAD "1 0 0 0 1 0 0 0 0 0\n# a\n 1 0 0 0 1 0 0 0 0 0\n", "test.track:5:2", "does not increase"},
      {HEAD "0 0 0 0 0 0 0 0 0 0\n", "test.track:3:9", "unit length"},
      {HEAD "0 0 0 0 1 1 0 0 0 0\n", "test.track:3:9", "unit length"},
      {HEAD "0 0 0 0 1e300 0 0 0 0 0\n", "test.track:3:9", "unit length"},
      {HEAD "0 0 0 0 1 0 0 0 0 -1\n", "test.track:3:19", "buttons"},
      {HEAD "0 0 0 0 1 0 0 0 0 1.5\n", "test.track:3:19", "buttons"},
      {HEAD "0 0 0 0 1 0 0 0 0 4294967296\n", "test.track:3:19", "buttons"},
  };
  for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
    SporeTrack track = {.channel_count = 77};
    SporeError error;
    g_assert_false(parse(&track, cases[i].text, &error));
    g_assert_cmpuint(track.channel_count, ==, 77);
    g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
    g_assert_cmpstr(error.place, ==, cases[i].place);
    if (!strstr(error.message, cases[i].message)) g_error("\"%s\" lacks \"%s\"", error.message, cases[i].message);
    g_assert_nonnull(strstr(error.message, "; expected"));
    g_assert_false(parse(&track, cases[i].text, &(SporeError){0}));
    g_assert_false(spore_track_parse(&track, "x", cases[i].text, strlen(cases[i].text), NULL));
  }
}

/* Every beginning of a good track, and every byte of it turned into another, is read or refused, never more. */
static void test_mangled(void) {
  const char *text = HEAD "0 1 2 3 1 0 0 0 0.5 3 # c\ndevice b\n1 1 2 3 0 1 0 0 0.5 3\n";
  size_t size = strlen(text);
  for (size_t cut = 0; cut <= size; cut++) {
    char *copy = g_memdup2(text, cut); /* exactly as long as it says: reading past it is an error */
    SporeTrack track = {0};
    SporeError error = SPORE_ERROR_INIT;
    if (spore_track_parse(&track, "x", copy, cut, &error)) spore_track_clear(&track);
    else g_assert_cmpstr(error.place, !=, "");
    g_free(copy);
  }
  static const char bytes[] = {'\0', '\n', '#', '9', '-', (char)0xFF};
  for (size_t at = 0; at < size; at++)
    for (size_t k = 0; k < sizeof bytes; k++) {
      char *copy = g_memdup2(text, size);
      copy[at] = bytes[k];
      SporeTrack track = {0};
      SporeError error = SPORE_ERROR_INIT;
      if (spore_track_parse(&track, "x", copy, size, &error)) spore_track_clear(&track);
      else g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
      g_free(copy);
    }
}

static void test_record(void) {
  SporeTrack track = {0};
  SporeTrackChannel *channel = spore_track_add_channel(&track, "probe");
  g_assert_null(spore_track_add_channel(&track, "probe"));
  g_assert_null(spore_track_add_channel(&track, "no name"));
  SporeDeviceState state = {.orientation = {1, 0, 0, 0}};
  g_assert_true(spore_track_append(channel, 0, &state));
  g_assert_false(spore_track_append(channel, 0, &state));
  g_assert_false(spore_track_append(channel, -1, &state));
  g_assert_false(spore_track_append(channel, NAN, &state));
  state.position[1] = INFINITY;
  g_assert_false(spore_track_append(channel, 1, &state));
  state.position[1] = 0;
  g_assert_true(spore_track_append(channel, 1, &state));
  g_assert_cmpuint(channel->count, ==, 2);
  spore_track_clear(&track);
}

static void test_without_memory(void) {
  for (guint64 n = 1;; n++) {
    SporeTrack track = {0};
    SporeError error = SPORE_ERROR_INIT;
    const char *text = HEAD "0 1 2 3 1 0 0 0 0.5 3\ndevice b\n1 1 2 3 0 1 0 0 0.5 3\n";
    spore_allocation_fail_at(n);
    if (spore_track_parse(&track, "x", text, strlen(text), &error)) {
      spore_allocation_fail_at(1);
      g_assert_null(spore_track_format(&track, NULL));
      spore_allocation_fail_at(1);
      g_assert_null(spore_track_device_create(&track.channels[0]));
      spore_track_clear(&track);
      g_assert_cmpuint(n, ==, 9);
      break;
    }
    g_assert_cmpint(error.code, ==, SPORE_ERROR_MEMORY);
  }
}

static SporeDeviceState play(SporeDevice *device, double time_s) {
  SporeDeviceState state = {0};
  g_assert_true(device->type->exchange(device, time_s, NULL, &state));
  return state;
}

static void test_play(void) {
  SporeTrack track = {0};
  SporeError error;
  const char *text = HEAD "1 0 0 0 1 0 0 0 0 1\n"
                          "2 4 0 0 0.70710678118654757 0.70710678118654757 0 0 1 2\n"
                          "4 4 2 0 -0.70710678118654757 -0.70710678118654757 0 0 1 4\n";
  if (!parse(&track, text, &error)) g_error("%s", error.message);
  SporeDevice *device = spore_track_device_create(&track.channels[0]);
  SporeDeviceState state = play(device, 0);
  g_assert_cmpfloat(state.position[0], ==, 0);
  g_assert_cmpfloat(state.velocity[0], ==, 0);
  g_assert_cmpuint(state.buttons, ==, 1);
  state = play(device, 1.25);
  g_assert_cmpfloat(state.position[0], ==, 1);
  g_assert_cmpfloat(state.velocity[0], ==, 4);
  g_assert_cmpfloat(state.grip_rad, ==, 0.25);
  g_assert_cmpuint(state.buttons, ==, 1);
  g_assert_cmpuint(state.t_ns, ==, 1250000000);
  g_assert_cmpfloat(fabs(state.orientation[1] - sin(G_PI / 16)), <, 1e-15);
  g_assert_cmpfloat(fabs(state.spin[0] - G_PI / 2), <, 1e-14);
  state = play(device, 2); /* at a sample it is that sample, to the last bit */
  g_assert_cmpmem(state.orientation, 32, track.channels[0].states[1].orientation, 32);
  g_assert_cmpfloat(state.position[0], ==, 4);
  g_assert_cmpuint(state.buttons, ==, 2);
  state = play(device, 3); /* the other sign is the same orientation: no turn */
  g_assert_cmpfloat(fabs(fabs(state.orientation[0]) - sqrt(0.5)), <, 1e-15);
  g_assert_cmpfloat(fabs(state.spin[0]), <, 1e-14);
  g_assert_cmpfloat(state.velocity[1], ==, 1);
  state = play(device, 100);
  g_assert_cmpfloat(state.position[1], ==, 2);
  g_assert_cmpfloat(state.velocity[1], ==, 0);
  g_assert_cmpuint(state.buttons, ==, 4);
  state = play(device, 1.5); /* time may go back: a step taken again, a reset */
  g_assert_cmpfloat(state.position[0], ==, 2);
  device->type->close(device);
  spore_track_clear(&track);
}

static void test_play_seeks(void) {
  SporeTrack track = {0};
  SporeTrackChannel *channel = spore_track_add_channel(&track, "a");
  SporeDevice *device = spore_track_device_create(channel);
  SporeDeviceState state = {.orientation = {1, 0, 0, 0}};
  g_assert_false(device->type->exchange(device, 0, NULL, &state));
  for (int i = 0; i < 1000; i++) {
    state.position[0] = i;
    g_assert_true(spore_track_append(channel, i, &state));
  }
  GRand *random = g_rand_new_with_seed(9);
  for (int i = 0; i < 2000; i++) {
    double time_s = g_rand_double_range(random, 0, 999);
    g_assert_cmpfloat(fabs(play(device, time_s).position[0] - time_s), <, 1e-12);
  }
  g_rand_free(random);
  device->type->close(device);
  spore_track_clear(&track);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/track/read", test_read);
  g_test_add_func("/track/round-trip", test_round_trip);
  g_test_add_func("/track/bad-input", test_bad_input);
  g_test_add_func("/track/mangled", test_mangled);
  g_test_add_func("/track/record", test_record);
  g_test_add_func("/track/without-memory", test_without_memory);
  g_test_add_func("/track/play", test_play);
  g_test_add_func("/track/play-seeks", test_play_seeks);
  return g_test_run();
}
