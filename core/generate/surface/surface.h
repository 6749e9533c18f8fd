/* Surfaces from surfaces: fewer triangles for a net or a spline, hollow organs, and what a mesh is mended by. */
#ifndef SPORE_GENERATE_SURFACE_SURFACE_H
#define SPORE_GENERATE_SURFACE_SURFACE_H

#include "core/base/progress.h"
#include "core/mesh/mesh.h"
#include "core/mesh/simplify.h"

typedef struct SporeSurfaceReport {
  SporeSimplifyReport simplify;
  size_t pieces, open_edges;            /* of the result */
  double hausdorff;                     /* sampled, both ways, against the given surface / diagonal */
  double outline;                       /* largest distance between its open edges and the given one's, both ways /
                                           diagonal; 0 where it is closed */
  double min_angle_deg, mean_angle_deg; /* least of all; mean of each triangle's least */
  double edge_min, edge_mean, edge_max; /* m */
  double area_change, volume_change;    /* share that was gained; the volume only where the surface is closed */
  double seconds;
} SporeSurfaceReport;

/* Valid mesh. Fewer vertices than wanted: all are kept, and only moved where that widens angles. *result is empty on
 * failure. False: no memory, or cancelled. */
bool spore_surface_from_mesh(const SporeTriangleMesh *mesh, const SporeSimplifyOptions *options,
                             SporeTriangleMesh *result, SporeSurfaceReport *report, const SporeProgress *progress,
                             SporeError *error);

/* Hollow organs: the inner surface of a wall of given thickness, and the wall. */

#define SPORE_WALL_DETAIL 16 /* where none is asked for */
#define SPORE_MOST_WALL_DETAIL 64

typedef struct SporeWallReport {
  double thickness_min, thickness_mean, thickness_max; /* m: from points of the outer surface to the inner one; the
                                                          greatest where the lumen ends short of a narrow part */
  double inner_min, inner_max;                         /* m: from points of the inner surface to the outer one */
  double error;       /* largest |distance from the inner surface to the outer one - thickness| / thickness */
  SporeVec3 error_at; /* where, m */
  double wall_volume, lumen_volume; /* m^3 */
  size_t pieces;                    /* of the lumen: what is narrower than the walls divides it */
  double step;                      /* m: of the lattice that the inner surface was first found on */
  double seconds;
} SporeWallReport;

/* The inner surface is where the depth below the closed mesh is the thickness (m), found on a lattice that is refined
 * where that is off by more than .56 of a thickness over the detail, at edges of the lumen, then made of as few
 * triangles as are off by no more than .32 of it, where they were not before: closed, outward, and without
 * intersections with itself or the mesh. detail: twice as much halves the error; 0: SPORE_WALL_DETAIL, for which that
 * is below 5 %. Refused, with the place of the deepest point found, where the mesh is nowhere so deep. *inner is empty
 * on failure. */
bool spore_wall_inner(const SporeTriangleMesh *outer, double thickness, double detail, SporeTriangleMesh *inner,
                      SporeWallReport *report, const SporeProgress *progress, SporeError *error);

/* One closed surface around the wall: the outer one, and the inner one turned to look into the lumen. What fills it
 * with tetrahedra needs nothing else. */
bool spore_wall_solid(const SporeTriangleMesh *outer, const SporeTriangleMesh *inner, SporeTriangleMesh *wall,
                      SporeError *error);

/* What an author may have done to a mesh, with the figures before and after: one table for command line, help and
 * editor. */

/* In the order in which several are done. */
typedef enum SporeMeshOperationKind {
  SPORE_MESH_WELD,
  SPORE_MESH_CLEAN,
  SPORE_MESH_ORIENT,
  SPORE_MESH_FILL_HOLES,
  SPORE_MESH_SMOOTH,
  SPORE_MESH_DECIMATE,
  SPORE_MESH_OPERATIONS
} SporeMeshOperationKind;

typedef struct SporeMeshOperation {
  const char *name;               /* of the option and in reports: "fill-holes" */
  const char *label, *doc;        /* translatable */
  const char *argument;           /* "EDGES"; NULL: it takes none */
  const char *argument_label;     /* translatable */
  bool argument_optional;         /* `usual` where it is not given */
  double minimum, maximum, usual; /* of the argument */
  bool whole;                     /* it is a whole number */
} SporeMeshOperation;

extern const SporeMeshOperation spore_mesh_operations[SPORE_MESH_OPERATIONS];

/* In range, and whole where it must be; any where the operation takes none. */
bool spore_mesh_argument_is_valid(const SporeMeshOperation *operation, double argument);

typedef struct SporeMeshFigures {
  size_t vertices, triangles;
  SporeMeshReport report;
} SporeMeshFigures;
bool spore_mesh_figures(const SporeTriangleMesh *mesh, SporeMeshFigures *figures, SporeError *error);

typedef struct SporeMeshChange {
  SporeMeshOperationKind operation;
  double argument;
  SporeMeshFigures before, after;
  double moved; /* m, sampled Hausdorff distance, both ways, between the surface before and after */
} SporeMeshChange;

/* Does it in place; *change may be NULL. False: the argument is out of range, no memory, cancelled, or nothing would be
 * left; the mesh is then as it was. */
bool spore_mesh_operate(SporeTriangleMesh *mesh, SporeMeshOperationKind operation, double argument,
                        SporeMeshChange *change, const SporeProgress *progress, SporeError *error);

#endif
