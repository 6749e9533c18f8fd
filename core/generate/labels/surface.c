/* The closed surface of one label, by marching tetrahedra at the resolution of the voxels. */
#include <glib.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/labels/private.h"
#include "core/mesh/sort.h"

/* Nodes are the centres of the voxels in the label's box, widened by one voxel. Corners of the surface lie halfway
 * along edges from a node to a node with no lower index. key = node x 8 + a bit for each index that is one higher. */
typedef struct Marching {
  const SporeLabelMap *map;
  uint16_t label;
  int64_t lower[3], n[3]; /* of the nodes */
  GArray *keys;           /* guint64, three for each triangle */
} Marching;

/* The six tetrahedra of a cube around its diagonal (Freudenthal). A corner number has one bit for each index. */
static const uint8_t tetrahedra[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                         {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};

static bool find_box(Marching *m) {
  const size_t *size = m->map->size;
  size_t index = 0;
  int64_t upper[3] = {-1, -1, -1};
  for (int r = 0; r < 3; r++) m->lower[r] = (int64_t)size[r];
  for (int64_t k = 0; k < (int64_t)size[2]; k++)
    for (int64_t j = 0; j < (int64_t)size[1]; j++)
      for (int64_t i = 0; i < (int64_t)size[0]; i++) {
        if (m->map->labels[index++] != m->label) continue;
        const int64_t at[3] = {i, j, k};
        for (int r = 0; r < 3; r++) m->lower[r] = MIN(m->lower[r], at[r]), upper[r] = MAX(upper[r], at[r]);
      }
  for (int r = 0; r < 3; r++) {
    m->n[r] = upper[r] - m->lower[r] + 3;
    m->lower[r] -= 1;
  }
  return upper[0] >= 0;
}

static bool inside(const Marching *m, int64_t i, int64_t j, int64_t k) {
  const size_t *n = m->map->size;
  i += m->lower[0], j += m->lower[1], k += m->lower[2];
  if (i < 0 || j < 0 || k < 0 || i >= (int64_t)n[0] || j >= (int64_t)n[1] || k >= (int64_t)n[2]) return false;
  return m->map->labels[((size_t)k * n[1] + (size_t)j) * n[0] + (size_t)i] == m->label;
}

/* Key of the surface's corner between two corners of a cube. The bits of one corner must be a subset of the other's
 * bits. */
static guint64 key_between(const Marching *m, const int64_t cube[3], unsigned a, unsigned b) {
  unsigned low = a & b;
  int64_t at[3];
  for (int r = 0; r < 3; r++) at[r] = cube[r] + (low >> r & 1);
  return (guint64)((at[2] * m->n[1] + at[1]) * m->n[0] + at[0]) * 8 + (a ^ b);
}

static void corner_at(guint64 key, const int64_t n[3], double p[3]) {
  guint64 node = key / 8;
  p[0] = (double)(node % (guint64)n[0]) + 0.5 * (double)(key & 1);
  p[1] = (double)(node / (guint64)n[0] % (guint64)n[1]) + 0.5 * (double)(key >> 1 & 1);
  p[2] = (double)(node / (guint64)n[0] / (guint64)n[1]) + 0.5 * (double)(key >> 2 & 1);
}

/* Adds a triangle, oriented so that its normal in index space points along `way`: from the corners inside to the
 * corners outside. */
static void add_triangle(Marching *m, guint64 a, guint64 b, guint64 c, const double way[3]) {
  double p[3][3];
  const guint64 key[3] = {a, b, c};
  for (int k = 0; k < 3; k++) corner_at(key[k], m->n, p[k]);
  SporeVec3 o = spore_vec3_load(p[0]);
  SporeVec3 normal =
      spore_vec3_cross(spore_vec3_sub(spore_vec3_load(p[1]), o), spore_vec3_sub(spore_vec3_load(p[2]), o));
  gboolean turned = spore_vec3_dot(normal, spore_vec3_load(way)) < 0;
  const guint64 ordered[3] = {a, turned ? c : b, turned ? b : c};
  g_array_append_vals(m->keys, ordered, 3);
}

static void march_tetrahedron(Marching *m, const int64_t cube[3], unsigned in, const uint8_t corner[4]) {
  unsigned inner[4], outer[4];
  int inner_count = 0, outer_count = 0;
  double way[3] = {0, 0, 0};
  for (int k = 0; k < 4; k++) {
    bool is_in = in >> corner[k] & 1;
    if (is_in) inner[inner_count++] = corner[k];
    else outer[outer_count++] = corner[k];
  }
  if (inner_count == 0 || outer_count == 0) return;
  for (int r = 0; r < 3; r++) {
    for (int k = 0; k < outer_count; k++) way[r] += (double)(outer[k] >> r & 1) / outer_count;
    for (int k = 0; k < inner_count; k++) way[r] -= (double)(inner[k] >> r & 1) / inner_count;
  }
  if (inner_count != 2) {
    const unsigned *three = inner_count == 3 ? inner : outer;
    unsigned one = inner_count == 1 ? inner[0] : outer[0];
    add_triangle(m, key_between(m, cube, one, three[0]), key_between(m, cube, one, three[1]),
                 key_between(m, cube, one, three[2]), way);
    return;
  }
  guint64 a = key_between(m, cube, inner[0], outer[0]), b = key_between(m, cube, inner[0], outer[1]),
          c = key_between(m, cube, inner[1], outer[1]), d = key_between(m, cube, inner[1], outer[0]);
  add_triangle(m, a, b, c, way);
  add_triangle(m, a, c, d, way);
}

static bool march(Marching *m, const SporeProgress *progress, SporeError *error) {
  int64_t cube[3];
  for (cube[2] = 0; cube[2] + 1 < m->n[2]; cube[2]++) {
    if (!spore_progress_step(progress, (double)cube[2] / (double)m->n[2], _("tracing surfaces"), error)) return false;
    if (m->keys->len / 3 > SPORE_MESH_MAXIMUM)
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("the surface has over %u triangles; expected fewer; halve the volume's resolution"),
                             SPORE_MESH_MAXIMUM);
    for (cube[1] = 0; cube[1] + 1 < m->n[1]; cube[1]++)
      for (cube[0] = 0; cube[0] + 1 < m->n[0]; cube[0]++) {
        unsigned in = 0;
        for (unsigned c = 0; c < 8; c++)
          in |= (unsigned)inside(m, cube[0] + (c & 1), cube[1] + (c >> 1 & 1), cube[2] + (c >> 2)) << c;
        for (int t = 0; in != 0 && in != 255 && t < 6; t++) march_tetrahedron(m, cube, in, tetrahedra[t]);
      }
  }
  return true;
}

