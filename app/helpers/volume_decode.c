/* Decodes a label map: undoes gzip, reads the header of its format, and turns its voxels into labels. */
#include "app/helpers/volume.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#define N_(text) text
#define CHUNK ((size_t)1 << 20)
#define LARGEST_LABEL 65535
#define MOST_BYTES ((size_t)SPORE_VOLUME_VOXELS * 8)

bool spore_volume_fail_memory(SporeHelperFailure *failure) {
  failure->code = SPORE_ERROR_MEMORY;
  failure->message = N_("the volume needs more memory than it may have; expected a smaller one; crop it first");
  failure->detail[0] = '\0';
  return false;
}

/* Grows the result as the stream is read, so that a wrong size in the header costs no memory. */
static bool inflate_all(z_stream *stream, size_t most, uint8_t **result, size_t *filled, SporeHelperFailure *failure) {
  size_t room = 0;
  for (int state = Z_OK; state != Z_STREAM_END;) {
    if (*filled == room) {
      if (room >= most)
        return spore_helper_fail(failure,
                                 N_("there are more voxels than its header says, or than can be taken; expected "
                                    "as many; save it again"),
                                 "over %zu bytes", most);
      room = room ? 2 * room : CHUNK;
      if (room > most) room = most;
      uint8_t *grown = realloc(*result, room);
      if (!grown) return spore_volume_fail_memory(failure);
      *result = grown;
    }
    size_t step = room - *filled < CHUNK ? room - *filled : CHUNK;
    stream->next_out = *result + *filled;
    stream->avail_out = (uInt)step;
    state = inflate(stream, Z_NO_FLUSH);
    *filled += step - stream->avail_out;
    if (state != Z_OK && state != Z_STREAM_END)
      return spore_helper_fail(failure,
                               N_("its compressed data are cut short or damaged; expected a whole gzip stream; "
                                  "copy or save it again"),
                               "%s", stream->msg ? stream->msg : "");
  }
  return true;
}

bool spore_inflate(const uint8_t *bytes, size_t size, size_t most, uint8_t **result, size_t *result_size,
                   SporeHelperFailure *failure) {
  z_stream stream = {.next_in = (uint8_t *)bytes, .avail_in = (uInt)size};
  *result = NULL;
  *result_size = 0;
  if (size > UINT32_MAX / 2 || inflateInit2(&stream, 15 + 16) != Z_OK) return spore_volume_fail_memory(failure);
  bool done = inflate_all(&stream, most, result, result_size, failure);
  inflateEnd(&stream);
  if (done) return true;
  free(*result);
  *result = NULL;
  return false;
}

static double voxel(const SporeVolumeHead *head, const uint8_t *at) {
  uint8_t bytes[8];
  size_t size = spore_voxel_bytes[head->type];
  for (size_t i = 0; i < size; i++) bytes[head->swapped ? size - 1 - i : i] = at[i];
#define CASE(TYPE, type)                                                                                               \
  case SPORE_VOXEL_##TYPE: {                                                                                           \
    type value;                                                                                                        \
    memcpy(&value, bytes, sizeof value);                                                                               \
    return (double)value;                                                                                              \
  }
  switch (head->type) {
    CASE(UINT8, uint8_t)
    CASE(INT8, int8_t)
    CASE(UINT16, uint16_t)
    CASE(INT16, int16_t)
    CASE(UINT32, uint32_t)
    CASE(INT32, int32_t)
    CASE(UINT64, uint64_t)
    CASE(INT64, int64_t)
    CASE(FLOAT, float)
    CASE(DOUBLE, double)
  case SPORE_VOXEL_TYPES:
    break;
  }
#undef CASE
  return NAN;
}

/* Labels that are stored as they are: of one or two bytes, in this machine's order. */
static bool copy_labels(const SporeVolumeHead *head, const uint8_t *data, size_t count, uint16_t *labels) {
  if (head->slope != 1 || head->shift != 0) return false;
  if (head->type == SPORE_VOXEL_UINT8)
    for (size_t i = 0; i < count; i++) labels[i] = data[i];
  else if (head->type == SPORE_VOXEL_UINT16 && !head->swapped) memcpy(labels, data, count * sizeof *labels);
  else return false;
  return true;
}

