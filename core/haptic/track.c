/* Reading, recording and writing tracks of device input. */
#include "core/haptic/track.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/name.h"
#include "core/base/number.h"
#include "core/base/text.h"

#define MAXIMUM_ROWS 10000000u
#define COLUMNS 10 /* t_s x y z qw qx qy qz grip buttons */
#define LONGEST_TIME 1e9

/* Channels. */

void spore_track_clear(SporeTrack *track) {
  for (size_t i = 0; i < track->channel_count; i++) {
    spore_free(track->channels[i].name);
    spore_free(track->channels[i].time_s);
    spore_free(track->channels[i].states);
  }
  spore_free(track->channels);
  *track = (SporeTrack){0};
}

SporeTrackChannel *spore_track_channel(const SporeTrack *track, const char *name) {
  for (size_t i = 0; i < track->channel_count; i++)
    if (strcmp(track->channels[i].name, name) == 0) return &track->channels[i];
  return NULL;
}

SporeTrackChannel *spore_track_add_channel(SporeTrack *track, const char *name) {
  if (!spore_name_is_valid(name) || spore_track_channel(track, name)) return NULL;
  char *copy = SPORE_NEW_ARRAY(char, strlen(name) + 1);
  SporeTrackChannel *channels =
      copy ? spore_reallocate(track->channels, track->channel_count, track->channel_count + 1, sizeof *channels) : NULL;
  if (!channels) {
    spore_free(copy);
    return NULL;
  }
  strcpy(copy, name);
  track->channels = channels;
  channels[track->channel_count].name = copy;
  return &channels[track->channel_count++];
}

static bool make_room(SporeTrackChannel *channel) {
  if (channel->count < channel->capacity) return true;
  size_t capacity = channel->capacity ? 2 * channel->capacity : 256;
  double *times = spore_reallocate(channel->time_s, channel->count, capacity, sizeof *times);
  if (!times) return false;
  channel->time_s = times;
  SporeDeviceState *states = spore_reallocate(channel->states, channel->count, capacity, sizeof *states);
  if (!states) return false;
  channel->states = states;
  channel->capacity = capacity;
  return true;
}

static bool is_time(double time_s) { return time_s >= 0 && time_s <= LONGEST_TIME; }

static bool is_finite_state(const SporeDeviceState *state) {
  double sum = state->grip_rad;
  for (int i = 0; i < 3; i++) sum += 0 * state->position[i];
  for (int i = 0; i < 4; i++) sum += 0 * state->orientation[i];
  return isfinite(sum);
}

bool spore_track_append(SporeTrackChannel *channel, double time_s, const SporeDeviceState *state) {
  if (!is_time(time_s) || !is_finite_state(state)) return false;
  if (channel->count > 0 && time_s <= channel->time_s[channel->count - 1]) return false;
  if (channel->count >= MAXIMUM_ROWS || !make_room(channel)) return false;
  channel->time_s[channel->count] = time_s;
  channel->states[channel->count++] = *state;
  return true;
}

double spore_track_end_s(const SporeTrack *track) {
  double end_s = 0;
  for (size_t i = 0; track && i < track->channel_count; i++) {
    const SporeTrackChannel *channel = &track->channels[i];
    if (channel->count > 0) end_s = fmax(end_s, channel->time_s[channel->count - 1]);
  }
  return end_s;
}

/* Reading. */

typedef struct Reader {
  const char *place, *line, *next, *end; /* line: start of the present one, without comment up to `stop` */
  const char *stop;
  size_t line_number, rows;
  SporeTrack track;
  SporeTrackChannel *channel;
  SporeError *error;
} Reader;

/* Always false: "PLACE:LINE:COLUMN". */
static bool refuse(Reader *reader, const char *at, const char *message) {
  char place[sizeof reader->error->place];
  snprintf(place, sizeof place, "%.200s:%zu:%zu", reader->place, reader->line_number, (size_t)(at - reader->line) + 1);
  return spore_error_set(reader->error, SPORE_ERROR_INPUT, place, "%s", message);
}

