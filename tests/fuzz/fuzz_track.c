/* Tracks of recorded input: read, or refused; what is read and written is read again to the same bits. */
#include <glib.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/haptic/track.h"
#include "fuzz.h"

const unsigned fuzz_rounds = 50000;
const char *const fuzz_words[] = {
    "spore-track 1\n", "device a\n", "device ", "# ", "\n",   "nan", "inf", "1e999", "-1", "0 ",
    "4294967296",      "1e-320",     "+",       ".",  "\r\n", "\t",  NULL};

int LLVMFuzzerTestOneInput(const uint8_t *content, size_t size) {
  SporeTrack track = {0}, again = {0};
  SporeError error = SPORE_ERROR_INIT;
  if (!spore_track_parse(&track, "fuzz.track", (const char *)content, size, &error)) {
    g_assert_true(g_str_has_prefix(error.place, "fuzz.track"));
    g_assert_cmpuint(strlen(error.message), >, 0);
    g_assert_cmpuint(track.channel_count, ==, 0);
    return 0;
  }
  size_t length;
  char *text = spore_track_format(&track, &length);
  g_assert_nonnull(text);
  bool read = spore_track_parse(&again, "again.track", text, length, &error);
  if (!read) g_error("%s: %s", error.place, error.message);
  g_assert_cmpuint(again.channel_count, ==, track.channel_count);
  for (size_t i = 0; i < track.channel_count; i++) {
    const SporeTrackChannel *one = &track.channels[i], *other = &again.channels[i];
    g_assert_cmpstr(one->name, ==, other->name);
    g_assert_cmpmem(one->time_s, one->count * sizeof(double), other->time_s, other->count * sizeof(double));
    SporeDevice *device = spore_track_device_create(one);
    SporeDeviceCommand command = {{0}};
    SporeDeviceState state;
    for (double t = -1; t < 3; t += 0.37) device->type->exchange(device, t, &command, &state);
    device->type->close(device);
  }
  spore_free(text);
  spore_track_clear(&track);
  spore_track_clear(&again);
  return 0;
}
