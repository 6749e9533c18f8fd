#include "core/mesh/isosurface.h"

#include <math.h>
#include <string.h>

#include "core/base/text.h"
#include "core/mesh/common.h"
#include "core/mesh/sort.h"

#define BLOCK 4 /* cubes, each way, that are left out together */
#define MOST_POINTS 1000000000.
#define ON                                                                                                             \
  1e-9 /* of the step: as near to a lattice point counts as inside of it, so that no triangle is without size */

typedef struct Lattice {
  size_t size[3]; /* points */
  double lower[3], step;
  float *value;   /* per point, in steps; HUGE_VALF: not looked at */
  uint64_t *edge; /* of each corner of a triangle: from its lower point x 8 + direction */
  size_t corner_count, capacity;
} Lattice;

static size_t index_of(const Lattice *lattice, size_t i, size_t j, size_t k) {
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
        float value = (float)(field(data, place_of(lattice, at)) / lattice->step);
        lattice->value[at] = fabsf(value) < (float)ON ? (float)-ON : value;
      }
}

static bool sample(Lattice *lattice, SporeDistanceField field, void *data, const SporeProgress *progress,
                   SporeError *error) {
  for (size_t i = 0; i + 1 < lattice->size[0]; i += BLOCK) {
    if (!spore_progress(progress, (double)i / (double)lattice->size[0], _("sampling the depth")))
      return spore_error_set(error, SPORE_ERROR_CANCELLED, NULL, _("cancelled"));
    for (size_t j = 0; j + 1 < lattice->size[1]; j += BLOCK)
      for (size_t k = 0; k + 1 < lattice->size[2]; k += BLOCK)
        sample_block(lattice, (const size_t[3]){i, j, k}, field, data);
  }
  return true;
}

/* Corner where the surface crosses from point a to b, whose places in the cube are the bits of low and high. */
static uint64_t crossing(const Lattice *lattice, size_t cube, unsigned a, unsigned b) {
  unsigned low = a & b, direction = a ^ b; /* of two on a path from corner 0 to 7 one is the other's lower */
  size_t at =
      cube + (low >> 2 & 1) * lattice->size[1] * lattice->size[2] + (low >> 1 & 1) * lattice->size[2] + (low & 1);
  return (uint64_t)at * 8 + direction;
}

static bool push(Lattice *lattice, const uint64_t corners[3]) {
  if (lattice->corner_count + 3 > lattice->capacity) {
    size_t capacity = 2 * lattice->capacity + 3072;
    uint64_t *edge = spore_reallocate(lattice->edge, lattice->capacity, capacity, sizeof *edge);
    if (!edge) return false;
    lattice->edge = edge;
    lattice->capacity = capacity;
  }
  memcpy(lattice->edge + lattice->corner_count, corners, 3 * sizeof *corners);
  lattice->corner_count += 3;
  return true;
}

/* An edge of a cube between two of its corners. */
typedef struct Edge {
  unsigned inside, outside;
} Edge;

static SporeVec3 corner_place(unsigned c) { return spore_vec3(c >> 2 & 1, c >> 1 & 1, c & 1); }

/* Outward: which way round is told by the middles of the edges, whatever the values are. */
static bool add_triangle(Lattice *lattice, size_t cube, const Edge edges[3]) {
  SporeVec3 middle[3], out = {0, 0, 0};
  uint64_t at[3];
  for (int e = 0; e < 3; e++) {
    SporeVec3 in = corner_place(edges[e].inside), beyond = corner_place(edges[e].outside);
    middle[e] = spore_vec3_scale(0.5, spore_vec3_add(in, beyond));
    out = spore_vec3_add(out, spore_vec3_sub(beyond, in));
    at[e] = crossing(lattice, cube, edges[e].inside, edges[e].outside);
  }
  SporeVec3 normal = spore_vec3_cross(spore_vec3_sub(middle[1], middle[0]), spore_vec3_sub(middle[2], middle[0]));
  const uint64_t turned[3] = {at[0], at[2], at[1]};
  return push(lattice, spore_vec3_dot(normal, out) > 0 ? at : turned);
}

