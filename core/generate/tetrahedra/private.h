/* Declarations shared by the methods for tetrahedra. Lengths are in units of the given surface's diagonal; the origin
 * is its centre. */
#ifndef SPORE_GENERATE_TETRAHEDRA_PRIVATE_H
#define SPORE_GENERATE_TETRAHEDRA_PRIVATE_H

#include "core/mesh/sizing.h"
#include "core/generate/tetrahedra/tetrahedra.h"
#include "core/io/tetrahedra_wire.h"
#include "core/mesh/bvh.h"

#define SPORE_TETRAHEDRA_TOLERANCE 0.01                       /* of the diagonal, where none is given */
#define SPORE_TETRAHEDRA_ANGLE 10                             /* degrees: the least dihedral angle wanted */
#define SPORE_TETRAHEDRA_KEPT (SPORE_TETRAHEDRA_ANGLE + 0.75) /* kept by moves that serve another purpose */
#define SPORE_TETRAHEDRA_CLOSING 0.3 /* a winding number nearer than this to one half lies in a hole of the surface */
#define SPORE_TETRAHEDRA_CELL 0.12   /* volume of a cell whose edges have length 1 */
#define SPORE_TETRAHEDRA_THIN 0.8    /* edges: pieces as thin as that are merged where there are too many cells */
#define SPORE_TETRAHEDRA_SEEN 0.3    /* edges: thinner pieces may have no cell in the first lattice */
#define SPORE_TETRAHEDRA_COUNT 0.1   /* tolerance of the number of cells, as a logarithm */

/* Parts of the solid thinner than the cells of a lattice: points that bound such walls and slits. */
typedef struct SporeTetrahedraThin {
  double *walls, *slits; /* wall_count x 3, slit_count x 3; NULL: not searched */
  size_t wall_count, slit_count;
  SporeBvh *wall_tree, *slit_tree; /* of walls and of slits; NULL: none */
  double reach;                    /* radius around these points in which the lattice has solid, or a gap */
  double small_components;         /* share of the lattice's volume: small pieces that are left out */
} SporeTetrahedraThin;

typedef struct SporeTetrahedraWork {
  SporeTetrahedraOptions options; /* lengths in diagonals; tolerance set */
  SporeGenerateRegion regions[SPORE_GENERATE_REGIONS];
  SporeTriangleMesh surface; /* the given surface, welded and oriented consistently */
  uint32_t *parts;           /* of each triangle the part of its file; NULL: of one */
  SporeBvh *tree;            /* of the surface */
  SporeBvh *closed;          /* of the surface and the faces that close its holes; NULL: no such faces known */
  bool open;                 /* the surface has holes: the end of the solid there, and its volume, are estimates */
  double volume, area;       /* of the solid and of its boundary */
  double *bounding, *inner;  /* points of the surface (count x 3) that bound the solid, and that lie inside the solid */
  size_t bounding_count, inner_count;
  double *borders; /* with options.apart: the inner points between two pieces that are kept apart (border_count x 3) */
  uint32_t *border_sides; /* border_count x 2: 1 + the pieces on the two sides of each */
  size_t border_count;
  double border_lost; /* share of the borders that lay where a piece is too thin for the first lattice: left out */
  SporeTetrahedraPiece piece[SPORE_TETRAHEDRA_PIECES]; /* of the surface */
  size_t unwanted;                                     /* pieces that were left out as asked */
  size_t piece_count, pieces;                          /* told of, and all */
  bool mixed;                                          /* one of these lies inside another one, all or in part */
  SporeTetrahedraThin thin;
  bool prepared;                   /* a surface could be prepared for the mesher */
  double filled, filled_by_method; /* volume of filled cavities: of the given surface, and of the surface or lattice
                                      that a method made */
  const SporeProgress *progress;
  double fraction, share; /* of the progress: start and length of the current step */
} SporeTetrahedraWork;

/* The callback of a SporeProgress whose data is the SporeTetrahedraWork. Reports within the share of the current step.
 */
static inline bool spore_tetrahedra_report(void *data, double fraction, const char *stage) {
  const SporeTetrahedraWork *work = data;
  return spore_progress(work->progress, work->fraction + work->share * fraction, stage);
}
/* Reports within the share of the current step. False: cancelled, and *error says so. */
static inline bool spore_tetrahedra_progress(const SporeTetrahedraWork *work, double fraction, const char *stage,
                                             SporeError *error) {
  return spore_progress_step(work->progress, work->fraction + work->share * fraction, stage, error);
}