bool spore_volume_labels(const SporeVolumeHead *head, const uint8_t *data, size_t first, size_t count, uint16_t *labels,
                         SporeHelperFailure *failure) {
  const size_t size = spore_voxel_bytes[head->type];
  if (copy_labels(head, data + first * size, count, labels)) return true;
  for (size_t i = 0; i < count; i++) {
    double value = head->slope * voxel(head, data + (first + i) * size) + head->shift;
    if (!(value >= 0 && value <= LARGEST_LABEL) || value != floor(value))
      return spore_helper_fail(failure,
                               N_("it holds a value that is no label; expected whole numbers from 0 to 65535; "
                                  "is it a picture and not a segmentation?"),
                               "%g in voxel %zu", value, first + i);
    labels[i] = (uint16_t)value;
  }
  return true;
}

static bool make_answer(const uint8_t *bytes, const SporeVolumeHead *head, const uint8_t *data, void **result,
                        size_t *result_size, SporeHelperFailure *failure) {
  size_t voxels = (size_t)(head->answer.size[0] * head->answer.size[1] * head->answer.size[2]);
  *result_size = sizeof head->answer + voxels * sizeof(uint16_t);
  char *answer = malloc(*result_size);
  if (!answer) return spore_volume_fail_memory(failure);
  memcpy(answer, &head->answer, sizeof head->answer);
  _Static_assert(sizeof head->answer % sizeof(uint16_t) == 0, "labels would not be aligned");
  if (spore_volume_labels(head, data, 0, voxels, (uint16_t *)(void *)(answer + sizeof head->answer), failure)) {
    *result = answer;
    return true;
  }
  free(answer);
  return false;
}

static bool check_size(const SporeVolumeHead *head, size_t size, SporeHelperFailure *failure) {
  const size_t wanted =
      (size_t)(head->answer.size[0] * head->answer.size[1] * head->answer.size[2]) * spore_voxel_bytes[head->type];
  return size >= wanted || spore_helper_fail(failure,
                                             N_("the volume is cut short; expected as many voxels as its header says; "
                                                "copy or save it again"),
                                             "%zu of %zu bytes", size, wanted);
}

/* Opens a content that is not compressed as a whole. */
static bool open_plain(const uint8_t *bytes, size_t size, SporeVolumeUse *use, void **result, size_t *result_size,
                       SporeHelperFailure *failure) {
  SporeVolumeHead head;
  bool nrrd = size >= 5 && memcmp(bytes, "NRRD0", 5) == 0;
  if (!(nrrd ? spore_nrrd_head(bytes, size, &head, failure) : spore_nifti_head(bytes, size, &head, failure)) ||
      !spore_volume_head_check(&head, failure))
    return false;
  uint8_t *inflated = NULL;
  const uint8_t *data = bytes + head.data;
  size -= head.data;
  if (head.compressed && !spore_inflate(data, size, MOST_BYTES, &inflated, &size, failure)) return false;
  bool done =
      check_size(&head, size, failure) && use(bytes, &head, inflated ? inflated : data, result, result_size, failure);
  free(inflated);
  return done;
}

bool spore_volume_open(const uint8_t *bytes, size_t size, SporeVolumeUse *use, void **result, size_t *result_size,
                       SporeHelperFailure *failure) {
  if (size < 2 || bytes[0] != 0x1f || bytes[1] != 0x8b)
    return open_plain(bytes, size, use, result, result_size, failure);
  uint8_t *whole; /* .nii.gz */
  if (!spore_inflate(bytes, size, MOST_BYTES, &whole, &size, failure)) return false;
  bool done = open_plain(whole, size, use, result, result_size, failure);
  free(whole);
  return done;
}

bool spore_volume_decode(const uint8_t *bytes, size_t size, void **result, size_t *result_size,
                         SporeHelperFailure *failure) {
  return spore_volume_open(bytes, size, make_answer, result, result_size, failure);
}