/* The surface in one tetrahedron of a cube's corners. */
static bool cut_tetrahedron(Lattice *lattice, size_t cube, const unsigned corner[4], const float value[8]) {
  unsigned in[4], out[4], n = 0, m = 0;
  for (unsigned c = 0; c < 4; c++) {
    if (value[corner[c]] < 0) in[n++] = corner[c];
    else out[m++] = corner[c];
  }
  if (n == 0 || m == 0) return true;
  if (n == 1) return add_triangle(lattice, cube, (const Edge[3]){{in[0], out[0]}, {in[0], out[1]}, {in[0], out[2]}});
  if (n == 3) return add_triangle(lattice, cube, (const Edge[3]){{in[0], out[0]}, {in[1], out[0]}, {in[2], out[0]}});
  return add_triangle(lattice, cube, (const Edge[3]){{in[0], out[0]}, {in[0], out[1]}, {in[1], out[1]}}) &&
         add_triangle(lattice, cube, (const Edge[3]){{in[0], out[0]}, {in[1], out[1]}, {in[1], out[0]}});
}

/* Along each path of three edges from corner 0 to corner 7, one tetrahedron (Freudenthal's). */
static bool cut_cube(Lattice *lattice, size_t cube) {
  static const unsigned paths[6][2] = {{1, 3}, {1, 5}, {2, 3}, {2, 6}, {4, 5}, {4, 6}};
  float value[8];
  bool cut = true, any[2] = {false, false};
  for (unsigned c = 0; c < 8; c++) {
    value[c] =
        lattice
            ->value[cube + (c >> 2) * lattice->size[1] * lattice->size[2] + (c >> 1 & 1) * lattice->size[2] + (c & 1)];
    if (!(value[c] < HUGE_VALF)) return true; /* the surface does not come near */
    any[value[c] < 0] = true;
  }
  for (int t = 0; any[0] && any[1] && cut && t < 6; t++)
    cut = cut_tetrahedron(lattice, cube, (const unsigned[4]){0, paths[t][0], paths[t][1], 7}, value);
  return cut;
}

static SporeVec3 vertex_at(const Lattice *lattice, uint64_t edge) {
  size_t low = (size_t)(edge / 8), direction = edge % 8;
  size_t high = low + (direction >> 2 & 1) * lattice->size[1] * lattice->size[2] +
                (direction >> 1 & 1) * lattice->size[2] + (direction & 1);
  double a = (double)lattice->value[low], b = (double)lattice->value[high];
  SporeVec3 from = place_of(lattice, low), to = place_of(lattice, high);
  return spore_vec3_add_scaled(from, a / (a - b), spore_vec3_sub(to, from));
}

/* One vertex for each edge that is crossed. */
static bool make_mesh(const Lattice *lattice, SporeTriangleMesh *mesh, SporeError *error) {
  size_t corners = lattice->corner_count, vertices = 0;
  uint64_t *sorted = SPORE_NEW_ARRAY(uint64_t, corners);
  uint32_t *order = SPORE_NEW_ARRAY(uint32_t, corners);
  bool made = sorted && order;
  for (size_t i = 0; made && i < corners; i++) sorted[i] = lattice->edge[i], order[i] = (uint32_t)i;
  if (!made || !spore_sort_keys(sorted, order, corners)) made = spore_mesh_no_memory(error);
  for (size_t i = 0; made && i < corners; i++) vertices += i == 0 || sorted[i] != sorted[i - 1];
  made = made && spore_triangle_mesh_allocate(mesh, vertices, corners / 3, error);
  uint32_t number = 0;
  for (size_t i = 0; made && i < corners; i++) {
    if (i > 0 && sorted[i] != sorted[i - 1]) number++;
    mesh->triangles[order[i]] = number;
    if (i == 0 || sorted[i] != sorted[i - 1])
      spore_vec3_store(mesh->vertices + 3 * (size_t)number, vertex_at(lattice, sorted[i]));
  }
  spore_free(sorted);
  spore_free(order);
  return made;
}

static bool cut_all(Lattice *lattice, SporeError *error) {
  for (size_t i = 0; i + 1 < lattice->size[0]; i++)
    for (size_t j = 0; j + 1 < lattice->size[1]; j++)
      for (size_t k = 0; k + 1 < lattice->size[2]; k++)
        if (!cut_cube(lattice, index_of(lattice, i, j, k))) return spore_mesh_no_memory(error);
  return true;
}

bool spore_isosurface(const double lower[3], const double upper[3], double step, SporeDistanceField field, void *data,
                      SporeTriangleMesh *mesh, const SporeProgress *progress, SporeError *error) {
  Lattice lattice = {.step = step};
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
  made = made && sample(&lattice, field, data, progress, error) && cut_all(&lattice, error) &&
         (lattice.corner_count == 0 || make_mesh(&lattice, mesh, error));
  spore_free(lattice.value);
  spore_free(lattice.edge);
  return made;
}
