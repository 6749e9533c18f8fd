/* Cheapest ways through the voxels of a tube. */
#ifndef SPORE_GENERATE_CENTRELINE_SEARCH_H
#define SPORE_GENERATE_CENTRELINE_SEARCH_H

#include "core/generate/centreline/private.h"

/* Voxels by their distance, least first; of equal ones the lower number first. */
typedef struct SporeVoxelQueue {
  size_t count;
  uint32_t *voxel;        /* a heap */
  uint32_t *place;        /* by voxel: where it lies in the heap */
  const double *distance; /* by voxel */
} SporeVoxelQueue;

/* All arrays by voxel; what no way leads to has the distance HUGE_VAL. */
typedef struct SporeVoxelSearch {
  const SporeVoxelTube *tube;
  SporeVoxelQueue queue;
  double *cost;     /* of a metre in the voxel */
  double *distance; /* sum of costs */
  double *length;   /* m along the way there */
  double *volume;   /* of a tube around the way there as thick as the way is deep, over pi, m^3 */
  uint32_t *from;   /* the voxel before; itself at a start, SPORE_NO_VOXEL where no way leads to */
  const SporeProgressPart *progress;
} SporeVoxelSearch;

bool spore_voxel_search_create(SporeVoxelSearch *search, const SporeVoxelTube *tube, const SporeProgressPart *progress,
                               SporeError *error);
void spore_voxel_search_clear(SporeVoxelSearch *search);
/* The cheapest way from any of the starts to each voxel. */
bool spore_voxel_search_spread(SporeVoxelSearch *search, const uint32_t *starts, size_t start_count, SporeError *error);

/* What the way leaves out, into the report; the share of the voxels that are near the way, into *cover. */
bool spore_voxel_search_leftovers(SporeVoxelSearch *search, const SporeVoxelPath *path, SporeCentrelineReport *report,
                                  double *cover, SporeError *error);

#endif
