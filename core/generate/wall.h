/* Hollow organs: the inner surface of a wall of given thickness, and the wall. */
#ifndef SPORE_GENERATE_WALL_H
#define SPORE_GENERATE_WALL_H

#include "core/base/progress.h"
#include "core/mesh/mesh.h"

typedef struct SporeWallReport {
  double thickness_min, thickness_mean, thickness_max; /* m: from points of the outer surface to the inner one; the
                                                          greatest where the lumen ends short of a narrow part */
  double inner_min, inner_max;                         /* m: from points of the inner surface to the outer one */
  double error;       /* largest |distance from the inner surface to the outer one - thickness| / thickness */
  SporeVec3 error_at; /* where, m */
  double wall_volume, lumen_volume; /* m^3 */
  size_t pieces;                    /* of the lumen: what is narrower than the walls divides it */
  double step;                      /* m: of the lattice that the inner surface was found on */
  double seconds;
} SporeWallReport;

/* The inner surface is where the depth below the closed mesh is the thickness (m), found on a lattice: closed, outward,
 * and without intersections with itself or the mesh. detail: steps of the lattice in the thickness; 0: 4, or as many as
 * a hundredth of the diagonal asks for. Where the lumen ends in an edge, that edge is cut off within a step: there the
 * error is largest, about two thirds of a thickness over the detail (measured, liver), and half of it at twice the
 * detail. Refused, with the place of the deepest point found, where the mesh is nowhere
 * so deep. *inner is empty on failure. */
bool spore_wall_inner(const SporeTriangleMesh *outer, double thickness, double detail, SporeTriangleMesh *inner,
                      SporeWallReport *report, const SporeProgress *progress, SporeError *error);

/* One closed surface around the wall: the outer one, and the inner one turned to look into the lumen. What fills it
 * with tetrahedra needs nothing else. */
bool spore_wall_solid(const SporeTriangleMesh *outer, const SporeTriangleMesh *inner, SporeTriangleMesh *wall,
                      SporeError *error);

#endif