/* The solid: where the winding number of the surface is over one half. False with *error: no memory, the surface
 * encloses nothing, cancelled. */
bool spore_tetrahedra_solid(SporeTetrahedraWork *work, SporeError *error);
/* Fills piece, piece_count, pieces and mixed. */
bool spore_tetrahedra_look_at_pieces(SporeTetrahedraWork *work, SporeError *error);
/* The trees of work->piece, in that order: piece_count of them, in an array of SPORE_TETRAHEDRA_PIECES. Each is freed
 * by spore_bvh_free. False: no memory or cancelled; none is left. */
bool spore_tetrahedra_piece_trees(const SporeTetrahedraWork *work, SporeBvh **trees, SporeError *error);
/* Turns closed pieces outward or inward, so that one inside another one bounds a cavity, and one inside a cavity is
 * solid. Pieces that come turned inward stay so. Looks at the SPORE_TETRAHEDRA_PIECES largest pieces. */
bool spore_tetrahedra_hollow(SporeTetrahedraWork *work, SporeError *error);
/* Keeps the piece of the largest area, and the pieces that lie wholly inside it. Sets work->unwanted. */
bool spore_tetrahedra_keep_largest(SporeTetrahedraWork *work, SporeError *error);
/* Appends a line about each piece of the report, where there are several or one has holes. */
void spore_tetrahedra_say_pieces(GString *text, const SporeTetrahedraOptions *options,
                                 const SporeTetrahedraReport *report);
/* About how many cells in all a piece of that thickness takes to have cells of its own, to two digits. */
double spore_tetrahedra_cells_for(const SporeTetrahedraReport *report, const SporeTetrahedraPiece *piece);
/* What to call a piece: by the name of its part, with a number where several pieces have the same name. g_free. */
char *spore_tetrahedra_piece_called(const SporeTetrahedraReport *report, int number);
/* Appends a line about each kind of wall inside: how many pieces, which, their holes, and what to do. */
void spore_tetrahedra_say_walls(GString *text, const SporeTetrahedraReport *report);
/* Largest distances between the mesh and the points that bound the solid, both ways, and from the inner points. */
bool spore_tetrahedra_distances(const SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh, double *hausdorff,
                                double *inner, double *area, SporeError *error);

/* The known bounds of the solid: the surface, and the faces that close its holes. */
static inline const SporeBvh *spore_tetrahedra_bounds(const SporeTetrahedraWork *work) {
  return work->closed ? work->closed : work->tree;
}
/* Where the surface is open, the solid ends where the winding number falls below one half. Sets work->closed: the
 * surface and the boundary faces of the mesh that lie there. */
bool spore_tetrahedra_close(SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh, SporeError *error);

/* Moves the skin toward the bounds of the solid by spore_tetrahedra_approach, in at most `turns` turns, while the
 * distance falls. `surface`: of the solid, or a closed one near it. */
bool spore_tetrahedra_near(const SporeTetrahedraWork *work, const SporeBvh *surface, int turns,
                           SporeTetrahedralMesh *mesh, SporeError *error);

/* By the helper. Makes a surface that can be meshed. alpha, most_vertices: of a wrap. */
gboolean spore_tetrahedra_prepare(SporeTetrahedraWork *work, SporeTetrahedraTask task, double alpha,
                                  size_t most_vertices, SporeTriangleMesh *surface, GError **error);
gboolean spore_tetrahedra_refine(SporeTetrahedraWork *work, const SporeTriangleMesh *surface, const SporeSizing *sizing,
                                 SporeTetrahedraFinish finish, size_t most_vertices, SporeTetrahedralMesh *mesh,
                                 GError **error);

/* Drops the walls of cavities, and their vertices, from a consistently oriented surface. tags: one a triangle, which go
 * with those that stay; NULL: none. *filled: volume of the cavities. */
bool spore_tetrahedra_fill(SporeTriangleMesh *surface, uint32_t *tags, double *filled, SporeError *error);

/* A mesh in a prepared surface, of the wanted number or size of cells. */
gboolean spore_tetrahedra_fit(SporeTetrahedraWork *work, const SporeTriangleMesh *surface, SporeTetrahedralMesh *mesh,
                              GError **error);

/* Signed depth in the solid, its thin walls and slits widened. The depth is 1-Lipschitz: it changes by no more than the
 * point moves. */
