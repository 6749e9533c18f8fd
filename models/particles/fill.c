/* Particles on a lattice inside a solid, and points that follow them. */
#include "models/particles/fill.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/math/mat3.h"
#include "core/mesh/bvh.h"

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the particles"));
}

typedef struct Fill {
  const SporeBvh *bvh;
  const SporeCancel *cancel;
  double cell; /* m */
  double lower[3];
  size_t cells[3];
  double *points;
  size_t count, capacity;
} Fill;

static bool add_point(Fill *fill, SporeVec3 p) {
  if (fill->count == fill->capacity) {
    size_t capacity = 2 * fill->capacity + 256;
    double *points = spore_reallocate(fill->points, 3 * fill->capacity, 3 * capacity, sizeof *points);
    if (!points) return false;
    fill->points = points;
    fill->capacity = capacity;
  }
  spore_vec3_store(fill->points + 3 * fill->count++, p);
  return true;
}

/* Fills a row of the lattice along z. Where the surface is far, the row is passed over by that distance. */
static bool fill_row(Fill *fill, size_t x, size_t y, const double part[3]) {
  for (size_t z = 0; z < fill->cells[2];) {
    SporeVec3 p = {fill->lower[0] + ((double)x + part[0]) * fill->cell,
                   fill->lower[1] + ((double)y + part[1]) * fill->cell,
                   fill->lower[2] + ((double)z + part[2]) * fill->cell};
    double depth = spore_bvh_depth(fill->bvh, p);
    if (depth > 0 && !add_point(fill, p)) return false;
    z += depth < -2 * fill->cell ? (size_t)(-depth / fill->cell) : 1;
  }
  return true;
}

static bool fill_lattice(Fill *fill) {
  static const double parts[4][3] = {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.25}, {0.75, 0.25, 0.75}, {0.25, 0.75, 0.75}};
  for (size_t x = 0; x < fill->cells[0]; x++)
    for (size_t y = 0; y < fill->cells[1]; y++)
      for (int i = 0; i < 4; i++)
        if (spore_cancel_asked(fill->cancel) || !fill_row(fill, x, y, parts[i])) return false;
  return true;
}

/* The lattice in the middle of the surface's bounds, with a layer of places there along the axes of `phase`. False: no
 * memory, or cancelled. */
static bool fill_phase(Fill *fill, const SporeMeshReport *report, unsigned phase) {
  assert(phase < 8);
  fill->count = 0;
  for (int k = 0; k < 3; k++) {
    double length = report->upper[k] - report->lower[k], cells = fmax(1, ceil(length / fill->cell - 1e-9));
    double shift = phase >> k & 1 ? 0.25 : 0;
    fill->cells[k] = (size_t)cells + (shift > 0);
    fill->lower[k] = report->lower[k] + 0.5 * (length - cells * fill->cell) - shift * fill->cell;
  }
  return fill_lattice(fill);
}

/* In a narrow surface the number of places inside depends on where the lattice lies: takes the lattice whose number is
 * nearest to `wanted`. */
static bool fill_best(Fill *fill, const SporeMeshReport *report, size_t wanted) {
  assert(wanted > 0);
  unsigned best = 0;
  double least = HUGE_VAL;
  for (unsigned phase = 0; phase < 8 && least > 0.01; phase++) {
    if (!fill_phase(fill, report, phase)) return false;
    double off = fabs((double)fill->count / (double)wanted - 1);
    if (off < least) least = off, best = phase;
  }
  return fill_phase(fill, report, best);
}

bool spore_particle_fill(const SporeTriangleMesh *surface, size_t wanted, const SporeCancel *cancel, double **points,
                         size_t *count, double *volume, SporeError *error) {
  assert(wanted > 0);
  SporeMeshReport report;
  if (!spore_triangle_mesh_report_solid(surface, &report, error)) return false;
  *volume = fabs(report.volume);
  SporeBvh *bvh = spore_bvh_create(surface, error);
  if (!bvh) return false;
  Fill fill = {.bvh = bvh, .cancel = cancel, .cell = cbrt(4 * *volume / (double)wanted)};
  bool made = fill_best(&fill, &report, wanted);
  spore_bvh_free(bvh);
  if (made && fill.count >= 4) {
    *points = fill.points;
    *count = fill.count;
    return true;
  }
  spore_free(fill.points);
  if (!made) return no_memory(error);
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("the surface is so thin that %zu of %zu particles lie inside; expected at least 4; ask for "
                           "more particles"),
                         fill.count, wanted);
}

/* Four particles about a point, not in one plane: the nearest, the nearest besides, the nearest that is well off the
 * line through both and the nearest well off the plane of the three. */
