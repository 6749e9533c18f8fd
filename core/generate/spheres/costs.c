/* Points in and around a solid, with the cost of leaving them uncovered (inside) or of covering them (outside). */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/spheres/bounding.h"

#define CELLS_PER_BALL 100 /* at the surface, about */
#define CELLS_LEAST 5000
#define CELLS_MOST 30000
#define GRADE 0.4         /* of the distance from the surface: edge of a cell at that distance */
#define PADDING 1.0       /* of the longest side of the bounding box: how far the points go beyond the solid */
#define SURFACE_SHARE 2.0 /* points on the surface, relative to the number of cells there */
#define REPORT_EVERY 4096

typedef struct Cells {
  const SporeSolid *solid;
  double *xyz, *volume;
  size_t count, capacity, visited;
  double finest;
  SporeRandom *random;
  const SporeProgressPart *progress;
  SporeError *error;
} Cells;

static bool add_point(Cells *cells, SporeVec3 p, double volume) {
  size_t capacity = cells->capacity; /* of both arrays */
  double *xyz = spore_room_for_one(cells->xyz, cells->count, &capacity, 65536, 3 * sizeof *xyz);
  if (xyz) cells->xyz = xyz;
  double *volumes =
      xyz ? spore_room_for_one(cells->volume, cells->count, &cells->capacity, 65536, sizeof *volumes) : NULL;
  if (!volumes) return spore_generate_no_memory(cells->error);
  cells->volume = volumes;
  spore_vec3_store(cells->xyz + 3 * cells->count, spore_symmetry_fold(&cells->solid->symmetry, p));
  cells->volume[cells->count++] = volume;
  return true;
}

/* What is nearer to a known place than the surface lies on its side. */
static bool is_inside(const SporeSolid *solid, SporeVec3 p, const SporeBvhKnown *known) {
  return spore_vec3_distance(p, known->place) < fabs(known->depth) * (1 - 1e-9) ? known->depth > 0
                                                                                : spore_bvh_inside(solid->bvh, p);
}

static double factor_at(const SporeSolid *solid, SporeVec3 p) {
  return solid->region_count ? spore_solid_factor(solid, p) : 1;
}

/* Adds a random point of the cell. The cell lies on one side of the surface (`side`), or is so small that the point
 * stands for all of it. The volume that a ball adds outside is proportional to the square of the surface area that the
 * ball covers. So in a region the volume is weighted by the square of the factor: the sum is then least where the
 * density of balls is larger by the factor. */
static bool add_cell(Cells *cells, SporeVec3 middle, double edge, int side, const SporeBvhKnown *known) {
  double offset[3];
  for (int k = 0; k < 3; k++) offset[k] = edge * (spore_random_unit(cells->random) - 0.5);
  SporeVec3 p = spore_vec3_add(middle, spore_vec3_load(offset));
  bool inside = side ? side > 0 : is_inside(cells->solid, p, known);
  double factor = factor_at(cells->solid, p), volume = edge * edge * edge * factor * factor;
  return add_point(cells, p, inside ? -volume : volume);
}

static bool divide(Cells *cells, SporeVec3 middle, double edge, const SporeBvhKnown *known) {
  if (cells->visited++ % REPORT_EVERY == 0 &&
      !spore_progress_part(cells->progress, fmin(1, (double)cells->visited / (4. * CELLS_MOST)),
                           _("Sampling the solid"), cells->error))
    return false;
  SporeBvhKnown here = spore_bvh_depth_beside(cells->solid->bvh, middle, known);
  double depth = here.depth, far = fabs(depth) - edge * (sqrt(3) / 2),
         finest = cells->finest / sqrt(factor_at(cells->solid, middle));
  if (far > 0 && edge <= GRADE * far + (depth > 0 ? 3 : 1.5) * finest)
    return add_cell(cells, middle, edge, depth > 0 ? 1 : -1, &here);
  if (edge <= 1.5 * finest) return add_cell(cells, middle, edge, 0, &here);
  for (int k = 0; k < 8; k++) {
    double quarter = edge / 4;
    SporeVec3 at = spore_vec3(middle.x + (k & 1 ? quarter : -quarter), middle.y + (k & 2 ? quarter : -quarter),
                              middle.z + (k & 4 ? quarter : -quarter));
    if (!divide(cells, at, edge / 2, &here)) return false;
  }
  return true;
}

