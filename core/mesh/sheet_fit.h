/* Cubic B-splines both ways, fitted to a sheet. */
#ifndef SPORE_MESH_SHEET_FIT_H
#define SPORE_MESH_SHEET_FIT_H

#include "core/mesh/mesh.h"

/* Control points of the sheet of uniform, clamped B-splines nearest in the mean square to the mesh, whose vertices have
 * the parameters (vertex_count x 2, 0 to 1); control: (span[0] + 3) (span[1] + 3) x 3, u runs first. smoothing (m, 0:
 * none): with it the sheet minimises also the square of its second derivatives along u and along v, so weighed that a
 * wave of this length comes to half its height, a shorter wave to less (P-splines: Eilers and Marx 1996). False: no
 * memory. */
bool spore_sheet_fit(const SporeTriangleMesh *mesh, const double *parameters, const size_t span[2], double smoothing,
                     double *control);

#endif
