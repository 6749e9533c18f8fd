/* Two parameters for each point of an open sheet, as a tensor-product spline needs them. */
#ifndef SPORE_MESH_SHEET_PARAMETERS_H
#define SPORE_MESH_SHEET_PARAMETERS_H

#include "core/base/cancel.h"
#include "core/mesh/mesh.h"

/* u and v from 0 to 1 for each vertex (vertex_count x 2; those of no triangle stay 0). The sheet's outline becomes the
 * unit square: its corners are the outermost points along the diagonals of the narrowest rectangle around the outline,
 * seen across the plane nearest to the sheet, u along the longer side; or the vertices of the outline nearest to
 * `corners` (4 x 3, in turn around the sheet; NULL: none are given), u along the longer two sides. Between corners by
 * length. Inside each vertex
 * lies at the mean of its neighbours by mean value weights (Floater 2003), which are positive: no triangle folds over,
 * and a flat rectangle keeps its proportions. Without given corners, neither the order of vertices nor that of
 * triangles matters. Refused: a mesh that is closed, in several pieces, has holes, branches, triangles without area, or
 * no four corners. False: also where it was cancelled; there is no error then. */
bool spore_sheet_parameters(const SporeTriangleMesh *mesh, const double *corners, double *parameters,
                            const SporeCancel *cancel, SporeError *error);

#endif
