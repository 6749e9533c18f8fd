/* What SPORE and its volume helper say to each other. Native byte order: both run on the same machine. */
#ifndef SPORE_IO_VOLUME_WIRE_H
#define SPORE_IO_VOLUME_WIRE_H

#include <stdint.h>

#define SPORE_VOLUME_VOXELS (UINT64_C(1) << 28) /* at most */

/* size[0] x size[1] x size[2] uint16_t labels follow, the first index running fastest. The request is the file's bytes
 * alone. */
typedef struct SporeVolumeAnswer {
  uint64_t size[3];
  double
      axes[12]; /* 3 x 4, rows: from indices (i, j, k, 1), of a voxel's middle, to RAS (+x right, +y front, +z up), m */
} SporeVolumeAnswer;

/* What spore-volume-list says of a label above 0 that occurs. */
typedef struct SporeVolumeLabel {
  uint64_t voxels;
  uint32_t lower[3], upper[3]; /* indices of the outermost voxels */
  uint32_t label, unused;
  char name[64]; /* in the table of a NIfTI file, ends with 0; empty: it has none */
} SporeVolumeLabel;

/* `count` SporeVolumeLabel follow, ascending by label. */
typedef struct SporeVolumeSurvey {
  SporeVolumeAnswer volume;
  uint64_t count;
} SporeVolumeSurvey;

#endif
