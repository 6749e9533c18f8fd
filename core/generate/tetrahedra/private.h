/* What the makers of tetrahedra share. All lengths are in diagonals of the given surface, about its centre. */
#ifndef SPORE_GENERATE_TETRAHEDRA_PRIVATE_H
#define SPORE_GENERATE_TETRAHEDRA_PRIVATE_H

#include "core/mesh/sizing.h"
#include "core/generate/tetrahedra/tetrahedra.h"
#include "core/io/tetrahedra_wire.h"
#include "core/mesh/bvh.h"

#define SPORE_TETRAHEDRA_ANGLE 10                             /* degrees: the least dihedral angle wanted */
#define SPORE_TETRAHEDRA_KEPT (SPORE_TETRAHEDRA_ANGLE + 0.75) /* that moves for another end leave */
#define SPORE_TETRAHEDRA_CLOSING 0.3 /* of one half: winding numbers in a hole of the surface */
#define SPORE_TETRAHEDRA_COUNT 0.1   /* by which the number of cells may differ, logarithm */

/* What of the solid is thinner than the cells of a lattice: points that bound such walls and slits. */
typedef struct SporeTetrahedraThin {
  double *walls, *slits; /* wall_count x 3, slit_count x 3; NULL: not looked for */
  size_t wall_count, slit_count;
  SporeBvh *wall_tree, *slit_tree; /* of them; NULL: there are none */
  double reach;                    /* that far around them the lattice has solid, or a gap */
  double small_components;         /* of the lattice's volume: small pieces that are left out */
} SporeTetrahedraThin;

typedef struct SporeTetrahedraWork {
  SporeTetrahedraOptions options; /* lengths in diagonals; tolerance set */
  SporeGenerateRegion regions[SPORE_GENERATE_REGIONS];
  SporeTriangleMesh surface; /* the given one, welded and turned alike */
  SporeBvh *tree;            /* of it */
  SporeBvh *closed;          /* with what closes its holes; NULL: it has none */
  bool open;                 /* it has holes: where the solid ends in them, and its volume, are a guess */
  double volume, area;       /* of the solid and of what bounds it */
  double *bounding, *inner;  /* points of the surface (count x 3) that bound the solid, and that lie inside it */
  size_t bounding_count, inner_count;
  SporeTetrahedraThin thin;
  bool prepared;                   /* some surface was fit for the mesher */
  double filled, filled_by_method; /* volume of cavities of the given surface, and of what a method made of it */
  const SporeProgress *progress;
  double fraction, share; /* of the progress, that the work in hand has */
} SporeTetrahedraWork;

/* The callback of a SporeProgress whose data is the work (SporeTetrahedraWork *): within the share of the work in hand.
 */
static inline bool spore_tetrahedra_report(void *data, double fraction, const char *stage) {
  const SporeTetrahedraWork *work = data;
  return spore_progress(work->progress, work->fraction + work->share * fraction, stage);
}
/* Reports within the share of the work in hand. False: cancelled, and *error says so. */
static inline bool spore_tetrahedra_progress(const SporeTetrahedraWork *work, double fraction, const char *stage,
                                             SporeError *error) {
  return spore_progress_step(work->progress, work->fraction + work->share * fraction, stage, error);
}

/* The solid: where the winding number of the surface is over one half. False with the reason: no memory, it encloses
 * nothing, cancelled. */
bool spore_tetrahedra_solid(SporeTetrahedraWork *work, SporeError *error);
/* Largest distances between the mesh and the points that bound the solid, both ways, and from the inner points. */
bool spore_tetrahedra_distances(const SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh, double *hausdorff,
                                double *inner, double *area, SporeError *error);

/* What bounds the solid, as far as it is known: the surface, and what closes its holes. */
static inline const SporeBvh *spore_tetrahedra_bounds(const SporeTetrahedraWork *work) {
  return work->closed ? work->closed : work->tree;
}
/* Where the surface is open the solid ends where its winding number falls below one half: work->closed has the faces of
 * cells of the solid that lie there. */
bool spore_tetrahedra_close(SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh, SporeError *error);

