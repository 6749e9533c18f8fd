/* Points that follow a tetrahedral mesh. */
#include "models/tetrahedra/map.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/mesh/bvh.h"

double spore_tetrahedron_gradients(const double *vertices, const uint32_t corners[4], SporeVec3 gradient[3]) {
  SporeVec3 edge[3], origin = spore_vec3_load(vertices + 3 * (size_t)corners[0]);
  for (int k = 0; k < 3; k++) edge[k] = spore_vec3_sub(spore_vec3_load(vertices + 3 * (size_t)corners[k + 1]), origin);
  double determinant = spore_vec3_dot(spore_vec3_cross(edge[0], edge[1]), edge[2]);
  for (int k = 0; k < 3; k++)
    gradient[k] = spore_vec3_scale(1 / determinant, spore_vec3_cross(edge[(k + 1) % 3], edge[(k + 2) % 3]));
  return determinant;
}

/* Uniform grid over the mesh: the tetrahedra whose bounding boxes touch cell c are
 * member[start[c] .. start[c + 1]). */
typedef struct Grid {
  double lower[3], cell; /* m */
  size_t size[3];
  uint32_t *start, *member;
} Grid;

static void grid_clear(Grid *grid) {
  spore_free(grid->start);
  spore_free(grid->member);
}

static size_t cell_along(const Grid *grid, int axis, double x) {
  assert(grid->cell > 0);
  double at = floor((x - grid->lower[axis]) / grid->cell);
  return at < 0 ? 0 : at >= (double)grid->size[axis] ? grid->size[axis] - 1 : (size_t)at;
}

/* Calls for each cell that tetrahedron t may touch: counts (member NULL) or fills. */
static void visit_cells(const Grid *grid, const SporeTetrahedralMesh *mesh, uint32_t t, uint32_t *fill,
                        uint32_t *member) {
  assert(t < mesh->tetrahedron_count);
  size_t low[3], high[3];
  for (int axis = 0; axis < 3; axis++) {
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (int k = 0; k < 4; k++) {
      double x = mesh->vertices[3 * (size_t)mesh->tetrahedra[4 * (size_t)t + k] + axis];
      least = fmin(least, x), most = fmax(most, x);
    }
    low[axis] = cell_along(grid, axis, least - 1e-6 * grid->cell);
    high[axis] = cell_along(grid, axis, most + 1e-6 * grid->cell);
  }
  for (size_t i = low[0]; i <= high[0]; i++)
    for (size_t j = low[1]; j <= high[1]; j++)
      for (size_t k = low[2]; k <= high[2]; k++) {
        size_t c = (i * grid->size[1] + j) * grid->size[2] + k;
        if (member) member[fill[c]] = t;
        fill[c]++;
      }
}

/* As many cells as tetrahedra, about: no more than a few members in each. */
static void size_grid(Grid *grid, const SporeTetrahedralMesh *mesh) {
  double upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, longest = 0;
  for (int axis = 0; axis < 3; axis++) grid->lower[axis] = HUGE_VAL;
  for (size_t i = 0; i < 3 * mesh->vertex_count; i++) {
    grid->lower[i % 3] = fmin(grid->lower[i % 3], mesh->vertices[i]);
    upper[i % 3] = fmax(upper[i % 3], mesh->vertices[i]);
  }
  for (int axis = 0; axis < 3; axis++) longest = fmax(longest, upper[axis] - grid->lower[axis]);
  double volume = 1;
  for (int axis = 0; axis < 3; axis++) volume *= fmax(upper[axis] - grid->lower[axis], 1e-3 * longest);
  grid->cell = cbrt(volume / (double)mesh->tetrahedron_count);
  for (int axis = 0; axis < 3; axis++) grid->size[axis] = 1 + (size_t)((upper[axis] - grid->lower[axis]) / grid->cell);
}

/* False: no memory; the grid is to be cleared all the same. */
static bool grid_create(Grid *grid, const SporeTetrahedralMesh *mesh) {
  *grid = (Grid){0};
  size_grid(grid, mesh);
  size_t cells = grid->size[0] * grid->size[1] * grid->size[2];
  grid->start = SPORE_NEW_ARRAY(uint32_t, cells + 2);
  if (!grid->start) return false;
  uint32_t *fill = grid->start + 1, t, count = (uint32_t)mesh->tetrahedron_count;
  for (t = 0; t < count; t++) visit_cells(grid, mesh, t, fill + 1, NULL);
  for (size_t c = 0; c < cells; c++) fill[c + 1] += fill[c];
  grid->member = SPORE_NEW_ARRAY(uint32_t, fill[cells]);
  if (!grid->member) return false;
  for (t = 0; t < count; t++) visit_cells(grid, mesh, t, fill, grid->member);
  return true;
}

/* Tetrahedron of p's cell that holds p, or comes nearest to it by its least weight, which is returned. */
static double locate(const Grid *grid, const SporeTetrahedralMesh *mesh, SporeVec3 p, uint32_t *tetrahedron) {
  double x[3] = {p.x, p.y, p.z}, best = -HUGE_VAL;
  size_t cell = 0;
  for (int axis = 0; axis < 3; axis++) cell = cell * grid->size[axis] + cell_along(grid, axis, x[axis]);
  for (uint32_t m = grid->start[cell]; m < grid->start[cell + 1]; m++) {
    const uint32_t *corners = mesh->tetrahedra + 4 * (size_t)grid->member[m];
    SporeVec3 gradient[3], arm = spore_vec3_sub(p, spore_vec3_load(mesh->vertices + 3 * (size_t)corners[0]));
    spore_tetrahedron_gradients(mesh->vertices, corners, gradient);
    double first = 1, least = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
      double weight = spore_vec3_dot(gradient[k], arm);
      first -= weight;
      least = fmin(least, weight);
    }
    least = fmin(least, first);
    if (least > best) best = least, *tetrahedron = grid->member[m];
  }
  return best;
}

