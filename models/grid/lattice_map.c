/* Points that follow the corners of a grid's cells. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/grid/lattice.h"

/* A point in units of cells from the first corner of the grid, and the filled cell that the point follows. */
typedef struct Located {
  double at[3];
  size_t cell[3];
} Located;

static bool is_filled(const SporeVoxels *voxels, const size_t cell[3]) {
  assert(cell[0] < voxels->size[0] && cell[1] < voxels->size[1] && cell[2] < voxels->size[2]);
  return voxels->share[spore_voxels_at(voxels, cell[0], cell[1], cell[2])] > 0;
}

/* Squared distance from the cell, m^2. */
static double distance(const SporeVoxels *voxels, const double at[3], const size_t cell[3]) {
  double sum = 0;
  for (int k = 0; k < 3; k++) {
    double low = (double)cell[k], off = at[k] - fmin(fmax(at[k], low), low + 1);
    sum += off * off * voxels->cell[k] * voxels->cell[k];
  }
  return sum;
}

/* Looks through all cells: few points lie in none. */
static void find_nearest(const SporeVoxels *voxels, Located *point) {
  double least = HUGE_VAL;
  size_t cell[3];
  for (cell[0] = 0; cell[0] < voxels->size[0]; cell[0]++)
    for (cell[1] = 0; cell[1] < voxels->size[1]; cell[1]++)
      for (cell[2] = 0; cell[2] < voxels->size[2]; cell[2]++) {
        double off = distance(voxels, point->at, cell);
        if (!(off < least) || !is_filled(voxels, cell)) continue;
        least = off;
        memcpy(point->cell, cell, sizeof cell);
      }
}

static Located locate(const SporeVoxels *voxels, const double *p) {
  Located point;
  for (int k = 0; k < 3; k++) {
    point.at[k] = (p[voxels->axis[k]] - voxels->lower[k]) / voxels->cell[k];
    point.cell[k] = (size_t)fmin(fmax(floor(point.at[k]), 0), (double)voxels->size[k] - 1);
  }
  if (!is_filled(voxels, point.cell)) find_nearest(voxels, &point);
  return point;
}

/* Trilinear weights at the place of the cell nearest to the point, extended from there by their gradients. */
static void weigh(const Located *point, double weights[8]) {
  double upper[3], beyond[3];
  for (int k = 0; k < 3; k++) {
    double local = point->at[k] - (double)point->cell[k];
    upper[k] = fmin(fmax(local, 0), 1);
    beyond[k] = local - upper[k];
  }
  for (unsigned c = 0; c < 8; c++) {
    double share[3], sign[3];
    for (int k = 0; k < 3; k++) {
      bool high = c >> (2 - k) & 1;
      share[k] = high ? upper[k] : 1 - upper[k];
      sign[k] = high ? 1 : -1;
    }
    weights[c] = share[0] * share[1] * share[2];
    for (int k = 0; k < 3; k++) weights[c] += sign[k] * beyond[k] * share[(k + 1) % 3] * share[(k + 2) % 3];
  }
}

bool spore_lattice_map(const SporeLattice *lattice, const double *points, size_t count, const SporeCancel *cancel,
                       SporeMapping *mapping, SporeError *error) {
  assert(count == 0 || points);
  if (count == lattice->node_count && !memcmp(points, lattice->rest, 3 * count * sizeof *points))
    return spore_mapping_init_identity(mapping, count);
  uint32_t *nodes = SPORE_NEW_ARRAY(uint32_t, 8 * count);
  double *weights = SPORE_NEW_ARRAY(double, 8 * count);
  bool made = nodes && weights;
  if (!made) spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for %zu points"), count);
  for (size_t i = 0; made && i < count && (made = spore_mapping_goes_on(cancel, error)); i++) {
    Located point = locate(&lattice->voxels, points + 3 * i);
    for (unsigned c = 0; c < 8; c++)
      nodes[8 * i + c] = spore_lattice_corner(lattice, point.cell[0], point.cell[1], point.cell[2], c);
    weigh(&point, weights + 8 * i);
  }
  made = made && spore_mapping_init_linear(mapping, count, 8, nodes, weights, error);
  spore_free(nodes);
  spore_free(weights);
  return made;
}