static bool divide_all(Cells *cells) {
  const SporeTriangleMesh *mesh = &cells->solid->mesh;
  double lower[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, edge = 0;
  for (size_t i = 0; i < 3 * mesh->vertex_count; i++) {
    lower[i % 3] = fmin(lower[i % 3], mesh->vertices[i]);
    upper[i % 3] = fmax(upper[i % 3], mesh->vertices[i]);
  }
  for (int k = 0; k < 3; k++) edge = fmax(edge, upper[k] - lower[k]);
  SporeVec3 middle = spore_vec3_scale(0.5, spore_vec3_add(spore_vec3_load(lower), spore_vec3_load(upper)));
  return divide(cells, middle, (1 + 2 * PADDING) * edge, &(SporeBvhKnown){.depth = 0});
}

/* Adds points on the surface, and all vertices, as these stick out most; only a part of the vertices where there are
 * very many. */
static bool add_surface(Cells *cells, size_t count, double area) {
  const SporeTriangleMesh *mesh = &cells->solid->mesh;
  size_t step = mesh->vertex_count / (4 * count) + 1, corners = (mesh->vertex_count + step - 1) / step;
  double share = area * cells->finest / (2 * (double)(count + corners));
  double *points = SPORE_NEW_ARRAY(double, 3 * count);
  bool done = points;
  if (!done) spore_generate_no_memory(cells->error);
  if (done) spore_solid_surface(cells->solid, count, cells->random, points, NULL);
  for (size_t i = 0; done && i < count; i++) done = add_point(cells, spore_vec3_load(points + 3 * i), -share);
  for (size_t i = 0; done && i < mesh->vertex_count; i += step)
    done = add_point(cells, spore_vec3_load(mesh->vertices + 3 * i), -share);
  spore_free(points);
  return done;
}

/* Sorts the points in space-filling order and sets `held` to 0. */
static bool sort_points(SporeCosts *costs) {
  spore_points_clear(&costs->points);
  spore_free(costs->volume);
  spore_free(costs->held);
  costs->volume = NULL, costs->held = NULL;
  if (!spore_points_create(&costs->points, costs->xyz, costs->count)) return false;
  size_t padded = costs->points.block_count * SPORE_BLOCK;
  costs->volume = SPORE_NEW_ARRAY(double, padded);
  costs->held = SPORE_NEW_ARRAY(uint16_t, padded);
  if (!costs->volume || !costs->held) return false;
  for (size_t i = 0; i < costs->count; i++) costs->volume[i] = costs->cost[costs->points.original[i]];
  return true;
}

bool spore_costs_create(SporeCosts *costs, const SporeSolid *solid, size_t count, SporeRandom *random,
                        const SporeProgressPart *progress, SporeError *error) {
  size_t wanted = CELLS_PER_BALL * count;
  wanted = wanted < CELLS_LEAST ? CELLS_LEAST : wanted > CELLS_MOST ? CELLS_MOST : wanted;
  double area = solid->triangle_end[solid->mesh.triangle_count - 1];
  Cells cells = {
      .solid = solid, .finest = sqrt(area / (double)wanted), .random = random, .progress = progress, .error = error};
  *costs = (SporeCosts){0};
  bool done = divide_all(&cells) && add_surface(&cells, (size_t)(SURFACE_SHARE * (double)wanted), area);
  costs->xyz = cells.xyz, costs->cost = cells.volume, costs->count = cells.count;
  if (done && !sort_points(costs)) done = spore_generate_no_memory(error);
  if (!done) spore_costs_clear(costs);
  return done;
}

bool spore_costs_add(SporeCosts *costs, const double *xyz, size_t count, double volume) {
  size_t all = costs->count + count;
  double *grown = spore_reallocate(costs->xyz, 3 * costs->count, 3 * all, sizeof *grown);
  if (grown) costs->xyz = grown;
  double *cost = spore_reallocate(costs->cost, costs->count, all, sizeof *cost);
  if (cost) costs->cost = cost;
  if (!grown || !cost) return false;
  memcpy(grown + 3 * costs->count, xyz, 3 * count * sizeof *xyz);
  for (size_t i = costs->count; i < all; i++) cost[i] = -volume;
  costs->count = all;
  return sort_points(costs);
}

void spore_costs_clear(SporeCosts *costs) {
  spore_points_clear(&costs->points);
  spore_free(costs->xyz);
  spore_free(costs->cost);
  spore_free(costs->volume);
  spore_free(costs->held);
  *costs = (SporeCosts){0};
}