/* Weights of the corners of a tetrahedron for p. */
static void weigh_corners(const SporeTetrahedralMesh *mesh, uint32_t tetrahedron, SporeVec3 p, double weights[4]) {
  assert(tetrahedron < mesh->tetrahedron_count);
  const uint32_t *corners = mesh->tetrahedra + 4 * (size_t)tetrahedron;
  SporeVec3 gradient[3], arm = spore_vec3_sub(p, spore_vec3_load(mesh->vertices + 3 * (size_t)corners[0]));
  spore_tetrahedron_gradients(mesh->vertices, corners, gradient);
  weights[0] = 1;
  for (int k = 0; k < 3; k++) {
    weights[k + 1] = spore_vec3_dot(gradient[k], arm);
    weights[0] -= weights[k + 1];
  }
}

/* Shape functions of ten nodes at corner weights l, extended affinely to the corner weights p. */
static void weigh_quadratic(const double l[4], const double p[4], double weights[10]) {
  static const int edges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  for (int i = 0; i < 4; i++) weights[i] = l[i] * (2 * l[i] - 1) + (4 * l[i] - 1) * (p[i] - l[i]);
  for (int e = 0; e < 6; e++) {
    int i = edges[e][0], j = edges[e][1];
    weights[4 + e] = 4 * (l[i] * l[j] + l[j] * (p[i] - l[i]) + l[i] * (p[j] - l[j]));
  }
}

/* at: the place of p, or where the tetrahedron is nearest to it. */
static void weigh(const SporeTetrahedronNodes *nodes, uint32_t tetrahedron, SporeVec3 at, SporeVec3 p, uint32_t *blocks,
                  double *weights) {
  assert(nodes->per_element == 4 || nodes->per_element == 10);
  size_t per = nodes->per_element;
  memcpy(blocks, nodes->nodes + per * tetrahedron, per * sizeof *blocks);
  if (per == 4) {
    weigh_corners(&nodes->mesh, tetrahedron, p, weights);
    return;
  }
  double inside[4], outside[4];
  weigh_corners(&nodes->mesh, tetrahedron, at, inside);
  weigh_corners(&nodes->mesh, tetrahedron, p, outside);
  weigh_quadratic(inside, outside, weights);
}

static SporeBvh *boundary_of(const SporeTetrahedralMesh *mesh, SporeError *error) {
  SporeTriangleMesh boundary = {mesh->vertex_count, 0, mesh->vertices, NULL};
  if (!spore_tetrahedral_mesh_boundary(mesh, &boundary.triangles, &boundary.triangle_count)) {
    spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the boundary of a mesh"));
    return NULL;
  }
  SporeBvh *bvh = spore_bvh_create(&boundary, error);
  spore_free(boundary.triangles);
  return bvh;
}

static bool map_points(const SporeTetrahedronNodes *nodes, const Grid *grid, const double *points, size_t count,
                       const SporeCancel *cancel, uint32_t *blocks, double *weights, SporeError *error) {
  const SporeTetrahedralMesh *mesh = &nodes->mesh;
  SporeBvh *boundary = NULL;
  bool good = true;
  for (size_t i = 0; i < count && (good = spore_mapping_goes_on(cancel, error)); i++) {
    SporeVec3 p = spore_vec3_load(points + 3 * i), nearest = p;
    uint32_t tetrahedron = 0;
    if (locate(grid, mesh, p, &tetrahedron) < -1e-9) {
      if (!boundary && !(boundary = boundary_of(mesh, error))) return false;
      spore_bvh_distance(boundary, p, &nearest, NULL);
      locate(grid, mesh, nearest, &tetrahedron);
    }
    weigh(nodes, tetrahedron, nearest, p, blocks + nodes->per_element * i, weights + nodes->per_element * i);
  }
  spore_bvh_free(boundary);
  return good;
}

bool spore_tetrahedra_map(const SporeTetrahedronNodes *nodes, const double *points, size_t count,
                          const SporeCancel *cancel, SporeMapping *mapping, SporeError *error) {
  assert(count == 0 || points);
  if (count == nodes->count && !memcmp(points, nodes->rest, 3 * count * sizeof *points))
    return spore_mapping_init_identity(mapping, count);
  Grid grid = {0};
  uint32_t *blocks = SPORE_NEW_ARRAY(uint32_t, nodes->per_element * count);
  double *weights = SPORE_NEW_ARRAY(double, nodes->per_element *count);
  bool good = blocks && weights && grid_create(&grid, &nodes->mesh);
  if (!good) spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for %zu points"), count);
  good = good && map_points(nodes, &grid, points, count, cancel, blocks, weights, error) &&
         spore_mapping_init_linear(mapping, count, nodes->per_element, blocks, weights, error);
  grid_clear(&grid);
  spore_free(blocks);
  spore_free(weights);
  return good;
}
