/* Cheapest paths through the voxels of a tube. */
#ifndef SPORE_GENERATE_CENTRELINE_SEARCH_H
#define SPORE_GENERATE_CENTRELINE_SEARCH_H

#include "core/generate/centreline/private.h"

/* Priority queue of voxels, least distance first; at equal distance the lower number first. */
typedef struct SporeVoxelQueue {
  size_t count;
  uint32_t *voxel;        /* a heap */
  uint32_t *place;        /* by voxel: its position in the heap */
  const double *distance; /* by voxel */
} SporeVoxelQueue;

/* All arrays are by voxel. A voxel that no path reaches has the distance HUGE_VAL. */
typedef struct SporeVoxelSearch {
  const SporeVoxelTube *tube;
  SporeVoxelQueue queue;
  double *cost;     /* per metre in the voxel */
  double *distance; /* sum of costs */
  double *length;   /* m along the path to the voxel */
  double *volume;   /* of a tube around the path to the voxel, with the depth as its radius, over pi, m^3 */
  uint32_t *from;   /* the previous voxel; itself at a start, SPORE_NO_VOXEL where no path leads */
  bool *cut;        /* dear to pass, where loops are grown together */
  const SporeProgressPart *progress;
} SporeVoxelSearch;

bool spore_voxel_search_create(SporeVoxelSearch *search, const SporeVoxelTube *tube, const SporeProgressPart *progress,
                               SporeError *error);
void spore_voxel_search_clear(SporeVoxelSearch *search);
/* The cheapest path from any of the starts to each voxel. */
bool spore_voxel_search_spread(SporeVoxelSearch *search, const uint32_t *starts, size_t start_count, SporeError *error);

/* Finds what is near the path, and puts the parts that the path leaves out into the report. */
bool spore_voxel_search_leftovers(SporeVoxelSearch *search, SporeVoxelPath *path, SporeCentrelineReport *report,
                                  SporeError *error);

/* Marks in `cut` (by voxel) the section through the narrowest neck of the path beside one of the pieces that it leaves
 * out (its number in the report). *marked: there is one. */
bool spore_voxel_path_mark_neck(const SporeVoxelPath *path, const SporeVoxelTube *tube, size_t piece, bool *cut,
                                bool *marked, SporeError *error);
/* *sound: the path passes no section that is cut, as it must where that is no neck between loops, and does not come
 * back to where it was. */
bool spore_voxel_path_is_sound(const SporeVoxelPath *path, const SporeVoxelTube *tube, const bool *cut, bool *sound,
                               SporeError *error);
/* Depth of the path's narrowest neck, over the lesser of the largest depths on both sides; nearly 1 without a neck. */
bool spore_voxel_path_narrowest(const SporeVoxelPath *path, const SporeVoxelTube *tube, double *narrow,
                                SporeError *error);

#endif