typedef struct Corners {
  uint32_t particle[4];
  SporeVec3 at[4];
  double weight[4];
  int count;
} Corners;

/* How far p is off the point, line or plane that the corners so far span. */
static double distance_off(const Corners *corners, SporeVec3 p) {
  assert(corners->count >= 1 && corners->count <= 3);
  SporeVec3 arm = spore_vec3_sub(p, corners->at[0]);
  if (corners->count == 1) return spore_vec3_length(arm);
  SporeVec3 along = spore_vec3_sub(corners->at[1], corners->at[0]);
  if (corners->count == 2) return spore_vec3_length(spore_vec3_cross(along, arm)) / spore_vec3_length(along);
  SporeVec3 normal = spore_vec3_cross(along, spore_vec3_sub(corners->at[2], corners->at[0]));
  return fabs(spore_vec3_dot(normal, arm)) / spore_vec3_length(normal);
}

static bool add_corner(Corners *corners, const double *particles, size_t count, double off, SporeVec3 p) {
  assert(corners->count < 4);
  double least = HUGE_VAL;
  int next = corners->count;
  for (size_t i = 0; i < count; i++) {
    SporeVec3 at = spore_vec3_load(particles + 3 * i);
    double distance = spore_vec3_distance(at, p);
    if (!(distance < least) || (next > 0 && !(distance_off(corners, at) > off))) continue;
    least = distance;
    corners->particle[next] = (uint32_t)i;
    corners->at[next] = at;
  }
  if (least == HUGE_VAL) return false;
  corners->count++;
  return true;
}

/* Weights by which the corners add up to p. */
static bool weigh(Corners *corners, SporeVec3 p) {
  SporeMat3 edges, inverse;
  for (int k = 0; k < 3; k++) {
    SporeVec3 edge = spore_vec3_sub(corners->at[k + 1], corners->at[0]);
    edges.m[k] = edge.x, edges.m[3 + k] = edge.y, edges.m[6 + k] = edge.z;
  }
  if (!spore_mat3_invert(edges, &inverse)) return false;
  SporeVec3 w = spore_mat3_apply(inverse, spore_vec3_sub(p, corners->at[0]));
  corners->weight[1] = w.x, corners->weight[2] = w.y, corners->weight[3] = w.z;
  corners->weight[0] = 1 - (w.x + w.y + w.z);
  return true;
}

static bool find_corners(const double *particles, size_t count, double spacing, SporeVec3 p, Corners *corners) {
  *corners = (Corners){.count = 0};
  if (!add_corner(corners, particles, count, 0, p)) return false;
  corners->weight[0] = 1;
  if (spore_vec3_distance(corners->at[0], p) <= 1e-12 * spacing) return true;
  for (int k = 1; k < 4; k++)
    if (!add_corner(corners, particles, count, 0.4 * spacing, p)) return false;
  return weigh(corners, p);
}

static bool map_points(const double *particles, size_t particle_count, double spacing, const double *points,
                       size_t count, const SporeCancel *cancel, uint32_t *blocks, double *weights, SporeError *error) {
  for (size_t i = 0; i < count; i++) {
    Corners corners;
    if (!spore_mapping_goes_on(cancel, error)) return false;
    if (!find_corners(particles, particle_count, spacing, spore_vec3_load(points + 3 * i), &corners))
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("point %zu is at no particle, and the particles all lie in one plane; expected points "
                               "at particles; ask for more particles or place the points on them"),
                             i);
    memcpy(blocks + 4 * i, corners.particle, sizeof corners.particle);
    memcpy(weights + 4 * i, corners.weight, sizeof corners.weight);
  }
  return true;
}

bool spore_particle_map(const double *particles, size_t particle_count, double spacing, const double *points,
                        size_t count, const SporeCancel *cancel, SporeMapping *mapping, SporeError *error) {
  assert(spacing > 0 && (count == 0 || points));
  if (count == particle_count && memcmp(points, particles, 3 * count * sizeof *points) == 0)
    return spore_mapping_init_identity(mapping, count);
  uint32_t *blocks = SPORE_NEW_ARRAY(uint32_t, 4 * count);
  double *weights = SPORE_NEW_ARRAY(double, 4 * count);
  bool made = blocks && weights
                  ? map_points(particles, particle_count, spacing, points, count, cancel, blocks, weights, error)
                  : no_memory(error);
  if (made) made = spore_mapping_init_linear(mapping, count, 4, blocks, weights, error);
  spore_free(blocks);
  spore_free(weights);
  return made;
}