/* Brings the skin near what bounds the solid by spore_tetrahedra_approach, in as many turns as help; `surface`: the
 * solid's, or a closed one near it. */
bool spore_tetrahedra_near(const SporeTetrahedraWork *work, const SporeBvh *surface, int turns,
                           SporeTetrahedralMesh *mesh, SporeError *error);

/* By the helper. A surface that can be meshed; alpha, most_vertices: of a wrap. */
gboolean spore_tetrahedra_prepare(SporeTetrahedraWork *work, SporeTetrahedraTask task, double alpha,
                                  size_t most_vertices, SporeTriangleMesh *surface, GError **error);
gboolean spore_tetrahedra_refine(SporeTetrahedraWork *work, const SporeTriangleMesh *surface, const SporeSizing *sizing,
                                 SporeTetrahedraFinish finish, size_t most_vertices, SporeTetrahedralMesh *mesh,
                                 GError **error);

/* Drops the walls of cavities from a surface that is turned alike, and their vertices. *filled: their volume. */
bool spore_tetrahedra_fill(SporeTriangleMesh *surface, double *filled, SporeError *error);

/* A mesh in a prepared surface of the number of cells, or the size, that is asked for. */
gboolean spore_tetrahedra_fit(SporeTetrahedraWork *work, const SporeTriangleMesh *surface, SporeTetrahedralMesh *mesh,
                              GError **error);

/* Depth in the solid, m, its thin walls and slits widened; it changes by no more than the way that a point goes. */
double spore_tetrahedra_depth(const SporeTetrahedraWork *work, SporeVec3 p);
/* Adds what cells of a lattice with that edge have missed to work->thin; *farthest: how far off the worst of it is, 0
 * where there is none. */
bool spore_tetrahedra_find_thin(SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh, double edge,
                                double *farthest, SporeError *error);
void spore_tetrahedra_clear_thin(SporeTetrahedraThin *thin);

/* Cells of a lattice whose cubes have that edge, cut where the solid ends. None where it misses the solid. Notes what
 * cavities it fills. */
bool spore_tetrahedra_stuff(SporeTetrahedraWork *work, double edge, SporeTetrahedralMesh *mesh, SporeError *error);
/* Such a lattice, finer than the cells that are asked for, made coarser where that costs the least. */
bool spore_tetrahedra_voxels(SporeTetrahedraWork *work, SporeTetrahedralMesh *mesh, SporeError *error);

/* Small pieces of the cells that hang together with nothing, where their piece of the surface has a larger one, go:
 * what broke off at a part thinner than a cell. Fills pieces, pieces_given and small components of the report. */
bool spore_tetrahedra_drop_small(const SporeTetrahedraWork *work, SporeTetrahedralMesh *mesh,
                                 SporeTetrahedraReport *report, SporeError *error);

/* Plan of sizes: a relative one at each node, times a scale, under absolute bounds. */
typedef struct SporeSizingPlan {
  SporeSizing grid; /* size: scratch of the last scale */
  double *relative; /* at each node, of the scale */
  double *absolute; /* at each node, at most; never below a quarter of the scale */
} SporeSizingPlan;
bool spore_sizing_plan_create(SporeSizingPlan *plan, const SporeTetrahedraWork *work, const SporeTriangleMesh *surface,
                              SporeError *error);
void spore_sizing_plan_clear(SporeSizingPlan *plan);
/* plan->grid.size for a scale: relative x scale, absolute bounds, regions; it grows by no more than the gradation. */
void spore_sizing_plan_scale(SporeSizingPlan *plan, const SporeTetrahedraWork *work, double scale);
/* The relative size around p is `relative` at most. */
void spore_sizing_plan_refine(SporeSizingPlan *plan, SporeVec3 p, double relative);

/* The figures of a result, still in diagonals. */
bool spore_tetrahedra_measure(SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh,
                              SporeTetrahedraReport *report, SporeError *error);
/* Takes the result and its figures back to metres. */
void spore_tetrahedra_to_metres(SporeTetrahedraReport *report, const SporeTetrahedraWork *work,
                                SporeTetrahedralMesh *mesh, double diagonal, const double centre[3]);

#endif
