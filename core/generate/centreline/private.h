/* What the files that find middle lines share. */
#ifndef SPORE_GENERATE_CENTRELINE_PRIVATE_H
#define SPORE_GENERATE_CENTRELINE_PRIVATE_H

#include "core/generate/centreline/centreline.h"
#include "core/generate/common/common.h"

/* Inside of the organ as little cubes, sorted by place. */
#define SPORE_VOXEL_NEIGHBOURS 26
#define SPORE_NO_VOXEL UINT32_MAX
typedef struct SporeVoxelTube {
  size_t count;
  double edge, lower[3]; /* m; lower corner of cube (0, 0, 0) */
  uint64_t *key;         /* count, ascending: place as packed by spore_voxel_key */
  double *depth;         /* count: of the middle, m, > 0 */
  uint32_t *neighbour;   /* count x 26, or SPORE_NO_VOXEL; the k-th lies along spore_voxel_offset(k) */
  uint32_t *component;   /* count: 0 is the largest */
  size_t component_count;
  double share; /* of the cubes, those of the largest */
} SporeVoxelTube;
bool spore_voxel_tube_create(SporeVoxelTube *tube, const SporeSolid *solid, const SporeProgressPart *progress,
                             SporeError *error);
void spore_voxel_tube_clear(SporeVoxelTube *tube);
SporeVec3 spore_voxel_middle(const SporeVoxelTube *tube, uint32_t voxel);
/* -1, 0 or 1 along each axis. */
void spore_voxel_offset(int k, int offset[3]);
/* Voxel of the component nearest to p. */
uint32_t spore_voxel_nearest(const SporeVoxelTube *tube, SporeVec3 p);

/* A way from voxel to voxel. */
typedef struct SporeVoxelPath {
  size_t count;
  uint32_t *voxel; /* from one end to the other */
} SporeVoxelPath;
void spore_voxel_path_clear(SporeVoxelPath *path);

/* The way through the largest component that covers most of it: between `ends`, or where those are NULL between two
 * far ends. What it leaves out goes into the report's branches (from: m along the way). */
bool spore_voxel_path_find(SporeVoxelPath *path, const SporeVoxelTube *tube, const uint32_t *ends,
                           SporeCentrelineReport *report, const SporeProgressPart *progress, SporeError *error);

/* A surface without its walls inside. */
typedef struct SporeOuterWall {
  SporeTriangleMesh solid; /* without walls that have the organ on both sides, what is seen turned outward; empty: as it
                            * is given */
  SporeTriangleMesh filled; /* without all that are hardly seen from outside, too: what is between them counts as
                             * inside; empty: so little is hidden that there is no lumen */
  double hidden;            /* share of the area that is seen from nowhere; 0 where `filled` is empty */
} SporeOuterWall;
bool spore_outer_wall(const SporeTriangleMesh *mesh, const SporeBvh *bvh, SporeOuterWall *wall,
                      const SporeProgressPart *progress, SporeError *error);
void spore_outer_wall_clear(SporeOuterWall *wall);

/* Distance (m) of the wall from a point inside, through walls that have the organ on both sides; at most `reach`. */
double spore_section_wall(const SporeSolid *solid, SporeVec3 p, SporeVec3 d, double reach);
/* Centroid of the organ's section across a direction, as far as it is seen from a point inside, and no farther than
 * `reach` (m). */
#define SPORE_SECTION_RAYS 24
SporeVec3 spore_section_middle(const SporeSolid *solid, SporeVec3 p, SporeVec3 across, double reach);

/* Middles the way in the organ's sections, smooths it and lets it reach the ends. Points: x y z r. */
bool spore_centreline_refine(const SporeSolid *solid, const SporeVoxelTube *tube, const SporeVoxelPath *path,
                             const SporeCentrelineOptions *options, SporeCurve *curve,
                             const SporeProgressPart *progress, SporeError *error);
/* Radii by distance query; near an end, where the end's own wall is nearest, not less than a share of the one before.
 * Points outside keep theirs. */
void spore_centreline_set_radii(const SporeSolid *solid, SporeCurve *curve);
/* Points as asked for from a dense smooth curve. */
bool spore_centreline_thin(const SporeCurve *dense, const SporeCentrelineOptions *options, SporeCurve *curve,
                           SporeError *error);

/* Length, radii, offset, outside and approach of a curve. */
void spore_centreline_figures(const SporeSolid *solid, const SporeCurve *curve, SporeCentrelineReport *report);

#endif
