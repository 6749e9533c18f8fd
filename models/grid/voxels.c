/* Which cells of a regular grid a closed surface fills, and how far. */
#include "models/grid/voxels.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/mesh/bvh.h"

#define LEAST 0.05 /* share of a cell below which it is empty */
#define LOOSE 0.01 /* of the volume: what may be left out of it, where it does not hang together with the rest */
#define PARTS 4    /* of a cell along an edge, where the surface cuts it */
#define MOST_FILLED 200000 /* cells that a model is made of, about */
#define MOST 2e6           /* cells of the box */

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a grid"));
}

static bool fit(SporeVoxels *voxels, const SporeMeshReport *report, size_t cells, SporeError *error) {
  double length[3], count = 1;
  int longest = 0;
  for (int k = 0; k < 3; k++) length[k] = report->upper[k] - report->lower[k];
  for (int k = 1; k < 3; k++)
    if (length[k] > length[longest]) longest = k;
  double cell = length[longest] / (double)cells;
  for (int k = 0; k < 3; k++) {
    int axis = voxels->axis[k] = (longest + 1 + k) % 3;
    if (length[axis] < 0.5 * cell)
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("the surface is %.3g m thick, less than half a cell of %.3g m; expected a cell or more; "
                               "ask for at least %.0f cells, or choose another model for something so thin"),
                             length[axis], cell, ceil(length[longest] / length[axis]));
    voxels->size[k] = (size_t)fmax(1, nearbyint(length[axis] / cell));
    voxels->cell[k] = length[axis] / (double)voxels->size[k];
    voxels->lower[k] = report->lower[axis];
    count *= (double)voxels->size[k];
  }
  double volume = voxels->cell[0] * voxels->cell[1] * voxels->cell[2], filled = fabs(report->volume) / volume;
  if (filled > MOST_FILLED)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("%zu cells along the longest side make about %.2g inside the surface; expected at most "
                             "%d; ask for fewer cells"),
                           cells, filled, MOST_FILLED);
  return count <= MOST || spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                                          _("the surface's box has %.2g cells; expected at most %.2g; ask for fewer "
                                            "cells"),
                                          count, MOST);
}

/* The point at (x, y, z) cells from the first corner. */
static SporeVec3 point_at(const SporeVoxels *voxels, double x, double y, double z) {
  const double at[3] = {x, y, z};
  double p[3];
  for (int k = 0; k < 3; k++) p[voxels->axis[k]] = voxels->lower[k] + at[k] * voxels->cell[k];
  return spore_vec3(p[0], p[1], p[2]);
}

/* By the depth in the middle of its parts: of a plane through one along an axis of the grid, exact. */
static double share_of(const SporeVoxels *voxels, const SporeBvh *bvh, size_t i, size_t j, size_t k) {
  assert(i < voxels->size[0] && j < voxels->size[1] && k < voxels->size[2]);
  const double *cell = voxels->cell;
  double depth = spore_bvh_depth(bvh, point_at(voxels, (double)i + 0.5, (double)j + 0.5, (double)k + 0.5));
  double reach = 0.5 * sqrt(cell[0] * cell[0] + cell[1] * cell[1] + cell[2] * cell[2]), sum = 0;
  double width = fmin(cell[0], fmin(cell[1], cell[2])) / PARTS;
  if (fabs(depth) >= reach) return depth > 0;
  for (int part = 0; part < PARTS * PARTS * PARTS; part++) {
    double a = part % PARTS, b = (double)(part / PARTS % PARTS), c = (double)(part / (PARTS * PARTS));
    depth = spore_bvh_depth(bvh, point_at(voxels, (double)i + (a + 0.5) / PARTS, (double)j + (b + 0.5) / PARTS,
                                          (double)k + (c + 0.5) / PARTS));
    sum += fmin(fmax(0.5 + depth / width, 0), 1);
  }
  double share = sum / (PARTS * PARTS * PARTS);
  return share > 1 - 1e-9 ? 1 : share < LEAST ? 0 : share;
}

