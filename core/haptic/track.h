/* Recorded device input (.track): text, one row a sample, so that a run can be repeated anywhere.
 * Header line `spore-track 1`, then a line `device NAME` before the rows of each channel (NAME: the active body
 * driven). A row: t_s x y z qw qx qy qz grip buttons; `#` starts a comment. */
#ifndef SPORE_HAPTIC_TRACK_H
#define SPORE_HAPTIC_TRACK_H

#include <stddef.h>

#include "core/haptic/device.h"

/* What was recorded of one active body. */
typedef struct SporeTrackChannel {
  char *name; /* of the active body */
  size_t count, capacity;
  double *time_s;           /* count, strictly increasing */
  SporeDeviceState *states; /* count */
} SporeTrackChannel;

/* A recording. All zero is an empty one. */
typedef struct SporeTrack {
  size_t channel_count;
  SporeTrackChannel *channels;
} SporeTrack;

/* From text already in memory (`place` names it in messages). Refuses non-finite numbers, times out of order,
 * duplicate channels, orientations that are not of unit length (to 1e-3), more than 10 million rows; place is
 * "PLACE:LINE:COLUMN" and *track untouched then. */
bool spore_track_parse(SporeTrack *track, const char *place, const char *text, size_t size, SporeError *error);
/* Frees what the track holds and zeroes it. */
void spore_track_clear(SporeTrack *track);
/* The channel of that name; NULL: there is none. Owned by the track. */
SporeTrackChannel *spore_track_channel(const SporeTrack *track, const char *name);
/* When its last row is, s; 0: there is none, or no track (NULL). */
double spore_track_end_s(const SporeTrack *track);
/* For recording: adds a channel, owned by the track. Pointers to channels hold only until the next one is added. NULL:
 * no memory, not a name, or there already. Allocates: never inside a step. */
SporeTrackChannel *spore_track_add_channel(SporeTrack *track, const char *name);
/* Appends a sample. False: its time is not after the last one and within 0..1e9 s, it is not finite, or there is no
 * memory. May allocate: never inside a step. */
bool spore_track_append(SporeTrackChannel *channel, double time_s, const SporeDeviceState *state);
/* Text of the whole track, from spore_allocate; numbers round-trip exactly. NULL: no memory. */
char *spore_track_format(const SporeTrack *track, size_t *size);

/* A device that plays a channel: linear in position, shortest arc in orientation, velocities by difference, held
 * at both ends. Borrows the channel. NULL: no memory. */
SporeDevice *spore_track_device_create(const SporeTrackChannel *channel);

#endif
