/* The parts of finding where a field vanishes: tetrahedra that are bisected where that is wanted. */
#ifndef SPORE_MESH_ISOSURFACE_PARTS_H
#define SPORE_MESH_ISOSURFACE_PARTS_H

#include <assert.h>

#include "core/mesh/isosurface.h"

#define SPORE_ISOSURFACE_ON                                                                                            \
  1e-9 /* of the step: as near to a point counts as inside of it, so that no triangle is without size */

typedef struct SporeIsosurfacePoint {
  SporeVec3 place;
  double value;   /* m */
  uint32_t stamp; /* the pass in which an edge of it was last split */
  bool on;        /* moved onto the surface; it counts as inside */
} SporeIsosurfacePoint;

/* A tetrahedron that the surface may go through: its next edge to be split is that from its first corner to corner
 * `tag` (Maubach 1995). */
typedef struct SporeIsosurfaceCell {
  uint32_t corner[4];
  uint8_t tag; /* 3, 2, 1; 0: gone */
  uint8_t level;
  bool settled; /* near enough */
} SporeIsosurfaceCell;

typedef struct SporeIsosurfaceCells {
  SporeDistanceField field;
  void *data;
  double step;
  SporeIsosurfacePoint *points;
  size_t point_count, point_capacity;
  SporeIsosurfaceCell *cells;
  size_t cell_count, cell_capacity;
  uint64_t *keys; /* of a hash table: edges that are split, see spore_isosurface_edge; UINT64_MAX: none */
  uint32_t *entries;
  size_t slots, used;
  uint32_t pass;
  SporeIsosurfacePoint *home; /* of each point, before any was moved onto the surface; NULL: none was */
} SporeIsosurfaceCells;

static inline uint64_t spore_isosurface_edge(uint32_t a, uint32_t b) {
  return a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
}

/* The value of a key; UINT32_MAX where the key is new, and the caller then fills it in. NULL: no memory. */
uint32_t *spore_isosurface_entry(SporeIsosurfaceCells *cells, uint64_t key);
/* Adds a point and returns its number; UINT32_MAX: no memory. */
uint32_t spore_isosurface_add_point(SporeIsosurfaceCells *cells, SporeVec3 place, double value);
/* Adds a cell. A cell is left out where no corner is near enough for the surface to pass through. False: no memory. */
bool spore_isosurface_add_cell(SporeIsosurfaceCells *cells, const SporeIsosurfaceCell *cell);
/* Triangles of the surface in a cell, 0 to 2: each corner is the edge of two points that it lies on, inside first. */
size_t spore_isosurface_cut(const SporeIsosurfaceCells *cells, const SporeIsosurfaceCell *cell,
                            uint32_t triangles[2][3][2]);
/* The point between two points at which the field vanishes, if it is taken as linear. */
SporeVec3 spore_isosurface_between(const SporeIsosurfaceCells *cells, const uint32_t edge[2]);
/* The place between two points on both sides at which the field vanishes, by false position. It lies between them for
 * any field. */
SporeVec3 spore_isosurface_root(const SporeIsosurfaceCells *cells, SporeIsosurfacePoint in, SporeIsosurfacePoint out);
/* Moves points onto the surface where one of their edges is crossed nearby, as long as what is inside hangs together as
 * before and no cell turns over. False: no memory, or cancelled. */
bool spore_isosurface_snap(SporeIsosurfaceCells *cells, const SporeProgress *progress, SporeError *error);
/* Whether a triangle is farther than the tolerance (m) from where the field vanishes, at its centre or in the middle of
 * a side. */
bool spore_isosurface_is_off(const SporeIsosurfaceCells *cells, const SporeVec3 p[3], double tolerance);
/* Takes points back that make the surface's mesh touch itself, or stray farther than the tolerance (m); changed: how
 * many. edges: of each vertex of the mesh, spore_isosurface_edge of what it lies on: twice the same point, where the
 * point was moved there. fresh: vertices that were not looked at before. False: no memory. */
bool spore_isosurface_unsnap(SporeIsosurfaceCells *cells, const SporeTriangleMesh *mesh, const uint64_t *edges,
                             const bool *fresh, double tolerance, size_t *changed, SporeError *error);
/* Bisects until the surface is within the tolerance (m). False: no memory, or cancelled. */
bool spore_isosurface_refine(SporeIsosurfaceCells *cells, double tolerance, const SporeProgress *progress,
                             SporeError *error);
void spore_isosurface_clear(SporeIsosurfaceCells *cells);

#endif