/* Marks the cells that hang together with a cell by faces. Returns their volume, in cells. queue: as many as cells. */
static double spread(const SporeVoxels *voxels, size_t from, uint32_t part, uint32_t *mark, size_t *queue) {
  assert(from < spore_voxels_count(voxels) && part > 0);
  size_t reached = 1, strides[3] = {voxels->size[1] * voxels->size[2], voxels->size[2], 1};
  double volume = 0;
  queue[0] = from, mark[from] = part;
  for (size_t next = 0; next < reached; next++) {
    size_t cell = queue[next];
    volume += voxels->share[cell];
    for (int side = 0; side < 6; side++) {
      size_t stride = strides[side / 2], along = cell / stride % voxels->size[side / 2];
      if (side % 2 ? along + 1 == voxels->size[side / 2] : along == 0) continue;
      size_t to = side % 2 ? cell + stride : cell - stride;
      if (mark[to] || !(voxels->share[to] > 0)) continue;
      mark[to] = part;
      queue[reached++] = to;
    }
  }
  return volume;
}

/* Keeps the largest connected part, and empties small loose parts beside it. */
static bool find_parts(SporeVoxels *voxels) {
  size_t count = spore_voxels_count(voxels), *queue = SPORE_NEW_ARRAY(size_t, count);
  uint32_t *mark = SPORE_NEW_ARRAY(uint32_t, count), parts = 0, greatest = 0;
  double all = 0, most = 0;
  for (size_t cell = 0; mark && queue && cell < count; cell++) {
    if (mark[cell] || !(voxels->share[cell] > 0)) continue;
    double volume = spread(voxels, cell, ++parts, mark, queue);
    all += volume;
    if (volume > most) most = volume, greatest = parts;
  }
  bool crumbs = all - most < LOOSE * all;
  for (size_t cell = 0; mark && crumbs && cell < count; cell++)
    if (mark[cell] != greatest) voxels->share[cell] = 0;
  voxels->parts = crumbs && parts > 1 ? 1 : parts;
  bool made = mark && queue;
  spore_free(mark);
  spore_free(queue);
  return made;
}

static bool fill(SporeVoxels *voxels, const SporeTriangleMesh *surface, const SporeCancel *cancel, SporeError *error) {
  SporeBvh *bvh = spore_bvh_create(surface, error);
  if (!bvh) return false;
  bool filled = true;
  for (size_t i = 0, cell = 0; i < voxels->size[0]; i++)
    for (size_t j = 0; filled && j < voxels->size[1]; j++) {
      for (size_t k = 0; k < voxels->size[2]; k++) voxels->share[cell++] = share_of(voxels, bvh, i, j, k);
      filled = !spore_cancel_asked(cancel);
    }
  spore_bvh_free(bvh);
  return filled && (find_parts(voxels) || no_memory(error));
}

static bool check_parts(size_t parts, const SporeMeshReport *report, SporeError *error) {
  if (parts == 1) return true;
  if (parts == 0)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("the surface is so thin that it fills no cell of the grid; ask for more cells"));
  if (report->components > 1)
    return spore_error_set(
        error, SPORE_ERROR_INPUT, NULL,
        _("the surface has %zu parts, and its grid %zu that do not hang together; expected one; give "
          "each part a body of its own, or join them"),
        report->components, parts);
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("the surface is thinner than a cell somewhere, so that the grid falls into %zu parts that "
                           "do not hang together; ask for more cells"),
                         parts);
}

bool spore_voxels_create(SporeVoxels *voxels, const SporeTriangleMesh *surface, size_t cells, const SporeCancel *cancel,
                         SporeError *error) {
  assert(cells > 0);
  SporeMeshReport report;
  *voxels = (SporeVoxels){0};
  if (!spore_triangle_mesh_report_solid(surface, &report, error) || !fit(voxels, &report, cells, error)) return false;
  voxels->volume = fabs(report.volume);
  voxels->share = SPORE_NEW_ARRAY(double, spore_voxels_count(voxels));
  if (!voxels->share) return no_memory(error);
  if (fill(voxels, surface, cancel, error) && check_parts(voxels->parts, &report, error)) return true;
  spore_voxels_clear(voxels);
  return false;
}

void spore_voxels_clear(SporeVoxels *voxels) {
  spore_free(voxels->share);
  *voxels = (SporeVoxels){0};
}
