/* What is seen of a tetrahedral mesh that is cut open, or whose cells are drawn apart. */
#ifndef SPORE_MESH_CELL_FACES_H
#define SPORE_MESH_CELL_FACES_H

#include "core/mesh/mesh.h"

typedef struct SporeCellView {
  SporeVec3 direction; /* cells whose middle lies beyond `beyond` along it are left out; length 0: none is */
  double beyond;       /* m */
  double shrink; /* each cell drawn about its middle by this factor, (0, 1]; 1: faces between two cells are left out */
} SporeCellView;

/* Triangles of three vertices of their own, so that each shows the value of its one cell and no smooth edge. */
typedef struct SporeCellFaces {
  size_t triangle_count;
  double *vertices; /* 3 x triangle_count x 3: corners counter-clockwise seen from outside */
  uint32_t *cells;  /* triangle_count: whose it is */
} SporeCellFaces;

/* spore_cell_faces_clear gives back what *faces holds, also where nothing is seen. False: no memory. */
bool spore_cell_faces(const SporeTetrahedralMesh *mesh, const SporeCellView *view, SporeCellFaces *faces,
                      SporeError *error);
void spore_cell_faces_clear(SporeCellFaces *faces);

#endif
