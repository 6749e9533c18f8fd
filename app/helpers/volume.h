/* Decoding label maps, inside the sandbox: zlib and libc alone. */
#ifndef SPORE_HELPERS_VOLUME_H
#define SPORE_HELPERS_VOLUME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "app/helpers/failure.h"
#include "core/io/volume_wire.h"

typedef enum SporeVoxelType {
  SPORE_VOXEL_UINT8,
  SPORE_VOXEL_INT8,
  SPORE_VOXEL_UINT16,
  SPORE_VOXEL_INT16,
  SPORE_VOXEL_UINT32,
  SPORE_VOXEL_INT32,
  SPORE_VOXEL_UINT64,
  SPORE_VOXEL_INT64,
  SPORE_VOXEL_FLOAT,
  SPORE_VOXEL_DOUBLE,
  SPORE_VOXEL_TYPES
} SporeVoxelType;
extern const size_t spore_voxel_bytes[SPORE_VOXEL_TYPES];

/* Decodes a file's content: undoes gzip, reads header and labels. *result: SporeVolumeAnswer and the labels, malloc'ed.
 * False with a failure. */
bool spore_volume_decode(const uint8_t *bytes, size_t size, void **result, size_t *result_size,
                         SporeHelperFailure *failure);

/* The same, of labels, their voxels and names alone. *result: SporeVolumeSurvey and its labels. */
bool spore_volume_survey(const uint8_t *bytes, size_t size, void **result, size_t *result_size,
                         SporeHelperFailure *failure);

/* What a header says. */
typedef struct SporeVolumeHead {
  SporeVolumeAnswer answer; /* size, axes */
  SporeVoxelType type;
  bool swapped;        /* the bytes of a value are in the other order than this machine's */
  double slope, shift; /* value = slope x what is stored + shift */
  bool compressed;     /* the data are a gzip stream */
  size_t data;         /* offset of the data in the file */
} SporeVolumeHead;

/* Read the header of a content that begins as the format requires. False with a failure. */
bool spore_nifti_head(const uint8_t *bytes, size_t size, SporeVolumeHead *head, SporeHelperFailure *failure);
bool spore_nrrd_head(const uint8_t *bytes, size_t size, SporeVolumeHead *head, SporeHelperFailure *failure);

/* Makes an answer of the file's bytes and its voxels, which lie in `data`. */
typedef bool SporeVolumeUse(const uint8_t *bytes, const SporeVolumeHead *head, const uint8_t *data, void **result,
                            size_t *result_size, SporeHelperFailure *failure);
/* Undoes gzip, reads and checks the header, and hands both to `use`. */
bool spore_volume_open(const uint8_t *bytes, size_t size, SporeVolumeUse *use, void **result, size_t *result_size,
                       SporeHelperFailure *failure);
/* Turns `count` voxels from the one of index `first` into labels. False: a value is no label. */
bool spore_volume_labels(const SporeVolumeHead *head, const uint8_t *data, size_t first, size_t count, uint16_t *labels,
                         SporeHelperFailure *failure);
bool spore_volume_fail_memory(SporeHelperFailure *failure);

/* Decompresses a whole gzip stream, at most `most` bytes. *result malloc'ed. */
bool spore_inflate(const uint8_t *bytes, size_t size, size_t most, uint8_t **result, size_t *result_size,
                   SporeHelperFailure *failure);

/* Checks that counts are above 0 and within bounds, and that axes are finite and span a space. */
bool spore_volume_head_check(const SporeVolumeHead *head, SporeHelperFailure *failure);

#endif
