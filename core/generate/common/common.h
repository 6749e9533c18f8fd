/* Shared by several generators: the solid of a surface and points in it, its mirror planes, distances between
 * surfaces, and tetrahedral meshes that are improved in place. Lengths in metres unless a caller says otherwise. */
#ifndef SPORE_GENERATE_COMMON_COMMON_H
#define SPORE_GENERATE_COMMON_COMMON_H

#include "core/base/progress.h"
#include "core/mesh/sizing.h"
#include "core/mesh/bvh.h"

/* Returns false and sets *error: not enough memory for what is generated. */
bool spore_generate_no_memory(SporeError *error);

/* A ball in which a generator uses another density or edge length. A region that is painted has several balls. */
typedef struct SporeGenerateRegion {
  double centre[3], radius; /* m */
  double value;             /* density of spheres (1: as elsewhere), or edge length of cells, m */
  size_t region;            /* which region the ball is of, from 0; balls of one region follow each other */
} SporeGenerateRegion;
#define SPORE_GENERATE_REGIONS 1024 /* balls, at most */

/* Random numbers: splitmix64, the same on every machine. */
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

/* Mutually perpendicular planes through one point. */
typedef struct SporeSymmetry {
  size_t count;
  SporeVec3 point, normal[SPORE_MIRRORS_MOST]; /* m, unit */
} SporeSymmetry;

/* Planes that map the surface onto itself, to a millionth of `diagonal` (m). The candidate normals are the
 * coordinate axes and the principal axes of the surface. bvh: of the mesh. */
void spore_symmetry_find(SporeSymmetry *symmetry, const SporeTriangleMesh *mesh, const SporeBvh *bvh, double diagonal);
/* The point, or the image of it, that lies on the side of all planes to which their normals point. */
SporeVec3 spore_symmetry_fold(const SporeSymmetry *symmetry, SporeVec3 p);
/* The point projected onto the planes whose bits are set. */
SporeVec3 spore_symmetry_bind(const SporeSymmetry *symmetry, unsigned planes, SporeVec3 p);
/* The point mirrored in the planes whose bits are set. */
SporeVec3 spore_symmetry_mirror(const SporeSymmetry *symmetry, unsigned planes, SporeVec3 p);

/* The solid of a surface: the region where the winding number exceeds 0.5. A surface that is inside out is turned. */
typedef struct SporeSolid {
  SporeTriangleMesh mesh; /* a copy, turned outward */
  SporeBvh *bvh;
  double *cells;     /* cell_count x 4: lower corner and edge; the cells together contain the solid */
  double *cell_end;  /* cell_count: running sum of volumes */
  bool *cell_inside; /* cell_count: wholly inside */
  size_t cell_count;
  double *triangle_end;               /* triangle_count: running sum of areas */
  double volume, diagonal, deepest;   /* m^3 and m, estimates by sampling; diagonal exact */
  SporeSymmetry symmetry;             /* samples and candidates are folded by it; empty unless a caller sets it */
  const SporeGenerateRegion *regions; /* region_count: where samples are denser and weigh more; none by default */
  size_t region_count;
} SporeSolid;
/* Largest value of the regions that contain the point; 1 if there is none. */
double spore_solid_factor(const SporeSolid *solid, SporeVec3 p);

bool spore_solid_create(SporeSolid *solid, const SporeTriangleMesh *mesh, SporeError *error);
void spore_solid_clear(SporeSolid *solid);
/* Fills `points` with count points (x y z each) spread evenly over the volume. False: cancelled. */
bool spore_solid_interior(const SporeSolid *solid, size_t count, SporeRandom *random, double *points,
                          const SporeProgressPart *progress, SporeError *error);
/* The same over the surface. */
void spore_solid_surface(const SporeSolid *solid, size_t count, SporeRandom *random, double *points,
                         SporeVec3 *normals);

/* Sampled surfaces. */

/* Points (samples x 3) spread evenly over the area: one for each equal share of it, placed in its triangle by the R2
 * sequence (Roberts 2018). The same mesh gives the same points. triangles (samples): the triangle of each point; may be
 * NULL. */
void spore_surface_samples(const SporeTriangleMesh *mesh, size_t samples, double *points, uint32_t *triangles);