double spore_tetrahedra_depth(const SporeTetrahedraWork *work, SporeVec3 p);
/* Adds what the cells of a lattice with that edge have missed to work->thin. *farthest: largest distance of a missed
 * point from the cells; 0: none is missed. */
bool spore_tetrahedra_find_thin(SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh, double edge,
                                double *farthest, SporeError *error);
void spore_tetrahedra_clear_thin(SporeTetrahedraThin *thin);

/* Cells of a lattice whose cubes have that edge, cut at the boundary of the solid. No cells if the lattice misses the
 * solid. Sets work->filled_by_method. */
bool spore_tetrahedra_stuff(SporeTetrahedraWork *work, double edge, SporeTetrahedralMesh *mesh, SporeError *error);
/* Makes such a lattice finer than the wanted cells, then coarsens it where this costs least. */
bool spore_tetrahedra_voxels(SporeTetrahedraWork *work, SporeTetrahedralMesh *mesh, SporeError *error);

/* Gives each cell to a piece: mesh->labels. Sets `parted` of work->piece, and work->borders. False: no memory or
 * cancelled. */
bool spore_tetrahedra_part(SporeTetrahedraWork *work, SporeTetrahedralMesh *mesh, SporeError *error);
/* Islands of cells (of one label, by faces) of less than this volume, except the largest of each label, go to the
 * label that they touch most. */
bool spore_tetrahedra_join_islands(SporeTetrahedralMesh *mesh, double least, SporeError *error);
/* Fills `thickness` of those of work->piece that have cells: 4 volume / area of their place. */
bool spore_tetrahedra_measure_places(SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh, SporeError *error);
/* Of the pieces thinner than SPORE_TETRAHEDRA_THIN edges that touch another one, takes the one with most cells beyond
 * those of that edge that its volume has room for. The smaller one of that piece and of the one that it touches most is
 * merged with the larger one, and its `merged` is set. *merged: whether there was such a piece. */
bool spore_tetrahedra_merge_thin(SporeTetrahedraWork *work, SporeTetrahedralMesh *mesh, double edge, bool *merged,
                                 SporeError *error);
/* Fills `cells` of work->piece, and shared_faces and border_distance of the report. */
bool spore_tetrahedra_measure_parted(SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh,
                                     SporeTetrahedraReport *report, SporeError *error);
/* At most `most` points that bound the solid, and as many on work->borders, with their hosts. The caller clears them.
 */
bool spore_tetrahedra_points(const SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh, size_t most,
                             SporeSkinPoints *points, SporeError *error);

/* Drops small disconnected pieces of the cells whose piece of the surface has a larger piece of cells. Such pieces
 * break off at a part thinner than a cell. Fills pieces, pieces_given and small_components of the report. */
bool spore_tetrahedra_drop_small(const SporeTetrahedraWork *work, SporeTetrahedralMesh *mesh,
                                 SporeTetrahedraReport *report, SporeError *error);

/* Plan of sizes: a relative size at each node, times a scale, under absolute bounds. */
typedef struct SporeSizingPlan {
  SporeSizing grid; /* size: result for the last scale */
  double *relative; /* at each node, as a fraction of the scale */
  double *absolute; /* upper bound at each node; a bound below a quarter of the scale is raised to that quarter */
  double *regions;  /* upper bound at each node, by the balls of regions */
} SporeSizingPlan;
bool spore_sizing_plan_create(SporeSizingPlan *plan, const SporeTetrahedraWork *work, const SporeTriangleMesh *surface,
                              SporeError *error);
void spore_sizing_plan_clear(SporeSizingPlan *plan);
/* plan->grid.size for a scale: relative x scale, absolute bounds, regions; the size grows by no more than the
 * gradation. */
void spore_sizing_plan_scale(SporeSizingPlan *plan, double scale);
/* Bounds the relative size around p by `relative`. */
void spore_sizing_plan_refine(SporeSizingPlan *plan, SporeVec3 p, double relative);

/* The figures of a result, still in diagonals. */
bool spore_tetrahedra_measure(SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh,
                              SporeTetrahedraReport *report, SporeError *error);
/* Converts the result and its figures back to metres. */
void spore_tetrahedra_to_metres(SporeTetrahedraReport *report, const SporeTetrahedraWork *work,
                                SporeTetrahedralMesh *mesh, double diagonal, const double centre[3]);

#endif
