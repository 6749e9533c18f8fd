/* Declarations shared by the files that find centrelines. */
#ifndef SPORE_GENERATE_CENTRELINE_PRIVATE_H
#define SPORE_GENERATE_CENTRELINE_PRIVATE_H

#include "core/generate/centreline/centreline.h"
#include "core/generate/common/common.h"

/* The inside of the organ as voxels, sorted by key. */
#define SPORE_VOXEL_NEIGHBOURS 26
#define SPORE_NO_VOXEL UINT32_MAX
typedef struct SporeVoxelTube {
  size_t count;
  double edge, lower[3];   /* m; lower corner of cube (0, 0, 0) */
  uint64_t *key;           /* count, ascending: position packed by spore_voxel_key */
  double *depth;           /* count: depth of the voxel's centre, m, > 0 */
  uint32_t *neighbour;     /* count x 26, or SPORE_NO_VOXEL where there is none or a wall lies between; the k-th lies
                              along spore_voxel_offset(k) */
  uint32_t *component;     /* count: 0 is the largest */
  size_t component_count;  /* without specks */
  double share;            /* share of the voxels in the largest component */
  const SporeSolid *solid; /* borrowed */
  bool *of_piece;          /* by triangle: of the piece of the surface that hangs together and has the largest area */
  bool of_one_piece;       /* that piece is nearly all: where it overlaps itself, its walls still part its inside */
} SporeVoxelTube;
/* The number of voxels that a solid gets, about. */
double spore_voxel_tube_expected(const SporeSolid *solid);
bool spore_voxel_tube_create(SporeVoxelTube *tube, const SporeSolid *solid, const SporeProgressPart *progress,
                             SporeError *error);
void spore_voxel_tube_clear(SporeVoxelTube *tube);
SporeVec3 spore_voxel_middle(const SporeVoxelTube *tube, uint32_t voxel);
/* -1, 0 or 1 along each axis. */
void spore_voxel_offset(int k, int offset[3]);
/* Voxel at a position, or SPORE_NO_VOXEL. */
uint32_t spore_voxel_at(const SporeVoxelTube *tube, const int64_t place[3]);
/* Voxel of the largest component whose middle is nearest to p. */
uint32_t spore_voxel_nearest(const SporeVoxelTube *tube, SporeVec3 p);

/* Across the triangle, outward, twice as long as its area. */
SporeVec3 spore_triangle_across(const SporeTriangleMesh *mesh, uint32_t triangle);
bool spore_passage_know_piece(SporeVoxelTube *tube, SporeError *error);
/* Whether the straight way between two places inside stays inside: a wall of the organ that is passed through, with the
 * organ on both sides of it, is none. */
bool spore_passage_open(const SporeVoxelTube *tube, SporeVec3 a, SporeVec3 b);
/* Voxel of the largest component that is nearest to p, or to the place of the surface that is nearest to p, with no
 * wall between; SPORE_NO_VOXEL: none is near. */
uint32_t spore_voxel_of_place(const SporeVoxelTube *tube, SporeVec3 p);
/* Nearest voxel of any component at a place inside, or behind the place of the surface that is nearest, with no wall
 * between; SPORE_NO_VOXEL: the organ is too thin there. */
uint32_t spore_voxel_beside(const SporeVoxelTube *tube, SporeVec3 p);
/* Nearest voxel of any component behind a place of the surface, with no wall between; SPORE_NO_VOXEL: the organ is too
 * thin there. triangle: the one that has the place. *within: the place lies inside of the organ, whose parts overlap.
 */
uint32_t spore_voxel_under(const SporeVoxelTube *tube, SporeVec3 p, uint32_t triangle, bool *within);

/* Part of a path, m from the path's beginning. */
typedef struct SporeVoxelStretch {
  double from, to;
} SporeVoxelStretch;

/* A path from voxel to voxel. */
typedef struct SporeVoxelPath {
  size_t count;
  uint32_t *voxel;                                  /* from one end to the other */
  SporeVoxelStretch beside[SPORE_CENTRELINE_NAMED]; /* where the pieces left out that a report names touch the path */
  bool *near;      /* by voxel of the tube: within two radii of the path, through the inside */
  float *way;      /* by voxel of the tube: m from the path, through the inside; infinite where none leads */
  double followed; /* share of the largest component's voxels that are near */
  double ring;     /* the farthest along the path, of its length, between the two places that a loop left out joins, if
                      the loop joins none of the middle half */
} SporeVoxelPath;
void spore_voxel_path_clear(SporeVoxelPath *path);

