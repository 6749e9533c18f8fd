/* Writes WebM: elements of an id, a size and a content, some of which hold others. The pictures lie in clusters, each
 * of which begins with a picture that needs no other; a table of the clusters stands before them, so that a player
 * finds a moment without reading the file to its end. */
#include "ui/render/webm.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#define LARGEST (G_MAXINT32 - (1 << 20)) /* bytes: a GByteArray doubles in size as it grows, and counts to 4 GB */
#define LONGEST_MS 30000                 /* of a cluster: its blocks count by 16 bits with a sign */
#define SIZE_BYTES 8                     /* of a size or number that is written before it is known */

/* Elements: RFC 8794 (EBML) and RFC 9559 (Matroska). */
enum {
  EBML = 0x1A45DFA3,
  EBML_VERSION = 0x4286,
  EBML_READ_VERSION = 0x42F7,
  EBML_ID_LENGTH = 0x42F2,
  EBML_SIZE_LENGTH = 0x42F3,
  DOC_TYPE = 0x4282,
  DOC_TYPE_VERSION = 0x4287,
  DOC_TYPE_READ_VERSION = 0x4285,
  SEGMENT = 0x18538067,
  INFO = 0x1549A966,
  TIMESTAMP_SCALE = 0x2AD7B1,
  DURATION = 0x4489,
  MUXING_APP = 0x4D80,
  WRITING_APP = 0x5741,
  TRACKS = 0x1654AE6B,
  TRACK_ENTRY = 0xAE,
  TRACK_NUMBER = 0xD7,
  TRACK_UID = 0x73C5,
  TRACK_TYPE = 0x83,
  FLAG_LACING = 0x9C,
  LANGUAGE = 0x22B59C,
  DEFAULT_DURATION = 0x23E383,
  CODEC_ID = 0x86,
  VIDEO = 0xE0,
  FLAG_INTERLACED = 0x9A,
  PIXEL_WIDTH = 0xB0,
  PIXEL_HEIGHT = 0xBA,
  COLOUR = 0x55B0,
  MATRIX_COEFFICIENTS = 0x55B1,
  RANGE = 0x55B9,
  TRANSFER_CHARACTERISTICS = 0x55BA,
  PRIMARIES = 0x55BB,
  CUES = 0x1C53BB6B,
  CUE_POINT = 0xBB,
  CUE_TIME = 0xB3,
  CUE_TRACK_POSITIONS = 0xB7,
  CUE_TRACK = 0xF7,
  CUE_CLUSTER_POSITION = 0xF1,
  CLUSTER = 0x1F43B675,
  TIMESTAMP = 0xE7,
  SIMPLE_BLOCK = 0xA3
};

typedef struct Cue {
  gint64 time_ms;
  guint at; /* of the cluster, among the clusters */
} Cue;

struct SporeWebm {
  int width, height;
  double fps;
  guint64 count;        /* of pictures */
  GByteArray *clusters; /* the last one is open */
  guint open;           /* where its content begins; 0: none is open */
  gint64 open_ms;       /* its time */
  GArray *cues;         /* of Cue: by clusters */
};

/* Elements. */

static void put_number(GByteArray *bytes, guint64 number, int length) {
  guint8 digits[8];
  for (int i = 0; i < length; i++) digits[i] = (guint8)(number >> (8 * (length - 1 - i)));
  g_byte_array_append(bytes, digits, (guint)length);
}

static void put_id(GByteArray *bytes, guint32 id) {
  put_number(bytes, id, id > 0xFFFFFF ? 4 : id > 0xFFFF ? 3 : id > 0xFF ? 2 : 1);
}

/* A size of 8 bytes says so by a 1 in front of it. */
static void put_size(GByteArray *bytes, guint64 size) { put_number(bytes, size | (guint64)1 << 56, SIZE_BYTES); }

/* Begins an element that holds others. Returns where its content begins. */
static guint begin(GByteArray *bytes, guint32 id) {
  put_id(bytes, id);
  put_size(bytes, 0);
  return bytes->len;
}

