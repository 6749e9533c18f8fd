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

#endif
