/* The field of wanted edge lengths: from curvature, from regions, and from places where a mesh was too coarse. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/tetrahedra/private.h"
#include "core/mesh/common.h"

#define EDGE_SCALE 0.7       /* circumradius bound of cells whose edges have length 1 */
#define LEAST_RELATIVE 0.1   /* least relative size that distances alone may set */
#define LEAST_CURVATURE 0.25 /* least relative size that curvature alone may set */
#define MARGIN 2             /* nodes of the grid around the surface */

static size_t node_count(const SporeSizing *grid) { return grid->count[0] * grid->count[1] * grid->count[2]; }

static SporeVec3 node_at(const SporeSizing *grid, size_t x, size_t y, size_t z) {
  return spore_vec3(grid->lower[0] + (double)x * grid->spacing, grid->lower[1] + (double)y * grid->spacing,
                    grid->lower[2] + (double)z * grid->spacing);
}

/* The nodes around a point: the corners of its cell. */
static void corners_around(const SporeSizing *grid, SporeVec3 p, size_t corners[8]) {
  const double x[3] = {p.x, p.y, p.z};
  size_t low[3];
  for (int k = 0; k < 3; k++) {
    double at = floor((x[k] - grid->lower[k]) / grid->spacing);
    low[k] = (size_t)fmin(fmax(at, 0), (double)(grid->count[k] - 2));
  }
  for (size_t i = 0; i < 8; i++)
    corners[i] = ((low[2] + (i >> 2)) * grid->count[1] + low[1] + (i >> 1 & 1)) * grid->count[0] + low[0] + (i & 1);
}

/* Bounds the size around each edge by the turn of the normal along it. Edges shorter than the grid spacing count as one
 * spacing, so that details finer than the grid have no effect. */
static bool bound_by_curvature(SporeSizingPlan *plan, const SporeTriangleMesh *surface, double degrees,
                               SporeError *error) {
  double *normals = SPORE_NEW_ARRAY(double, 3 * surface->vertex_count);
  uint32_t *edges = NULL;
  size_t edge_count = 0;
  bool done = normals && spore_edges_of_triangles(surface->triangles, surface->triangle_count, &edges, &edge_count);
  if (done) {
    spore_triangle_mesh_normals(surface->vertices, surface->vertex_count, surface->triangles, surface->triangle_count,
                                normals);
    for (size_t e = 0; e < edge_count; e++) {
      uint32_t a = edges[2 * e], b = edges[2 * e + 1];
      SporeVec3 p = spore_mesh_vertex(surface->vertices, a), q = spore_mesh_vertex(surface->vertices, b);
      SporeVec3 n = spore_mesh_vertex(normals, a), m = spore_mesh_vertex(normals, b);
      double turn = atan2(spore_vec3_length(spore_vec3_cross(n, m)), spore_vec3_dot(n, m));
      double radius = fmax(spore_vec3_distance(p, q), plan->grid.spacing) / fmax(turn, 1e-9);
      double size = EDGE_SCALE * radius * degrees * M_PI / 180;
      size_t corners[8];
      corners_around(&plan->grid, spore_vec3_scale(0.5, spore_vec3_add(p, q)), corners);
      for (int i = 0; i < 8; i++) plan->absolute[corners[i]] = fmin(plan->absolute[corners[i]], size);
    }
  }
  spore_free(normals);
  spore_free(edges);
  return done || spore_mesh_no_memory(error);
}

static double region_bound(const SporeGenerateRegion *region, SporeVec3 p, double spacing) {
  double beyond = spore_vec3_distance(p, spore_vec3_load(region->centre)) - region->radius - 0.5 * spacing;
  return EDGE_SCALE * region->value + SPORE_SIZING_GRADATION * fmax(beyond, 0);
}

/* Bounds at the nodes by the balls of the regions: the edge length in the nearest, and what may grow from there. */
static void bound_by_regions(SporeSizingPlan *plan, const SporeTetrahedraOptions *options) {
  const SporeSizing *grid = &plan->grid;
  for (size_t z = 0, i = 0; z < grid->count[2]; z++)
    for (size_t y = 0; y < grid->count[1]; y++)
      for (size_t x = 0; x < grid->count[0]; x++, i++)
        for (size_t r = 0; r < options->region_count; r++)
          plan->regions[i] =
              fmin(plan->regions[i], region_bound(options->regions + r, node_at(grid, x, y, z), grid->spacing));
}