/* The path through the largest component that covers most of it: between `ends`, or between two far ends if `ends`
 * is NULL. The parts that the path leaves out go into the report's branches (from: m along the path). */
bool spore_voxel_path_find(SporeVoxelPath *path, const SporeVoxelTube *tube, const uint32_t *ends,
                           SporeCentrelineReport *report, const SporeProgressPart *progress, SporeError *error);

/* Share of the surface, by area, behind which the voxels are near the path. */
bool spore_voxel_path_cover(const SporeVoxelPath *path, const SporeVoxelTube *tube, double *cover,
                            const SporeProgressPart *progress, SporeError *error);

/* Fills options->way of a mesh from the path's. */
bool spore_voxel_path_ways(const SporeVoxelPath *path, const SporeVoxelTube *tube, const SporeTriangleMesh *mesh,
                           double *way, const SporeProgressPart *progress, SporeError *error);

/* A surface without its inner walls. */
typedef struct SporeOuterWall {
  SporeTriangleMesh solid;  /* without walls that have the organ on both sides; visible triangles are turned outward;
                               empty: use the mesh as given */
  SporeTriangleMesh filled; /* also without triangles that are hardly visible from outside, so that the space between
                               them counts as inside; empty: too little is hidden for a lumen */
  double hidden;            /* share of the area that cannot be seen from outside; 0 if `filled` is empty */
} SporeOuterWall;
bool spore_outer_wall(const SporeTriangleMesh *mesh, const SporeBvh *bvh, SporeOuterWall *wall,
                      const SporeProgressPart *progress, SporeError *error);
void spore_outer_wall_clear(SporeOuterWall *wall);

/* What a centreline is sought in. It does not move: its parts point to each other. */
typedef struct SporeTubeOrgan {
  SporeSolid solid; /* without inner walls; with its lumen, if it has one */
  SporeVoxelTube tube;
  SporeVoxelPath path;        /* between ends that were found; empty: not known yet */
  SporeCentrelineReport left; /* its branches, with the path */
  double inner_wall;          /* as in the report */
} SporeTubeOrgan;
bool spore_tube_organ_create(SporeTubeOrgan *organ, const SporeTriangleMesh *mesh, const SporeProgress *progress,
                             SporeError *error);
void spore_tube_organ_clear(SporeTubeOrgan *organ);
/* The solid alone, for a curve that is known to run in the middle. */
bool spore_tube_solid_along(SporeSolid *solid, const SporeTriangleMesh *mesh, const SporeCurve *curve,
                            double *inner_wall, SporeError *error);

/* Distance (m) from a point inside to the wall; walls with the organ on both sides are passed through; at most
 * `reach`. */
double spore_section_wall(const SporeSolid *solid, SporeVec3 p, SporeVec3 d, double reach);
/* Centroid of the organ's section perpendicular to a direction, as far as the section is visible from a point
 * inside, and no farther than `reach` (m). */
#define SPORE_SECTION_RAYS 24
SporeVec3 spore_section_middle(const SporeSolid *solid, SporeVec3 p, SporeVec3 across, double reach);

/* Centres the path in the organ's sections, smooths the path and extends it to the ends. Points: x y z r. */
bool spore_centreline_refine(const SporeSolid *solid, const SporeVoxelTube *tube, const SporeVoxelPath *path,
                             const SporeCentrelineOptions *options, SporeCurve *curve,
                             const SporeProgressPart *progress, SporeError *error);
/* Radii by distance query. Near an end, where the end's own wall is nearest, a radius is at least a share of the one
 * further inside. Points outside keep their radius. */
void spore_centreline_set_radii(const SporeSolid *solid, SporeCurve *curve);
/* Resamples a dense smooth curve to the number of points or the tolerance that was asked for. */
bool spore_centreline_thin(const SporeCurve *dense, const SporeCentrelineOptions *options, SporeCurve *curve,
                           SporeError *error);

/* Length, radii, offset, outside and approach of a curve. */
void spore_centreline_figures(const SporeSolid *solid, const SporeCurve *curve, SporeCentrelineReport *report);

#endif