static bool refuse_memory(Reader *reader) {
  return spore_error_set(reader->error, SPORE_ERROR_MEMORY, reader->place, "%s",
                         _("not enough memory for the track; use a shorter one"));
}

static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

static const char *skip_blanks(const char *at, const char *stop) {
  while (at < stop && is_blank(*at)) at++;
  return at;
}

/* Goes to the next line that holds something; false at the end of the text. */
static bool next_line(Reader *reader) {
  while (reader->next < reader->end) {
    size_t left = (size_t)(reader->end - reader->next);
    const char *newline = memchr(reader->next, '\n', left);
    reader->line = reader->next;
    reader->stop = newline ? newline : reader->end;
    reader->next = newline ? newline + 1 : reader->end;
    reader->line_number++;
    const char *comment = memchr(reader->line, '#', (size_t)(reader->stop - reader->line));
    if (comment) reader->stop = comment;
    while (reader->stop > reader->line && is_blank(reader->stop[-1])) reader->stop--;
    if (skip_blanks(reader->line, reader->stop) < reader->stop) return true;
  }
  return false;
}

/* Whether the present line starts with that word; *after: what follows it. */
static bool starts_with(const Reader *reader, const char *word, const char **after) {
  const char *at = skip_blanks(reader->line, reader->stop);
  size_t length = strlen(word);
  if ((size_t)(reader->stop - at) < length || memcmp(at, word, length) != 0) return false;
  if (at + length < reader->stop && !is_blank(at[length])) return false;
  *after = skip_blanks(at + length, reader->stop);
  return true;
}

static bool read_header(Reader *reader) {
  const char *version;
  if (!next_line(reader)) {
    reader->line = reader->stop = reader->end;
    reader->line_number++;
    return refuse(reader, reader->line,
                  _("the track is empty; expected a first line \"spore-track 1\"; record it again"));
  }
  if (!starts_with(reader, "spore-track", &version))
    return refuse(reader, reader->line,
                  _("this is not a track; expected a first line \"spore-track 1\"; choose a recorded .track file"));
  if (reader->stop - version != 1 || *version != '1')
    return refuse(reader, version,
                  _("this version of the track is not known; expected \"spore-track 1\"; use a newer SPORE"));
  return true;
}

static bool read_device(Reader *reader, const char *name) {
  char text[128];
  size_t length = (size_t)(reader->stop - name);
  if (length >= sizeof text)
    return refuse(reader, name, _("the name is too long; expected at most 127 characters; shorten it"));
  memcpy(text, name, length);
  text[length] = '\0';
  if (strlen(text) != length || !spore_name_is_valid(text))
    return refuse(reader, name,
                  _("this is not a name; expected \"device NAME\" with the name of an active body; correct it"));
  if (spore_track_channel(&reader->track, text))
    return refuse(reader, name, _("this device came before; expected each only once; put its rows together"));
  reader->channel = spore_track_add_channel(&reader->track, text);
  return reader->channel ? true : refuse_memory(reader);
}

static bool read_numbers(Reader *reader, double numbers[COLUMNS], const char *starts[COLUMNS]) {
  const char *at = skip_blanks(reader->line, reader->stop);
  for (int i = 0; i < COLUMNS; i++) {
    if (at == reader->stop)
      return refuse(reader, at,
                    _("the row is too short; expected ten numbers: t x y z qw qx qy qz grip buttons; complete it"));
    size_t length = spore_number_read(at, (size_t)(reader->stop - at), &numbers[i]);
    starts[i] = at;
    at += length;
    if (length == 0 || (at < reader->stop && !is_blank(*at)))
      return refuse(reader, starts[i], _("this is not a number; expected a decimal number; correct it"));
    if (!isfinite(numbers[i]))
      return refuse(reader, starts[i], _("this number is too large; expected a finite one; correct it"));
    at = skip_blanks(at, reader->stop);
  }
  if (at < reader->stop)
    return refuse(reader, at, _("the row is too long; expected ten numbers; remove what follows them"));
  return true;
}

