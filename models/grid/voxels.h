/* Cells of a regular grid that a closed surface fills, wholly or in part. */
#ifndef SPORE_MODELS_GRID_VOXELS_H
#define SPORE_MODELS_GRID_VOXELS_H

#include "core/base/cancel.h"
#include "core/mesh/mesh.h"

/* Its axis 2 is the longest of the surface's box, axes 0 and 1 follow it, so that the three are right-handed. Cell
 * (i, j, k) has the number (i size[1] + j) size[2] + k. */
typedef struct SporeVoxels {
  int axis[3];              /* x, y or z (0, 1, 2) along each of the grid's axes */
  size_t size[3];           /* cells along the grid's axes */
  double lower[3], cell[3]; /* the first cell's corner and its edges, along the grid's axes, m */
  double *share;            /* of each cell: how much of it lies inside, 0..1 */
  size_t parts;             /* sets of filled cells that hang together by faces */
  double volume;            /* of the surface, m^3 */
} SporeVoxels;

/* Fits `cells` cells to the longest side of the surface's box, and to the other sides as many as make the cells nearly
 * cubes. The winding number tells what lies inside. A cell is empty where less than a twentieth of it lies inside.
 * Loose cells that make up less than a hundredth of all cells are emptied too. Refuses a surface that is open or holds
 * no volume, a surface thinner than a cell, and more cells than a model may have. */
bool spore_voxels_create(SporeVoxels *voxels, const SporeTriangleMesh *surface, size_t cells, const SporeCancel *cancel,
                         SporeError *error);
void spore_voxels_clear(SporeVoxels *voxels);

static inline size_t spore_voxels_count(const SporeVoxels *voxels) {
  return voxels->size[0] * voxels->size[1] * voxels->size[2];
}
static inline size_t spore_voxels_at(const SporeVoxels *voxels, size_t i, size_t j, size_t k) {
  return (i * voxels->size[1] + j) * voxels->size[2] + k;
}

#endif
