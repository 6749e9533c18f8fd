/* The surface where a distance field is zero: sampling on a lattice, and meshing. */
#include "core/mesh/isosurface.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/text.h"
#include "core/mesh/common.h"
#include "core/mesh/isosurface_parts.h"
#include "core/mesh/sort.h"

#define BLOCK 4 /* cubes along each axis of a block that is left out as a whole */
#define MOST_POINTS 1000000000.
#define WIDE 1.7321f /* in steps: where the field is farther from 0, the surface cannot pass through the cube */
#define LATTICE_POINT (UINT64_C(1) << 63) /* key of a point of the lattice, beside those of edges */
#define VERTICES_A_REPORT 1024

typedef struct Lattice {
  size_t size[3]; /* points */
  double lower[3], step;
  float *value; /* per point, in steps; HUGE_VALF: not looked at */
} Lattice;

static size_t index_of(const Lattice *lattice, size_t i, size_t j, size_t k) {
  assert(i < lattice->size[0] && j < lattice->size[1] && k < lattice->size[2]);
  return (i * lattice->size[1] + j) * lattice->size[2] + k;
}

static SporeVec3 place_of(const Lattice *lattice, size_t index) {
  size_t k = index % lattice->size[2], j = index / lattice->size[2] % lattice->size[1],
         i = index / lattice->size[2] / lattice->size[1];
  return spore_vec3(lattice->lower[0] + lattice->step * (double)i, lattice->lower[1] + lattice->step * (double)j,
                    lattice->lower[2] + lattice->step * (double)k);
}

/* Values at all points of the block of cubes from i, j, k on, where the surface may pass through it. */
static void sample_block(Lattice *lattice, const size_t from[3], SporeDistanceField field, void *data) {
  size_t to[3];
  SporeVec3 middle = {lattice->lower[0] + lattice->step * ((double)from[0] + 0.5 * BLOCK),
                      lattice->lower[1] + lattice->step * ((double)from[1] + 0.5 * BLOCK),
                      lattice->lower[2] + lattice->step * ((double)from[2] + 0.5 * BLOCK)};
  for (int e = 0; e < 3; e++) {
    to[e] = from[e] + BLOCK;
    if (to[e] >= lattice->size[e]) to[e] = lattice->size[e] - 1;
  }
  if (fabs(field(data, middle)) > 0.5 * sqrt(3) * BLOCK * lattice->step) return;
  for (size_t i = from[0]; i <= to[0]; i++)
    for (size_t j = from[1]; j <= to[1]; j++)
      for (size_t k = from[2]; k <= to[2]; k++) {
        size_t at = index_of(lattice, i, j, k);
        if (lattice->value[at] < HUGE_VALF) continue;
        lattice->value[at] = (float)(field(data, place_of(lattice, at)) / lattice->step);
      }
}

static bool go_on(const SporeProgress *progress, double fraction, SporeError *error) {
  return spore_progress_step(progress, fraction, _("sampling the depth"), error);
}

static bool sample(Lattice *lattice, SporeDistanceField field, void *data, const SporeProgress *progress,
                   SporeError *error) {
  for (size_t i = 0; i + 1 < lattice->size[0]; i += BLOCK) {
    if (!go_on(progress, (double)i / (double)lattice->size[0], error)) return false;
    for (size_t j = 0; j + 1 < lattice->size[1]; j += BLOCK)
      for (size_t k = 0; k + 1 < lattice->size[2]; k += BLOCK)
        sample_block(lattice, (const size_t[3]){i, j, k}, field, data);
  }
  return true;
}

/* Cells. */

/* Numbers a point of the lattice, once. */
static uint32_t point_of(const Lattice *lattice, SporeIsosurfaceCells *cells, size_t index) {
  uint32_t *entry = spore_isosurface_entry(cells, LATTICE_POINT | index);
  if (entry && *entry == UINT32_MAX)
    *entry = spore_isosurface_add_point(cells, place_of(lattice, index), lattice->step * (double)lattice->value[index]);
  return entry ? *entry : UINT32_MAX;
}

/* Adds the six tetrahedra of a cube (Freudenthal): one for each path of three edges from corner 0 to corner 7. */
static bool add_cube(const Lattice *lattice, SporeIsosurfaceCells *cells, size_t cube) {
  static const unsigned paths[6][2] = {{1, 3}, {1, 5}, {2, 3}, {2, 6}, {4, 5}, {4, 6}};
  size_t at[8];
  uint32_t point[8];
  for (size_t c = 0; c < 8; c++) {
    at[c] = cube + (c >> 2) * lattice->size[1] * lattice->size[2] + (c >> 1 & 1) * lattice->size[2] + (c & 1);
    if (!(lattice->value[at[c]] < HUGE_VALF)) return true; /* the surface is not near */
    if (fabsf(lattice->value[at[c]]) > WIDE) return true;
  }
  for (size_t c = 0; c < 8; c++) {
    point[c] = point_of(lattice, cells, at[c]);
    if (point[c] == UINT32_MAX) return false;
  }
  for (size_t t = 0; t < 6; t++) {
    const SporeIsosurfaceCell cell = {.corner = {point[0], point[paths[t][0]], point[paths[t][1]], point[7]}, .tag = 3};
    if (!spore_isosurface_add_cell(cells, &cell)) return false;
  }
  return true;
}

