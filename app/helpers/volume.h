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

/* A file's content: gzip undone, header and labels read. *result: SporeVolumeAnswer and the labels, malloc'ed. False
 * with what is wrong. */
bool spore_volume_decode(const uint8_t *bytes, size_t size, void **result, size_t *result_size,
                         SporeHelperFailure *failure);

/* What a header says. */
typedef struct SporeVolumeHead {
  SporeVolumeAnswer answer; /* size, axes */
  SporeVoxelType type;
  bool swapped;        /* bytes of a value the other way round than this machine's */
  double slope, shift; /* value = slope x what is stored + shift */
  bool compressed;     /* the data are a gzip stream */
  size_t data;         /* where they begin in the file */
} SporeVolumeHead;

/* Both: the header of a content that begins as the format does. False with what is wrong. */
bool spore_nifti_head(const uint8_t *bytes, size_t size, SporeVolumeHead *head, SporeHelperFailure *failure);
bool spore_nrrd_head(const uint8_t *bytes, size_t size, SporeVolumeHead *head, SporeHelperFailure *failure);

/* Undoes gzip: all of it, at most `most` bytes. *result malloc'ed. */
bool spore_inflate(const uint8_t *bytes, size_t size, size_t most, uint8_t **result, size_t *result_size,
                   SporeHelperFailure *failure);

/* Counts within bounds and not empty, axes finite and spanning a space. */
bool spore_volume_head_check(const SporeVolumeHead *head, SporeHelperFailure *failure);

/* Returns false. detail: printed, may be "". */
bool spore_volume_fail(SporeHelperFailure *failure, const char *message, const char *detail, ...)
    __attribute__((format(printf, 3, 4)));

#endif