bool spore_sizing_plan_create(SporeSizingPlan *plan, const SporeTetrahedraWork *work, const SporeTriangleMesh *surface,
                              SporeError *error) {
  double lower[3], upper[3], longest = 0;
  *plan = (SporeSizingPlan){0};
  spore_mesh_bounds(surface->vertices, surface->vertex_count, 3, lower, upper);
  for (int k = 0; k < 3; k++) longest = fmax(longest, upper[k] - lower[k]);
  plan->grid.spacing = longest / (SPORE_SIZING_NODES - 1 - 2 * MARGIN);
  for (int k = 0; k < 3; k++) {
    plan->grid.lower[k] = lower[k] - MARGIN * plan->grid.spacing;
    double cells = ceil((upper[k] - lower[k]) / plan->grid.spacing) + 2 * MARGIN;
    plan->grid.count[k] = (size_t)fmin(cells, SPORE_SIZING_NODES - 1) + 1;
  }
  size_t count = node_count(&plan->grid);
  plan->grid.size = SPORE_NEW_ARRAY(double, count);
  plan->relative = SPORE_NEW_ARRAY(double, count);
  plan->absolute = SPORE_NEW_ARRAY(double, count);
  plan->regions = SPORE_NEW_ARRAY(double, count);
  bool done = plan->grid.size && plan->relative && plan->absolute && plan->regions;
  if (!done) spore_mesh_no_memory(error);
  for (size_t i = 0; done && i < count; i++)
    plan->relative[i] = 1, plan->absolute[i] = HUGE_VAL, plan->regions[i] = HUGE_VAL;
  if (done) bound_by_regions(plan, &work->options);
  if (done && work->options.curvature > 0) done = bound_by_curvature(plan, surface, work->options.curvature, error);
  if (!done) spore_sizing_plan_clear(plan);
  return done;
}

void spore_sizing_plan_clear(SporeSizingPlan *plan) {
  spore_free(plan->grid.size);
  spore_free(plan->relative);
  spore_free(plan->absolute);
  spore_free(plan->regions);
  *plan = (SporeSizingPlan){0};
}

void spore_sizing_plan_refine(SporeSizingPlan *plan, SporeVec3 p, double relative) {
  size_t corners[8];
  corners_around(&plan->grid, p, corners);
  for (int i = 0; i < 8; i++)
    plan->relative[corners[i]] = fmax(fmin(plan->relative[corners[i]], relative), LEAST_RELATIVE);
}

/* The neighbours that precede a node in the order of the nodes; the neighbours that follow are their mirror images.
 * Each has a step and the growth of the size allowed along the step. */
typedef struct Neighbour {
  int step[3];
  ptrdiff_t offset;
  double growth; /* m */
} Neighbour;

enum { NEIGHBOURS = 13 };

static void list_neighbours(const SporeSizing *grid, Neighbour neighbours[NEIGHBOURS]) {
  const ptrdiff_t row = (ptrdiff_t)grid->count[0], slice = row * (ptrdiff_t)grid->count[1];
  for (int n = 0; n < NEIGHBOURS; n++) {
    const int dx = n % 3 - 1, dy = n / 3 % 3 - 1, dz = n / 9 - 1;
    const double way = grid->spacing * sqrt((double)(dx * dx + dy * dy + dz * dz));
    neighbours[n] = (Neighbour){{dx, dy, dz}, dx + dy * row + dz * slice, SPORE_SIZING_GRADATION * way};
  }
}

/* Whether there is a node at `at` plus sign times step. */
static bool is_node(const SporeSizing *grid, const size_t at[3], ptrdiff_t sign, const int step[3]) {
  for (int k = 0; k < 3; k++) {
    const ptrdiff_t to = (ptrdiff_t)at[k] + sign * step[k];
    if (to < 0 || to >= (ptrdiff_t)grid->count[k]) return false;
  }
  return true;
}

/* Limits each size to a neighbour's size plus the growth allowed between them. One sweep in the order of the nodes, or
 * against it. */
static void limit_growth(SporeSizing *grid, const Neighbour neighbours[NEIGHBOURS], bool forth) {
  const size_t count = node_count(grid), *sides = grid->count;
  const ptrdiff_t sign = forth ? 1 : -1;
  for (size_t n = 0; n < count; n++) {
    const size_t i = forth ? n : count - 1 - n;
    const size_t at[3] = {i % sides[0], i / sides[0] % sides[1], i / (sides[0] * sides[1])};
    bool inner = true;
    for (int k = 0; k < 3; k++) inner = inner && at[k] > 0 && at[k] + 1 < sides[k];
    double size = grid->size[i];
    for (int m = 0; m < NEIGHBOURS; m++) {
      if (!inner && !is_node(grid, at, sign, neighbours[m].step)) continue;
      const double most = grid->size[(ptrdiff_t)i + sign * neighbours[m].offset] + neighbours[m].growth;
      if (most < size) size = most;
    }
    grid->size[i] = size;
  }
}

void spore_sizing_plan_scale(SporeSizingPlan *plan, double scale) {
  SporeSizing *grid = &plan->grid;
  double least = HUGE_VAL, most = 0;
  for (size_t i = 0; i < node_count(grid); i++) {
    double size = fmin(scale * plan->relative[i], fmax(plan->absolute[i], LEAST_CURVATURE * scale));
    grid->size[i] = size = fmin(size, plan->regions[i]);
    least = size < least ? size : least, most = size > most ? size : most;
  }
  if (!(most > least)) return; /* nothing to limit */
  Neighbour neighbours[NEIGHBOURS];
  list_neighbours(grid, neighbours);
  for (int sweep = 0; sweep < 4; sweep++) limit_growth(grid, neighbours, sweep % 2 == 0);
}