static bool add_cubes(const Lattice *lattice, SporeIsosurfaceCells *cells, const SporeProgress *progress,
                      SporeError *error) {
  for (size_t i = 0; i + 1 < lattice->size[0]; i++) {
    if (!go_on(progress, 1, error)) return false;
    for (size_t j = 0; j + 1 < lattice->size[1]; j++)
      for (size_t k = 0; k + 1 < lattice->size[2]; k++)
        if (!add_cube(lattice, cells, index_of(lattice, i, j, k))) return spore_mesh_no_memory(error);
  }
  return true;
}

/* The surface. */

typedef struct Corners {
  uint64_t *edge; /* of each corner of a triangle: spore_isosurface_edge of what it lies on */
  size_t count, capacity;
} Corners;

static bool push(Corners *corners, uint64_t edge) {
  uint64_t *edges = spore_room_for_one(corners->edge, corners->count, &corners->capacity, 4096, sizeof *edges);
  if (!edges) return false;
  corners->edge = edges;
  edges[corners->count++] = edge;
  return true;
}

/* Adds a triangle, oriented outward, unless corners of it lie on one point. The midpoints of its edges decide on the
 * orientation, independent of the values. */
static bool add_triangle(const SporeIsosurfaceCells *cells, Corners *corners, uint32_t edges[3][2]) {
  SporeVec3 middle[3], out = {0, 0, 0};
  uint64_t at[3];
  for (int e = 0; e < 3; e++) {
    SporeVec3 in = cells->points[edges[e][0]].place, beyond = cells->points[edges[e][1]].place;
    middle[e] = spore_vec3_scale(0.5, spore_vec3_add(in, beyond));
    out = spore_vec3_add(out, spore_vec3_sub(beyond, in));
    at[e] = cells->points[edges[e][0]].on ? spore_isosurface_edge(edges[e][0], edges[e][0])
                                          : spore_isosurface_edge(edges[e][0], edges[e][1]);
  }
  if (at[0] == at[1] || at[1] == at[2] || at[2] == at[0]) return true;
  SporeVec3 normal = spore_vec3_cross(spore_vec3_sub(middle[1], middle[0]), spore_vec3_sub(middle[2], middle[0]));
  bool turned = !(spore_vec3_dot(normal, out) > 0);
  return push(corners, at[0]) && push(corners, at[1 + turned]) && push(corners, at[2 - turned]);
}

static bool cut_cells(const SporeIsosurfaceCells *cells, Corners *corners, SporeError *error) {
  uint32_t triangles[2][3][2];
  corners->count = 0;
  for (size_t i = 0; i < cells->cell_count; i++) {
    size_t count = cells->cells[i].tag ? spore_isosurface_cut(cells, &cells->cells[i], triangles) : 0;
    for (size_t t = 0; t < count; t++)
      if (!add_triangle(cells, corners, triangles[t])) return spore_mesh_no_memory(error);
  }
  return true;
}

static SporeVec3 vertex_at(const SporeIsosurfaceCells *cells, uint64_t edge) {
  const SporeIsosurfacePoint *one = &cells->points[edge >> 32], *other = &cells->points[(uint32_t)edge];
  return one == other ? one->place : spore_isosurface_root(cells, *one, *other);
}

/* Numbers the corners, in the order of what they lie on. edges: of each vertex. */
static bool number_corners(const Corners *corners, SporeTriangleMesh *mesh, uint64_t **edges, SporeError *error) {
  const size_t count = corners->count;
  size_t vertices = 0;
  uint64_t *sorted = SPORE_NEW_ARRAY(uint64_t, count);
  uint32_t *order = SPORE_NEW_ARRAY(uint32_t, count);
  bool made = sorted && order;
  for (size_t i = 0; made && i < count; i++) sorted[i] = corners->edge[i], order[i] = (uint32_t)i;
  if (!made || !spore_sort_keys(sorted, order, count)) made = spore_mesh_no_memory(error);
  for (size_t i = 0; made && i < count; i++) vertices += i == 0 || sorted[i] != sorted[i - 1];
  made = made && spore_triangle_mesh_allocate(mesh, vertices, count / 3, error);
  for (size_t i = 0, number = 0; made && i < count; i++) {
    if (i > 0 && sorted[i] != sorted[i - 1]) sorted[++number] = sorted[i];
    mesh->triangles[order[i]] = (uint32_t)number;
  }
  spore_free(order);
  if (!made) spore_free(sorted);
  *edges = made ? sorted : NULL;
  return made;
}