/* Gives each distinct key a vertex. order: room for a number of each key. */
static bool build_in_order(const Marching *m, uint32_t *order, SporeTriangleMesh *surface, SporeError *error) {
  size_t corners = m->keys->len, vertices = 0;
  uint64_t *keys = (uint64_t *)(void *)m->keys->data;
  for (size_t i = 0; i < corners; i++) order[i] = (uint32_t)i;
  if (!spore_sort_keys(keys, order, corners)) return spore_generate_no_memory(error);
  for (size_t i = 0; i < corners; i++) vertices += i == 0 || keys[i] != keys[i - 1];
  if (!spore_triangle_mesh_allocate(surface, vertices, corners / 3, error)) return false;
  vertices = 0;
  for (size_t i = 0; i < corners; i++) {
    if (i == 0 || keys[i] != keys[i - 1]) {
      double p[3];
      corner_at(keys[i], m->n, p);
      for (int k = 0; k < 3; k++) surface->vertices[3 * vertices + (size_t)k] = p[k] + (double)m->lower[k];
      vertices++;
    }
    surface->triangles[order[i]] = (uint32_t)(vertices - 1);
  }
  return true;
}

static bool build(const Marching *m, SporeTriangleMesh *surface, SporeError *error) {
  uint32_t *order = SPORE_NEW_ARRAY(uint32_t, m->keys->len);
  bool done = order ? build_in_order(m, order, surface, error) : spore_generate_no_memory(error);
  spore_free(order);
  return done;
}

/* Whether the index axes are left-handed in space; every triangle is then turned over. */
static bool mirrors(const SporeLabelMap *map) {
  const double *a = map->axes;
  return spore_vec3_dot(spore_vec3(a[0], a[4], a[8]),
                        spore_vec3_cross(spore_vec3(a[1], a[5], a[9]), spore_vec3(a[2], a[6], a[10]))) < 0;
}

void spore_label_surface_place(const SporeLabelMap *map, SporeTriangleMesh *surface) {
  for (size_t i = 0; i < surface->vertex_count; i++) {
    double *x = surface->vertices + 3 * i;
    spore_vec3_store(x, spore_label_map_place(map, x[0], x[1], x[2]));
  }
  for (size_t t = 0; mirrors(map) && t < surface->triangle_count; t++) {
    uint32_t *corner = surface->triangles + 3 * t, swap = corner[1];
    corner[1] = corner[2], corner[2] = swap;
  }
}

bool spore_label_surface(const SporeLabelMap *map, uint16_t label, SporeTriangleMesh *surface,
                         const SporeProgress *progress, SporeError *error) {
  Marching m = {.map = map, .label = label, .keys = g_array_new(FALSE, FALSE, sizeof(guint64))};
  bool done = find_box(&m) ||
              spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                              _("no voxel has the label %u; expected some; give one that there is"), (unsigned)label);
  done = done && march(&m, progress, error) && build(&m, surface, error);
  if (done) spore_label_surface_place(map, surface);
  g_array_unref(m.keys);
  return done;
}
