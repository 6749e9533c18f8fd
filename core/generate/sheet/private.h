/* Inside the generator of sheets: a surface that is cut along lines, the lines, and the patch between them. */
#ifndef SPORE_GENERATE_SHEET_PRIVATE_H
#define SPORE_GENERATE_SHEET_PRIVATE_H

#include "core/base/progress.h"
#include "core/generate/sheet/sheet.h"
#include "core/mesh/bvh.h"

#define SPORE_SHEET_NONE UINT32_MAX

/* Triangles that can be split. Half-edge h is side h % 3 of triangle h / 3, from its corner to the next one. Around a
 * vertex there is one fan of triangles: where the surface touches itself in a vertex or an edge, it is parted there. */
typedef struct SporeSheetCut {
  size_t vertex_count, triangle_count, vertex_room, triangle_room;
  double *vertices;    /* vertex_count x 3 */
  uint32_t *triangles; /* triangle_count x 3 */
  uint32_t *across;    /* a half-edge: the one that runs the other way along the same edge, or NONE: an open edge */
  uint32_t *leaving;   /* a vertex: a half-edge from it; at an open edge the one that has no triangle on its right */
  uint8_t *side;       /* a half-edge: 1 + the side of the patch that runs along it; 0: none */
  uint8_t *sides;      /* a vertex: bits of the sides that it lies on */
} SporeSheetCut;

static inline uint32_t spore_sheet_next(uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
static inline uint32_t spore_sheet_before(uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }
static inline SporeVec3 spore_sheet_vertex(const SporeSheetCut *cut, uint32_t i) {
  return spore_vec3_load(cut->vertices + 3 * (size_t)i);
}
static inline uint32_t spore_sheet_from(const SporeSheetCut *cut, uint32_t h) { return cut->triangles[h]; }
static inline uint32_t spore_sheet_to(const SporeSheetCut *cut, uint32_t h) {
  return cut->triangles[spore_sheet_next(h)];
}
/* The next half-edge from the same vertex, counter-clockwise; NONE behind the last one of an open fan. */
static inline uint32_t spore_sheet_turn(const SporeSheetCut *cut, uint32_t h) {
  return cut->across[spore_sheet_before(h)];
}

/* cut.c. False: no memory; clear it in either case. */
bool spore_sheet_cut_create(SporeSheetCut *cut, const SporeTriangleMesh *mesh, SporeError *error);
void spore_sheet_cut_clear(SporeSheetCut *cut);
/* A new vertex on the half-edge, at this share of its length from its start; *vertex is its number. A half-edge whose
 * ends are not those of h keeps its ends, but may get another number. False: no memory. */
bool spore_sheet_cut_split_edge(SporeSheetCut *cut, uint32_t h, double share, uint32_t *vertex, SporeError *error);
/* A new vertex in a triangle. */
bool spore_sheet_cut_split_triangle(SporeSheetCut *cut, uint32_t triangle, SporeVec3 at, uint32_t *vertex,
                                    SporeError *error);
/* A half-edge from a to b; *h: it, or the one from b to a where only that exists. False: there is no such edge. */
bool spore_sheet_cut_find(const SporeSheetCut *cut, uint32_t a, uint32_t b, uint32_t *h);
/* Nearest triangle to a point, and the place on it. */
uint32_t spore_sheet_cut_nearest(const SporeSheetCut *cut, SporeVec3 p, SporeVec3 *nearest);

/* find.c: the vertices of the shortest path along edges, from one vertex to another: count of them from spore_allocate.
 * *path NULL: there is none. False: no memory. */
bool spore_sheet_find_path(const SporeSheetCut *cut, uint32_t from, uint32_t to, uint32_t **path, size_t *count,
                           SporeError *error);

/* A place that a line passes: a vertex (b NONE), or the edge from a to b at `share` of its length. */
typedef struct SporeSheetStop {
  uint32_t a, b;
  double share;
} SporeSheetStop;

/* path.c: makes a path along edges the shortest one over faces that its neighbourhood has. *stops: *stop_count from
 * spore_allocate, first and last of them the ends. Vertices whose `sides` are not 0 are only passed where the path hits
 * them. */
bool spore_sheet_straighten(const SporeSheetCut *cut, const uint32_t *path, size_t count, SporeSheetStop **stops,
                            size_t *stop_count, SporeError *error);

/* side.c: makes the four corners vertices, and cuts the four sides into the surface. */
bool spore_sheet_cut_sides(SporeSheetCut *cut, const SporeSheetOptions *options, SporeSheetReport *report,
                           SporeError *error);

/* region.c: the patch between the sides. */
bool spore_sheet_take_patch(SporeSheetCut *cut, const SporeSheetOptions *options, SporeTriangleMesh *patch,
                            SporeError *error);

/* measure.c: a patch with its parameters. */
typedef struct SporeSheetFitting {
  const SporeTriangleMesh *patch;
  double *parameters; /* vertex_count x 2 */
  double smoothing;   /* m */
  SporeBvh *bvh;      /* of the patch */
  const SporeProgress *progress;
  double done; /* share of the work, for the progress */
} SporeSheetFitting;
/* Fits a sheet of so many control points, and fills the report's figures of it. distance: vertex_count, m, or NULL. */
bool spore_sheet_measure(const SporeSheetFitting *fitting, const size_t points[2], double *distance,
                         SporeSheetReport *report, SporeError *error);

#endif
