/* Surfaces from surfaces: fewer triangles for a net or a spline, hollow organs, and operations that repair a mesh. */
#ifndef SPORE_GENERATE_SURFACE_SURFACE_H
#define SPORE_GENERATE_SURFACE_SURFACE_H

#include "core/base/progress.h"
#include "core/mesh/mesh.h"
#include "core/mesh/simplify.h"

typedef struct SporeSurfaceReport {
  SporeSimplifyReport simplify;
  size_t pieces, open_edges; /* of the result */
  double hausdorff;          /* sampled, both ways, against the given surface / diagonal */
  double outline; /* largest distance between the open edges of the result and of the given surface, both ways /
                     diagonal; 0 if either has none */
  double min_angle_deg, mean_angle_deg; /* least of all; mean of the least angle of each triangle */
  double edge_min, edge_mean, edge_max; /* m */
  double area_change, volume_change;    /* relative change; the volume only if the surface is closed */
  double seconds;
} SporeSurfaceReport;

/* mesh: valid. If it has fewer vertices than wanted, all are kept, and move only where that widens angles. *result
 * is empty on failure. False: no memory, or cancelled. */
bool spore_surface_from_mesh(const SporeTriangleMesh *mesh, const SporeSimplifyOptions *options,
                             SporeTriangleMesh *result, SporeSurfaceReport *report, const SporeProgress *progress,
                             SporeError *error);

/* Hollow organs: the inner surface of a wall of given thickness, and the wall. */

#define SPORE_WALL_DETAIL 16 /* default */
#define SPORE_MOST_WALL_DETAIL 64

typedef struct SporeWallReport {
  double thickness_min, thickness_mean, thickness_max; /* m: from points of the outer surface to the inner one; the
                                                          largest is where the lumen ends before a narrow part */
  double inner_min, inner_max;                         /* m: from points of the inner surface to the outer one */
  double error;       /* largest |distance from the inner surface to the outer one - thickness| / thickness */
  SporeVec3 error_at; /* where, m */
  double wall_volume, lumen_volume; /* m^3 */
  size_t pieces;                    /* of the lumen: parts narrower than the walls divide it */
  double step;                      /* m: of the lattice on which the inner surface was first found */
  double seconds;
} SporeWallReport;

/* The inner surface is where the depth below the closed mesh is the thickness (m). It is found on a lattice, which
 * is refined at edges of the lumen where the error exceeds .56 of the thickness over the detail. The triangles are then
 * made fewer, with an error of at most .32 of the thickness over the detail where it was not larger before. The result
 * is closed, turned outward, and does not intersect itself or the mesh. detail: twice as much halves the error; 0:
 * SPORE_WALL_DETAIL, for which the error is below 5 %. Refused, with the place of the deepest point found, if the mesh
 * is nowhere so deep. *inner is empty on failure. */
bool spore_wall_inner(const SporeTriangleMesh *outer, double thickness, double detail, SporeTriangleMesh *inner,
                      SporeWallReport *report, const SporeProgress *progress, SporeError *error);

/* One closed surface around the wall: the outer surface, and the inner one turned to face the lumen. It is all that
 * a tetrahedral mesher needs. */
bool spore_wall_solid(const SporeTriangleMesh *outer, const SporeTriangleMesh *inner, SporeTriangleMesh *wall,
                      SporeError *error);

/* Operations on a mesh that an author may choose, with the figures before and after: one table for command line,
 * help and editor. */

/* The order in which several operations are applied. */
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
  bool argument_optional;         /* `usual` if the argument is not given */
  double minimum, maximum, usual; /* of the argument */
  bool whole;                     /* the argument is a whole number */
} SporeMeshOperation;

extern const SporeMeshOperation spore_mesh_operations[SPORE_MESH_OPERATIONS];

/* Whether the argument is in range, and whole if required. Any argument is valid if the operation takes none. */
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

/* Applies the operation in place; *change may be NULL. False: the argument is out of range, no memory, cancelled, or
 * the mesh would be empty; the mesh is then unchanged. */
bool spore_mesh_operate(SporeTriangleMesh *mesh, SporeMeshOperationKind operation, double argument,
                        SporeMeshChange *change, const SporeProgress *progress, SporeError *error);

#endif