/* Hausdorff distance (m), both ways, at `samples` points spread evenly over the area of each. The same meshes give the
 * same number. False: no memory, or cancelled. */
bool spore_surface_distance(const SporeTriangleMesh *a, const SporeTriangleMesh *b, size_t samples, double *distance,
                            const SporeProgress *progress, SporeError *error);

/* Tetrahedral meshes, changed in place. */

/* Points that a mesh must approximate. */
typedef struct SporeSkinPoints {
  size_t count;
  double *places;  /* count x 3 */
  uint32_t *hosts; /* count x 3: corners of the face nearest to each */
  double *off;     /* count: distances from there */
} SporeSkinPoints;

/* At most `most` of the places (count x 3), evenly chosen; hosts by distance alone. False: no memory. */
bool spore_skin_points_create(SporeSkinPoints *points, const SporeTetrahedralMesh *mesh, const double *places,
                              size_t count, size_t most, SporeError *error);
/* The same of places on borders between cells of two labels, whose hosts are the faces there. Appended to *points;
 * where there is no such face, nothing is. False: no memory; *points can then only be cleared. */
bool spore_skin_points_add_borders(SporeSkinPoints *points, const SporeTetrahedralMesh *mesh, const double *places,
                                   size_t count, size_t most, SporeError *error);
/* The faces between cells of two labels, as triangles: *triangles (3 x *count) from spore_allocate. False: no memory.
 */
bool spore_tetrahedral_mesh_borders(const SporeTetrahedralMesh *mesh, uint32_t **triangles, size_t *count,
                                    SporeError *error);
void spore_skin_points_clear(SporeSkinPoints *points);

/* Raises the least quality of a cell (spore_tetrahedron_quality) while it is below `goal` and improves: vertices
 * move to where the worst cell around them is best, inner edges and faces are flipped, slivers on the boundary are
 * removed. Vertices of the boundary move on `surface` only; NULL: not at all. labels (one a cell, from spore_allocate;
 * may be NULL): a face between two labels counts as boundary, and new cells keep their label. Vertices keep their
 * numbers. The number of cells may change, and *labels with it. The least quality of all never falls. Slow only where
 * there are many bad cells. False: no memory or cancelled; the mesh can then only be cleared. */
bool spore_tetrahedra_improve(SporeTetrahedralMesh *mesh, uint32_t **labels, const SporeBvh *surface, double goal,
                              const SporeProgress *progress, SporeError *error);

extern const double spore_coarsen_limits[2]; /* the usual ones: from nearly nothing to what any mesh needs */
/* Collapses edges until `cells` are left, or no further edge can be collapsed. Edges that are short relative to the
 * wanted length go first, and those that keep the skin nearest to its points. No cell's quality falls below `least`.
 * mesh->labels are kept. limits: how far the skin may be from its points in the first pass, and in any, as shares of
 * the largest wanted length: spore_coarsen_limits, or others. kept: by label, cells that each keeps, of a label that
 * has fewer all; NULL: any number. Vertices keep their numbers; some are no longer in any cell. */
bool spore_tetrahedra_coarsen(SporeTetrahedralMesh *mesh, const SporeBvh *surface, SporeSkinPoints *points,
                              const SporeSizing *sizing, size_t cells, const size_t *kept, double least,
                              const double *limits, const SporeProgress *progress, SporeError *error);

/* Moves vertices of the skin to where its faces are nearest to their points (and the middles of the faces to
 * `surface`, unless it is NULL), even off the surface. Distances beyond `usual` count more than by their squares. No
 * cell's quality falls below `least`, or below its present value if that is less. Points keep their hosts. */
bool spore_tetrahedra_approach(SporeTetrahedralMesh *mesh, const SporeBvh *surface, SporeSkinPoints *points, int rounds,
                               double usual, double least, SporeError *error);

/* Separates cells that are connected only by an edge or a vertex of the boundary: by duplicate vertices, or, if the
 * cells are also connected elsewhere, by removing cells at the edge. The boundary is then a manifold surface. */
bool spore_tetrahedra_mend(SporeTetrahedralMesh *mesh, SporeError *error);

#endif