static void end(GByteArray *bytes, guint content) {
  guint64 size = GUINT64_TO_BE((guint64)(bytes->len - content) | (guint64)1 << 56);
  memcpy(bytes->data + content - SIZE_BYTES, &size, SIZE_BYTES);
}

static void put_unsigned(GByteArray *bytes, guint32 id, guint64 number) {
  put_id(bytes, id);
  put_size(bytes, 8);
  put_number(bytes, number, 8);
}

static void put_double(GByteArray *bytes, guint32 id, double number) {
  guint64 bits;
  memcpy(&bits, &number, sizeof bits);
  put_unsigned(bytes, id, bits);
}

static void put_text(GByteArray *bytes, guint32 id, const char *text) {
  gsize length = strlen(text);
  put_id(bytes, id);
  put_size(bytes, length);
  g_byte_array_append(bytes, (const guint8 *)text, (guint)length);
}

/* The file's parts. */

static void put_head(GByteArray *bytes) {
  guint content = begin(bytes, EBML);
  put_unsigned(bytes, EBML_VERSION, 1);
  put_unsigned(bytes, EBML_READ_VERSION, 1);
  put_unsigned(bytes, EBML_ID_LENGTH, 4);
  put_unsigned(bytes, EBML_SIZE_LENGTH, 8);
  put_text(bytes, DOC_TYPE, "webm");
  put_unsigned(bytes, DOC_TYPE_VERSION, 4);
  put_unsigned(bytes, DOC_TYPE_READ_VERSION, 2);
  end(bytes, content);
}

static void put_info(GByteArray *bytes, const SporeWebm *webm) {
  guint content = begin(bytes, INFO);
  put_unsigned(bytes, TIMESTAMP_SCALE, 1000000); /* ns in the unit of times below */
  put_double(bytes, DURATION, 1000 * (double)webm->count / webm->fps);
  put_text(bytes, MUXING_APP, "SPORE");
  put_text(bytes, WRITING_APP, "SPORE");
  end(bytes, content);
}

static void put_colour(GByteArray *bytes) {
  enum { BT_709 = 1, STUDIO = 1 };
  guint content = begin(bytes, COLOUR);
  put_unsigned(bytes, MATRIX_COEFFICIENTS, BT_709);
  put_unsigned(bytes, RANGE, STUDIO);
  put_unsigned(bytes, TRANSFER_CHARACTERISTICS, BT_709);
  put_unsigned(bytes, PRIMARIES, BT_709);
  end(bytes, content);
}

static void put_video(GByteArray *bytes, const SporeWebm *webm) {
  enum { PROGRESSIVE = 2 };
  guint content = begin(bytes, VIDEO);
  put_unsigned(bytes, FLAG_INTERLACED, PROGRESSIVE);
  put_unsigned(bytes, PIXEL_WIDTH, (guint64)webm->width);
  put_unsigned(bytes, PIXEL_HEIGHT, (guint64)webm->height);
  put_colour(bytes);
  end(bytes, content);
}

static void put_tracks(GByteArray *bytes, const SporeWebm *webm) {
  enum { TYPE_VIDEO = 1 };
  guint tracks = begin(bytes, TRACKS), content = begin(bytes, TRACK_ENTRY);
  put_unsigned(bytes, TRACK_NUMBER, 1);
  put_unsigned(bytes, TRACK_UID, 1);
  put_unsigned(bytes, TRACK_TYPE, TYPE_VIDEO);
  put_unsigned(bytes, FLAG_LACING, 0);
  put_text(bytes, LANGUAGE, "und"); /* no language is English otherwise */
  put_unsigned(bytes, DEFAULT_DURATION, (guint64)llround(1e9 / webm->fps));
  put_text(bytes, CODEC_ID, "V_VP9");
  put_video(bytes, webm);
  end(bytes, content);
  end(bytes, tracks);
}