/* A mesh with what its vertices lie on: spore_isosurface_edge, ascending. */
typedef struct Made {
  SporeTriangleMesh mesh;
  uint64_t *edges;
} Made;

static void clear(Made *made) {
  spore_triangle_mesh_clear(&made->mesh);
  spore_free(made->edges);
  *made = (Made){.edges = NULL};
}

/* Places the vertices; those that were there before stay. */
static bool place_vertices(const SporeIsosurfaceCells *cells, Made *made, const Made *before, bool *fresh,
                           const SporeProgress *progress, SporeError *error) {
  for (size_t i = 0, j = 0; i < made->mesh.vertex_count; i++) {
    if (i % VERTICES_A_REPORT == 0 && !go_on(progress, (double)i / (double)made->mesh.vertex_count, error))
      return false;
    while (j < before->mesh.vertex_count && before->edges[j] < made->edges[i]) j++;
    fresh[i] = j == before->mesh.vertex_count || before->edges[j] != made->edges[i];
    if (fresh[i]) spore_vec3_store(made->mesh.vertices + 3 * i, vertex_at(cells, made->edges[i]));
    else memcpy(made->mesh.vertices + 3 * i, before->mesh.vertices + 3 * j, 3 * sizeof(double));
  }
  return true;
}

/* Makes the mesh, and takes points back that it should not have; changed: how many. */
static bool make_once(SporeIsosurfaceCells *cells, double tolerance, Corners *corners, Made *made, size_t *changed,
                      const SporeProgress *progress, SporeError *error) {
  Made before = *made;
  *made = (Made){.edges = NULL};
  bool *fresh = NULL;
  *changed = 0;
  bool done = cut_cells(cells, corners, error);
  if (done && corners->count > 0) {
    done = number_corners(corners, &made->mesh, &made->edges, error) &&
           ((fresh = SPORE_NEW_ARRAY(bool, made->mesh.vertex_count)) || spore_mesh_no_memory(error)) &&
           place_vertices(cells, made, &before, fresh, progress, error) &&
           spore_isosurface_unsnap(cells, &made->mesh, made->edges, fresh, tolerance, changed, error);
  }
  spore_free(fresh);
  clear(&before);
  return done;
}

static bool make_mesh(SporeIsosurfaceCells *cells, double tolerance, SporeTriangleMesh *mesh,
                      const SporeProgress *progress, SporeError *error) {
  Corners corners = {0};
  Made made = {.edges = NULL};
  bool done = true;
  for (size_t changed = 1; done && changed > 0;)
    done = make_once(cells, tolerance, &corners, &made, &changed, progress, error);
  spore_free(corners.edge);
  if (done) {
    *mesh = made.mesh;
    made.mesh = (SporeTriangleMesh){0};
  }
  clear(&made);
  return done;
}

static bool cut(SporeIsosurfaceCells *cells, double tolerance, SporeTriangleMesh *mesh, const SporeProgress *progress,
                SporeError *error) {
  return (isinf(tolerance) || (spore_isosurface_refine(cells, tolerance, progress, error) &&
                               spore_isosurface_snap(cells, progress, error))) &&
         make_mesh(cells, tolerance, mesh, progress, error);
}

bool spore_isosurface(const double lower[3], const double upper[3], double step, double tolerance,
                      SporeDistanceField field, void *data, SporeTriangleMesh *mesh, const SporeProgress *progress,
                      SporeError *error) {
  assert(step > 0 && tolerance >= 0);
  assert(lower[0] <= upper[0] && lower[1] <= upper[1] && lower[2] <= upper[2]);
  Lattice lattice = {.step = step};
  SporeIsosurfaceCells cells = {.field = field, .data = data, .step = step};
  double points = 1;
  *mesh = (SporeTriangleMesh){0};
  for (int e = 0; e < 3; e++) {
    double along = ceil((upper[e] - lower[e]) / step) + 1;
    points *= along;
    lattice.lower[e] = lower[e];
    lattice.size[e] = points <= MOST_POINTS ? (size_t)along : 0;
  }
  if (!(points <= MOST_POINTS))
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("the surface would need %g points of a lattice %g m apart; at most %g were expected; take "
                             "a larger step"),
                           points, step, MOST_POINTS);
  lattice.value = SPORE_NEW_ARRAY(float, (size_t)points);
  bool made = lattice.value != NULL;
  for (size_t i = 0; made && i < (size_t)points; i++) lattice.value[i] = HUGE_VALF;
  if (!made) spore_mesh_no_memory(error);
  made = made && sample(&lattice, field, data, progress, error) && add_cubes(&lattice, &cells, progress, error) &&
         cut(&cells, tolerance, mesh, progress, error);
  spore_free(lattice.value);
  spore_isosurface_clear(&cells);
  return made;
}
