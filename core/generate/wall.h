/* Hollow organs: the inner surface of a wall of given thickness, and the wall. */
#ifndef SPORE_GENERATE_WALL_H
#define SPORE_GENERATE_WALL_H

#include "core/base/progress.h"
#include "core/mesh/mesh.h"

#define SPORE_WALL_DETAIL 16 /* where none is asked for */

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

#endif
