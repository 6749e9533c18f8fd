/* A device that plays a recorded track. */
#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/haptic/motion.h"
#include "core/haptic/track.h"

typedef struct TrackDevice {
  SporeDevice device;
  const SporeTrackChannel *channel;
  size_t cursor; /* last sample at or before the time asked for */
} TrackDevice;

/* Moves the cursor: forward step by step, since time usually advances by little; backward by bisection. */
static void seek(TrackDevice *player, double time_s) {
  const double *times = player->channel->time_s;
  size_t last = player->channel->count - 1;
  if (times[player->cursor] > time_s) {
    size_t low = 0, high = player->cursor;
    while (high - low > 1) {
      size_t middle = low + (high - low) / 2;
      if (times[middle] > time_s) high = middle;
      else low = middle;
    }
    player->cursor = low;
  }
  while (player->cursor < last && times[player->cursor + 1] <= time_s) player->cursor++;
}

static bool track_exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command,
                           SporeDeviceState *state) {
  TrackDevice *player = (TrackDevice *)device;
  const SporeTrackChannel *channel = player->channel;
  if (channel->count == 0) return false;
  seek(player, time_s);
  const SporeDeviceState *from = &channel->states[player->cursor];
  double start_s = channel->time_s[player->cursor];
  if (time_s < start_s || player->cursor + 1 == channel->count) {
    *state = spore_motion_between(from, from, 1);
  } else {
    double interval_s = channel->time_s[player->cursor + 1] - start_s;
    *state = spore_motion_between(from, from + 1, (time_s - start_s) / interval_s);
    SporeDeviceState whole = from[1];
    spore_motion_set_velocity(&whole, from, interval_s);
    spore_vec3_store(state->velocity, spore_vec3_load(whole.velocity));
    spore_vec3_store(state->spin, spore_vec3_load(whole.spin));
  }
  state->t_ns = (uint64_t)(fmax(time_s, 0) * 1e9);
  return true;
}

static void track_close(SporeDevice *device) { spore_free(device); }

static const SporeDeviceType track_type = {"track", N_("Plays recorded input"), track_exchange, track_close};

SporeDevice *spore_track_device_create(const SporeTrackChannel *channel) {
  TrackDevice *player = SPORE_NEW(TrackDevice);
  if (!player) return NULL;
  player->device.type = &track_type;
  player->channel = channel;
  return &player->device;
}
