/* The edge all around an open sheet, and where its four corners are. */
#ifndef SPORE_MESH_SHEET_OUTLINE_H
#define SPORE_MESH_SHEET_OUTLINE_H

#include "core/mesh/mesh.h"

/* Vertices in turn, counter-clockwise about the normal. */
typedef struct SporeSheetOutline {
  const SporeTriangleMesh *mesh; /* borrowed */
  size_t count;
  uint32_t *vertex;
  double *at; /* count x 2, along the axes */
  SporeVec3 u, v, normal;
} SporeSheetOutline;

/* Refused: a mesh that is closed, in several pieces, has holes, branches or triangles without area; clear it then too.
 */
bool spore_sheet_outline_create(SporeSheetOutline *outline, const SporeTriangleMesh *mesh, SporeError *error);
void spore_sheet_outline_clear(SporeSheetOutline *outline);
/* Makes the outline the unit square, as spore_sheet_parameters says: parameters of its vertices alone. Refused: one
 * without four corners, or corners (4 x 3; NULL: none are given) that are not four, in turn around it. */
bool spore_sheet_outline_square(SporeSheetOutline *outline, const double *corners, double *parameters,
                                SporeError *error);

#endif
