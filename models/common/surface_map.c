/* Points that follow a surface: the nearest triangle, and a fourth node for what lies off the surface. */
#include "models/common/surface_map.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/mesh/bvh.h"

#define WIDTH 4             /* weights a point */
#define WEIGHTS_AT_MOST 100 /* sum of absolute weights */
#define LIGHT_WEIGHTS 4     /* as many that need no excuse */
#define FLAT 1e-6           /* offset that a flat surface may drop, of its size */
#define ROUNDING 1e-14      /* of the surface's size: a point this near a vertex is that vertex */

static SporeVec3 vertex_at(const SporeTriangleMesh *mesh, uint32_t i) {
  return spore_vec3_load(mesh->vertices + 3 * (size_t)i);
}

static double size_of(const SporeTriangleMesh *mesh) {
  double lower[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (size_t i = 0; i < 3 * mesh->vertex_count; i++) {
    lower[i % 3] = fmin(lower[i % 3], mesh->vertices[i]);
    upper[i % 3] = fmax(upper[i % 3], mesh->vertices[i]);
  }
  return spore_vec3_distance(spore_vec3_load(lower), spore_vec3_load(upper));
}

/* Weights of the corners for the foot of p in the plane of the triangle; *offset is p's distance from that plane along
 * *normal. The triangle has an area. */
static void in_plane(SporeVec3 a, SporeVec3 b, SporeVec3 c, SporeVec3 p, double weight[3], SporeVec3 *normal,
                     double *offset) {
  SporeVec3 ab = spore_vec3_sub(b, a), ac = spore_vec3_sub(c, a), ap = spore_vec3_sub(p, a);
  SporeVec3 area = spore_vec3_cross(ab, ac);
  double square = spore_vec3_dot(area, area);
  *normal = spore_vec3_normalise(area, (SporeVec3){0, 0, 0});
  *offset = spore_vec3_dot(ap, *normal);
  weight[1] = spore_vec3_dot(spore_vec3_cross(ap, ac), area) / square;
  weight[2] = spore_vec3_dot(spore_vec3_cross(ab, ap), area) / square;
  weight[0] = 1 - weight[1] - weight[2];
}

typedef struct Row {
  uint32_t block[WIDTH];
  double weight[WIDTH];
} Row;

/* Makes a tetrahedron of the row's triangle and node i at d, which reproduces what lies at `offset` from the triangle.
 * Returns the sum of the absolute weights; infinite where there are no such weights. */
static double lift_by(const SporeTriangleMesh *mesh, uint32_t i, SporeVec3 d, double offset, Row *row) {
  assert(i <= mesh->vertex_count);
  double foot[3], height, sum;
  SporeVec3 unused;
  in_plane(vertex_at(mesh, row->block[0]), vertex_at(mesh, row->block[1]), vertex_at(mesh, row->block[2]), d, foot,
           &unused, &height);
  if (fabs(height) * WEIGHTS_AT_MOST < fabs(offset)) return HUGE_VAL;
  row->block[3] = i;
  row->weight[3] = offset / height;
  sum = fabs(row->weight[3]);
  for (int k = 0; k < 3; k++) {
    row->weight[k] -= row->weight[3] * foot[k];
    sum += fabs(row->weight[k]);
  }
  return sum;
}

/* Puts the foot of p on triangle t into the row. Returns p's distance from its plane. */
static double stand_on(const SporeTriangleMesh *mesh, size_t t, SporeVec3 p, Row *row) {
  assert(t < mesh->triangle_count);
  SporeVec3 normal;
  double offset;
  memcpy(row->block, mesh->triangles + 3 * t, 3 * sizeof *row->block);
  row->block[3] = row->block[0];
  row->weight[3] = 0;
  in_plane(vertex_at(mesh, row->block[0]), vertex_at(mesh, row->block[1]), vertex_at(mesh, row->block[2]), p,
           row->weight, &normal, &offset);
  return offset;
}

/* Tries the core with the row's triangle, the nearest one; and then the core with each other triangle, such as the
 * triangle on the line from the core through the point. Takes the best tetrahedron. False: its weights exceed
 * LIGHT_WEIGHTS. */
static bool lift_by_core(const SporeTriangleMesh *mesh, SporeVec3 core, SporeVec3 p, double offset, Row *row) {
  Row result = *row;
  uint32_t node = (uint32_t)mesh->vertex_count;
  double best = lift_by(mesh, node, core, offset, &result);
  bool near = best <= LIGHT_WEIGHTS;
  for (size_t t = 0; !near && t < mesh->triangle_count; t++) {
    Row candidate;
    double away = stand_on(mesh, t, p, &candidate), sum = lift_by(mesh, node, core, away, &candidate);
    if (sum < best) best = sum, result = candidate;
  }
  if (!(best <= LIGHT_WEIGHTS)) return false;
  *row = result;
  return true;
}

/* Finds the node that makes the best tetrahedron with the row's triangle: the core where that is good enough, else a
 * vertex. False: no node is good enough. */
static bool lift(const SporeTriangleMesh *mesh, const SporeVec3 *core, SporeVec3 p, double offset, double size,
                 double most, Row *row) {
  if (core && lift_by_core(mesh, *core, p, offset, row)) return true;
  Row result = *row;
  double best = HUGE_VAL;
  for (uint32_t i = 0; i < mesh->vertex_count; i++) {
    Row candidate = *row;
    SporeVec3 d = vertex_at(mesh, i);
    double sum = lift_by(mesh, i, d, offset, &candidate);
    if (!(sum <= most)) continue;
    double cost = sum + 0.1 * spore_vec3_distance(p, d) / size;
    if (cost < best) best = cost, result = candidate;
  }
  *row = result;
  return best < HUGE_VAL;
}

static bool map_point(const SporeTriangleMesh *mesh, const SporeVec3 *core, const SporeBvh *bvh, double size,
                      double slack, const double *point, size_t index, Row *row, SporeError *error) {
  SporeVec3 p = spore_vec3_load(point);
  uint32_t triangle = 0;
  spore_bvh_distance(bvh, p, NULL, &triangle);
  double offset = stand_on(mesh, triangle, p, row);
  for (int k = 0; k < 3; k++) {
    if (spore_vec3_distance(p, vertex_at(mesh, row->block[k])) > ROUNDING * size) continue;
    for (int j = 0; j < WIDTH; j++) row->weight[j] = j == k;
    return true;
  }
  double most = fabs(offset) <= slack ? LIGHT_WEIGHTS : WEIGHTS_AT_MOST;
  if (fabs(offset) <= ROUNDING * size || lift(mesh, core, p, offset, size, most, row) ||
      fabs(offset) <= fmax(FLAT * size, slack))
    return true;
  char place[64];
  snprintf(place, sizeof place, "point %zu", index);
  return spore_error_set(
      error, SPORE_ERROR_INPUT, place,
      _("the point lies %g m off a flat net, which cannot carry it; points of a flat net must lie in "
        "its plane; move spheres and visual vertices onto the net, or use tetrahedra"),
      fabs(offset));
}

static bool is_identity(const SporeTriangleMesh *mesh, const double *points, size_t count) {
  return count == mesh->vertex_count && !memcmp(points, mesh->vertices, 3 * count * sizeof *points);
}

/* The triangles that have an area, on the vertices of mesh. *triangles is the caller's to free. */
static SporeTriangleMesh without_flat(const SporeTriangleMesh *mesh, uint32_t **triangles) {
  *triangles = SPORE_NEW_ARRAY(uint32_t, 3 * mesh->triangle_count);
  SporeTriangleMesh view = {mesh->vertex_count, 0, mesh->vertices, *triangles};
  for (size_t t = 0; *triangles && t < mesh->triangle_count; t++) {
    const uint32_t *n = mesh->triangles + 3 * t;
    SporeVec3 a = vertex_at(mesh, n[0]), ab = spore_vec3_sub(vertex_at(mesh, n[1]), a);
    SporeVec3 area = spore_vec3_cross(ab, spore_vec3_sub(vertex_at(mesh, n[2]), a));
    if (spore_vec3_dot(area, area) > 0) memcpy(*triangles + 3 * view.triangle_count++, n, 3 * sizeof *n);
  }
  return view;
}

static bool map_points(const SporeTriangleMesh *mesh, const SporeVec3 *core, const double *points, size_t count,
                       const SporeCancel *cancel, double slack, uint32_t *blocks, double *weights, SporeError *error) {
  SporeBvh *bvh = spore_bvh_create(mesh, error);
  if (!bvh) return false;
  double size = size_of(mesh);
  bool good = true;
  for (size_t i = 0; good && i < count && (good = spore_mapping_goes_on(cancel, error)); i++) {
    Row row;
    good = map_point(mesh, core, bvh, size, slack, points + 3 * i, i, &row, error);
    memcpy(blocks + WIDTH * i, row.block, sizeof row.block);
    memcpy(weights + WIDTH * i, row.weight, sizeof row.weight);
  }
  spore_bvh_free(bvh);
  return good;
}

bool spore_surface_map(const SporeTriangleMesh *mesh, const SporeVec3 *core, const double *points, size_t count,
                       const SporeCancel *cancel, double slack, SporeMapping *mapping, SporeError *error) {
  assert(count == 0 || points);
  assert(slack >= 0);
  if (is_identity(mesh, points, count)) return spore_mapping_init_identity(mapping, count);
  uint32_t *triangles, *blocks = SPORE_NEW_ARRAY(uint32_t, WIDTH * count);
  double *weights = SPORE_NEW_ARRAY(double, WIDTH *count);
  SporeTriangleMesh view = without_flat(mesh, &triangles);
  bool good = triangles && blocks && weights;
  if (!good) spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for %zu points"), count);
  good = good && map_points(&view, core, points, count, cancel, slack, blocks, weights, error) &&
         spore_mapping_init_linear(mapping, count, WIDTH, blocks, weights, error);
  spore_free(triangles);
  spore_free(blocks);
  spore_free(weights);
  return good;
}
