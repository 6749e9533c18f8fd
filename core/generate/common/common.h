/* What several generators stand on: the solid of a surface and points in it, its mirror planes, distances between
 * surfaces, and tetrahedral meshes that are made better in place. Lengths in metres unless a caller says otherwise. */
#ifndef SPORE_GENERATE_COMMON_COMMON_H
#define SPORE_GENERATE_COMMON_COMMON_H

#include "core/base/progress.h"
#include "core/mesh/sizing.h"
#include "core/mesh/bvh.h"

/* False; *error says that what is generated needs more memory than there is. */
bool spore_generate_no_memory(SporeError *error);

/* A ball in which a generator does something of its own. */
typedef struct SporeGenerateRegion {
  double centre[3], radius; /* m */
  double value;             /* density of spheres (1: as elsewhere), or edge length of cells, m */
} SporeGenerateRegion;
#define SPORE_GENERATE_REGIONS 64 /* at most */

/* Random numbers: splitmix64, the same everywhere. */
typedef struct SporeRandom {
  uint64_t state;
} SporeRandom;
static inline uint64_t spore_random_next(SporeRandom *random) {
  uint64_t z = random->state += UINT64_C(0x9e3779b97f4a7c15);
  z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
  return z ^ z >> 31;
}
/* In [0, 1). */
static inline double spore_random_unit(SporeRandom *random) {
  return (double)(spore_random_next(random) >> 11) * 0x1p-53;
}
SporeVec3 spore_random_direction(SporeRandom *random);

/* Mirror planes of a solid. */

#define SPORE_MIRRORS_MOST 3

/* Planes at right angles to each other, through one point. */
typedef struct SporeSymmetry {
  size_t count;
  SporeVec3 point, normal[SPORE_MIRRORS_MOST]; /* m, unit */
} SporeSymmetry;

/* Planes that map the surface onto itself, to a millionth of `diagonal` (m), of those that stand on a coordinate axis
 * or on a principal axis of the surface. bvh: of the mesh. */
void spore_symmetry_find(SporeSymmetry *symmetry, const SporeTriangleMesh *mesh, const SporeBvh *bvh, double diagonal);
/* The point, or its image, that lies on the side of all planes to which their normals point. */
SporeVec3 spore_symmetry_fold(const SporeSymmetry *symmetry, SporeVec3 p);
/* Moved onto the planes whose bits are set. */
SporeVec3 spore_symmetry_bind(const SporeSymmetry *symmetry, unsigned planes, SporeVec3 p);
/* Mirrored in the planes whose bits are set. */
SporeVec3 spore_symmetry_mirror(const SporeSymmetry *symmetry, unsigned planes, SporeVec3 p);

/* The solid of a surface: where the winding number is over 0.5. A surface that is inside out is turned. */
typedef struct SporeSolid {
  SporeTriangleMesh mesh; /* a copy, turned outward */
  SporeBvh *bvh;
  double *cells;     /* cell_count x 4: lower corner and edge; together they hold the solid */
  double *cell_end;  /* cell_count: running sum of volumes */
  bool *cell_inside; /* cell_count: wholly inside */
  size_t cell_count;
  double *triangle_end;               /* triangle_count: running sum of areas */
  double volume, diagonal, deepest;   /* m^3 and m, estimates by sampling; diagonal exact */
  SporeSymmetry symmetry;             /* samples and candidates are folded by it; none unless somebody sets it */
  const SporeGenerateRegion *regions; /* region_count: where samples lie closer and weigh more; none, too */
  size_t region_count;
} SporeSolid;
/* Largest value of the regions that hold the point; 1 where none does. */
double spore_solid_factor(const SporeSolid *solid, SporeVec3 p);

bool spore_solid_create(SporeSolid *solid, const SporeTriangleMesh *mesh, SporeError *error);
void spore_solid_clear(SporeSolid *solid);
/* count points (x y z each) spread evenly over the volume. False: cancelled. */
bool spore_solid_interior(const SporeSolid *solid, size_t count, SporeRandom *random, double *points,
                          const SporeProgressPart *progress, SporeError *error);
/* The same over the surface. */
void spore_solid_surface(const SporeSolid *solid, size_t count, SporeRandom *random, double *points,
                         SporeVec3 *normals);

/* Sampled surfaces. */

/* Points (samples x 3) spread evenly over the area: one each equal share of it, placed in its triangle by the R2
 * sequence (Roberts 2018). The same mesh gives the same points. triangles (samples): which each lies in; may be NULL.
 */
void spore_surface_samples(const SporeTriangleMesh *mesh, size_t samples, double *points, uint32_t *triangles);

/* Hausdorff distance (m), both ways, at `samples` points spread evenly over the area of each. The same meshes give the
 * same number. False: no memory, or cancelled. */
bool spore_surface_distance(const SporeTriangleMesh *a, const SporeTriangleMesh *b, size_t samples, double *distance,
                            const SporeProgress *progress, SporeError *error);

/* Tetrahedral meshes, changed in place. */

/* Points that a mesh shall be near. */
typedef struct SporeSkinPoints {
  size_t count;
  double *places;  /* count x 3 */
  uint32_t *hosts; /* count x 3: corners of the face nearest to each */
  double *off;     /* count: distances from there */
} SporeSkinPoints;

/* At most `most` of the places (count x 3), evenly among them; hosts by distance alone. False: no memory. */
bool spore_skin_points_create(SporeSkinPoints *points, const SporeTetrahedralMesh *mesh, const double *places,
                              size_t count, size_t most, SporeError *error);
void spore_skin_points_clear(SporeSkinPoints *points);

/* Raises the least quality of a cell (spore_tetrahedron_quality) as long as it is below `goal` and that helps: vertices
 * move to where the worst cell around them is best, edges and faces inside are exchanged, slivers on the boundary go.
 * Vertices of the boundary move on `surface` alone; NULL: not at all. labels (one a cell, from spore_allocate; may be
 * NULL): a face between two labels counts as boundary, and cells that are made keep their label. Vertices keep their
 * numbers; the number of cells may change, *labels with it. The least quality of all never falls. Slow only where there
 * are many bad cells. False: no memory or cancelled; the mesh can only be cleared then. */
bool spore_tetrahedra_improve(SporeTetrahedralMesh *mesh, uint32_t **labels, const SporeBvh *surface, double goal,
                              const SporeProgress *progress, SporeError *error);

/* Draws edges together until `cells` are left, or fewer cannot be: the shortest first, by the edges that are wanted,
 * and those that keep the skin nearest to its points. No cell's quality falls below `least`. mesh->labels are kept.
 * Vertices keep their numbers; some are in no cell any more. */
bool spore_tetrahedra_coarsen(SporeTetrahedralMesh *mesh, const SporeBvh *surface, SporeSkinPoints *points,
                              const SporeSizing *sizing, size_t cells, double least, const SporeProgress *progress,
                              SporeError *error);

/* Moves vertices of the skin to where its faces are nearest to their points (and their middles to `surface`, unless it
 * is NULL), be that off the surface; distances beyond `usual` count more than by their squares. No cell's quality falls
 * below `least` (or below what it is). Points keep their hosts. */
bool spore_tetrahedra_approach(SporeTetrahedralMesh *mesh, const SporeBvh *surface, SporeSkinPoints *points, int rounds,
                               double usual, double least, SporeError *error);

/* Parts cells that hold together at an edge or a vertex of the boundary alone: by further vertices in the same place,
 * or where the cells hold together elsewhere too, by cells at the edge that go. The boundary is a surface then. */
bool spore_tetrahedra_mend(SporeTetrahedralMesh *mesh, SporeError *error);

#endif