static bool read_row(Reader *reader) {
  double n[COLUMNS];
  const char *starts[COLUMNS];
  if (!reader->channel)
    return refuse(reader, reader->line, _("a row belongs to no device; expected a line \"device NAME\" first; add it"));
  if (!read_numbers(reader, n, starts)) return false;
  if (++reader->rows > MAXIMUM_ROWS)
    return refuse(reader, starts[0], _("the track has too many rows; expected at most 10 million; split it"));
  if (!is_time(n[0])) return refuse(reader, starts[0], _("the time is out of range; expected 0 to 1e9 s; correct it"));
  SporeTrackChannel *channel = reader->channel;
  if (channel->count > 0 && n[0] <= channel->time_s[channel->count - 1])
    return refuse(reader, starts[0], _("the time does not increase; expected a later one than in the row above; sort"));
  if (fabs(n[4] * n[4] + n[5] * n[5] + n[6] * n[6] + n[7] * n[7] - 1) > 1e-3)
    return refuse(reader, starts[4],
                  _("the orientation is not of unit length; expected a unit quaternion w x y z; normalise it"));
  if (!(n[9] >= 0 && n[9] <= UINT32_MAX && n[9] == floor(n[9])))
    return refuse(reader, starts[9],
                  _("the buttons are not a bit mask; expected an integer from 0 to 4294967295; "
                    "correct it"));
  SporeDeviceState state = {
      .t_ns = (uint64_t)(n[0] * 1e9),
      .position = {n[1], n[2], n[3]},
      .orientation = {n[4], n[5], n[6], n[7]},
      .grip_rad = n[8],
      .buttons = (uint32_t)n[9],
  };
  return spore_track_append(channel, n[0], &state) ? true : refuse_memory(reader);
}

bool spore_track_parse(SporeTrack *track, const char *place, const char *text, size_t size, SporeError *error) {
  SporeError unused;
  Reader reader = {.place = place, .line = text, .next = text, .end = text + size, .error = error ? error : &unused};
  bool good = read_header(&reader);
  while (good && next_line(&reader)) {
    const char *name;
    good = starts_with(&reader, "device", &name) ? read_device(&reader, name) : read_row(&reader);
  }
  if (good) *track = reader.track;
  else spore_track_clear(&reader.track);
  return good;
}

/* Writing. */

typedef struct Writer {
  char *text;
  size_t size, capacity;
  bool failed;
} Writer;

static void write_text(Writer *writer, const char *text, size_t length) {
  if (writer->size + length + 1 > writer->capacity) {
    size_t capacity = 2 * (writer->size + length + 1);
    char *grown = writer->failed ? NULL : spore_reallocate(writer->text, writer->size, capacity, 1);
    if (!grown) {
      writer->failed = true;
      return;
    }
    writer->text = grown;
    writer->capacity = capacity;
  }
  memcpy(writer->text + writer->size, text, length);
  writer->size += length;
}

static void write_row(Writer *writer, double time_s, const SporeDeviceState *state) {
  const double numbers[COLUMNS] = {
      time_s,
      state->position[0],
      state->position[1],
      state->position[2],
      state->orientation[0],
      state->orientation[1],
      state->orientation[2],
      state->orientation[3],
      state->grip_rad,
      state->buttons,
  };
  for (int i = 0; i < COLUMNS; i++) {
    char text[SPORE_NUMBER_TEXT + 1];
    int length = spore_number_format(numbers[i], text);
    text[length++] = i + 1 < COLUMNS ? ' ' : '\n';
    write_text(writer, text, (size_t)length);
  }
}

char *spore_track_format(const SporeTrack *track, size_t *size) {
  Writer writer = {0};
  write_text(&writer, "spore-track 1\n", 14);
  for (size_t i = 0; i < track->channel_count; i++) {
    const SporeTrackChannel *channel = &track->channels[i];
    write_text(&writer, "device ", 7);
    write_text(&writer, channel->name, strlen(channel->name));
    write_text(&writer, "\n", 1);
    for (size_t k = 0; k < channel->count; k++) write_row(&writer, channel->time_s[k], &channel->states[k]);
  }
  if (writer.failed) {
    spore_free(writer.text);
    return NULL;
  }
  writer.text[writer.size] = '\0';
  if (size) *size = writer.size;
  return writer.text;
}