/* first: where the clusters will begin, counted from the content of the segment. */
static void put_cues(GByteArray *bytes, const SporeWebm *webm, guint64 first) {
  guint content = begin(bytes, CUES);
  for (guint i = 0; i < webm->cues->len; i++) {
    const Cue *cue = &g_array_index(webm->cues, Cue, i);
    guint point = begin(bytes, CUE_POINT);
    put_unsigned(bytes, CUE_TIME, (guint64)cue->time_ms);
    guint positions = begin(bytes, CUE_TRACK_POSITIONS);
    put_unsigned(bytes, CUE_TRACK, 1);
    put_unsigned(bytes, CUE_CLUSTER_POSITION, first + cue->at);
    end(bytes, positions);
    end(bytes, point);
  }
  end(bytes, content);
}

SporeWebm *spore_webm_new(int width, int height, double fps) {
  g_return_val_if_fail(width > 0 && height > 0 && fps > 0, NULL);
  SporeWebm *webm = g_new0(SporeWebm, 1);
  webm->width = width, webm->height = height, webm->fps = fps;
  webm->clusters = g_byte_array_new();
  webm->cues = g_array_new(FALSE, FALSE, sizeof(Cue));
  return webm;
}

void spore_webm_free(SporeWebm *webm) {
  if (!webm) return;
  if (webm->clusters) g_byte_array_unref(webm->clusters);
  g_array_unref(webm->cues);
  g_free(webm);
}

static void open_cluster(SporeWebm *webm, gint64 time_ms) {
  if (webm->open) end(webm->clusters, webm->open);
  Cue cue = {time_ms, webm->clusters->len};
  g_array_append_val(webm->cues, cue);
  webm->open = begin(webm->clusters, CLUSTER);
  webm->open_ms = time_ms;
  put_unsigned(webm->clusters, TIMESTAMP, (guint64)time_ms);
}

gboolean spore_webm_add(SporeWebm *webm, const void *picture, gsize size, gboolean key, GError **error) {
  enum { TRACK = 0x81, KEY = 0x80 };
  if (size > LARGEST - webm->clusters->len)
    return spore_error_raise(error, SPORE_ERROR_INPUT, _("film"),
                             _("longer than 2 GB after %.0f s; make it shorter, or its pictures smaller or fewer"),
                             (double)webm->count / webm->fps);
  gint64 time_ms = llround(1000 * (double)webm->count / webm->fps);
  if (key || time_ms - webm->open_ms > LONGEST_MS) open_cluster(webm, time_ms);
  put_id(webm->clusters, SIMPLE_BLOCK);
  put_size(webm->clusters, 4 + size);
  put_number(webm->clusters, TRACK, 1);
  put_number(webm->clusters, (guint64)(time_ms - webm->open_ms), 2);
  put_number(webm->clusters, key ? KEY : 0, 1);
  g_byte_array_append(webm->clusters, picture, (guint)size);
  webm->count++;
  return TRUE;
}

GBytes *spore_webm_end(SporeWebm *webm) {
  g_return_val_if_fail(webm->clusters, NULL);
  if (webm->open) end(webm->clusters, webm->open);
  g_autoptr(GByteArray) head = g_byte_array_new(), cues = g_byte_array_new();
  put_head(head);
  guint segment = begin(head, SEGMENT);
  put_info(head, webm);
  put_tracks(head, webm);
  put_cues(cues, webm, 0); /* as long as the ones that follow, since all numbers take 8 bytes */
  put_cues(head, webm, head->len + cues->len - segment);
  guint64 size = GUINT64_TO_BE((guint64)(head->len - segment + webm->clusters->len) | (guint64)1 << 56);
  memcpy(head->data + segment - SIZE_BYTES, &size, SIZE_BYTES);
  g_byte_array_prepend(webm->clusters, head->data, head->len);
  return g_byte_array_free_to_bytes(g_steal_pointer(&webm->clusters));
}
