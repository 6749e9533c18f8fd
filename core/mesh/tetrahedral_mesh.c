/* Tetrahedral meshes: checks, boundary, neighbours, connected pieces. */
#include <math.h>
#include <string.h>

#include "core/base/text.h"
#include "core/mesh/common.h"
#include "core/mesh/half_edges.h"
#include "core/mesh/sort.h"

#define LEAST_VOLUME 1e-12 /* of the cubed longest edge */

bool spore_tetrahedral_mesh_allocate(SporeTetrahedralMesh *mesh, size_t vertices, size_t tetrahedra,
                                     SporeError *error) {
  *mesh = (SporeTetrahedralMesh){0};
  if (vertices > SPORE_MESH_MAXIMUM) return spore_mesh_too_large(error, vertices);
  if (tetrahedra > SPORE_MESH_MAXIMUM) return spore_mesh_too_large(error, tetrahedra);
  *mesh = (SporeTetrahedralMesh){vertices, tetrahedra, SPORE_NEW_ARRAY(double, 3 * vertices),
                                 SPORE_NEW_ARRAY(uint32_t, 4 * tetrahedra)};
  if (mesh->vertices && mesh->tetrahedra) return true;
  spore_tetrahedral_mesh_clear(mesh);
  return spore_mesh_no_memory(error);
}

void spore_tetrahedral_mesh_clear(SporeTetrahedralMesh *mesh) {
  spore_free(mesh->vertices);
  spore_free(mesh->tetrahedra);
  spore_free(mesh->labels);
  *mesh = (SporeTetrahedralMesh){0};
}

/* Volume over the cubed longest edge. */
static double relative_volume(const double *vertices, const uint32_t *corner) {
  SporeVec3 p[4];
  for (int k = 0; k < 4; k++) p[k] = spore_mesh_vertex(vertices, corner[k]);
  double longest = 0;
  for (int i = 0; i < 4; i++)
    for (int j = i + 1; j < 4; j++) longest = fmax(longest, spore_vec3_distance(p[i], p[j]));
  SporeVec3 cross = spore_vec3_cross(spore_vec3_sub(p[1], p[0]), spore_vec3_sub(p[2], p[0]));
  double volume = spore_vec3_dot(cross, spore_vec3_sub(p[3], p[0])) / 6;
  return longest > 0 ? volume / (longest * longest * longest) : 0;
}

bool spore_tetrahedral_mesh_validate(const SporeTetrahedralMesh *mesh, SporeError *error) {
  if (mesh->vertex_count > SPORE_MESH_MAXIMUM) return spore_mesh_too_large(error, mesh->vertex_count);
  if (mesh->tetrahedron_count > SPORE_MESH_MAXIMUM) return spore_mesh_too_large(error, mesh->tetrahedron_count);
  if (!mesh->vertex_count || !mesh->tetrahedron_count)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("the mesh has %zu vertices and %zu tetrahedra; at least one tetrahedron was expected; "
                             "choose a file that holds a volume mesh"),
                           mesh->vertex_count, mesh->tetrahedron_count);
  if (!spore_mesh_check_points(mesh->vertices, mesh->vertex_count, 3, _("vertex"), error) ||
      !spore_mesh_check_indices(mesh->tetrahedra, mesh->tetrahedron_count, 4, mesh->vertex_count, _("tetrahedron"),
                                error))
    return false;
  for (size_t t = 0; t < mesh->tetrahedron_count; t++) {
    double volume = relative_volume(mesh->vertices, mesh->tetrahedra + 4 * t);
    if (!(volume > LEAST_VOLUME))
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("tetrahedron %zu is %s; a positive volume was expected; mesh the solid again"), t,
                             volume < -LEAST_VOLUME ? _("inside out") : _("flat"));
  }
  return true;
}

const uint8_t spore_tetrahedron_faces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

static void face_of(const uint32_t *tetrahedra, uint32_t face, uint32_t corner[3]) {
  for (int k = 0; k < 3; k++) corner[k] = tetrahedra[4 * (size_t)(face / 4) + spore_tetrahedron_faces[face % 4][k]];
}

static void order_three(uint32_t v[3]) {
  uint32_t low = v[0] < v[1] ? v[0] : v[1], high = v[0] < v[1] ? v[1] : v[0], last = v[2];
  v[0] = low < last ? low : last;
  v[2] = high > last ? high : last;
  v[1] = low < last ? (high < last ? high : last) : low;
}

/* Sorts face numbers so that equal faces are neighbours: by the largest corner, then by the other two. */
static bool sort_faces(const uint32_t *tetrahedra, uint32_t *order, uint64_t *keys, size_t count) {
  uint32_t corner[3];
  for (size_t f = 0; f < count; f++) {
    order[f] = (uint32_t)f;
    face_of(tetrahedra, (uint32_t)f, corner);
    order_three(corner);
    keys[f] = corner[2];
  }
  if (!spore_sort_keys(keys, order, count)) return false;
  for (size_t f = 0; f < count; f++) {
    face_of(tetrahedra, order[f], corner);
    order_three(corner);
    keys[f] = (uint64_t)corner[0] << 32 | corner[1];
  }
  return spore_sort_keys(keys, order, count);
}

static bool same_face(const uint32_t *tetrahedra, uint32_t f, uint32_t g) {
  uint32_t a[3], b[3];
  face_of(tetrahedra, f, a);
  face_of(tetrahedra, g, b);
  order_three(a);
  order_three(b);
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* Keeps in `order` the faces that occur once, in the order of the tetrahedra. */
static bool keep_single_faces(const uint32_t *tetrahedra, uint32_t *order, uint64_t *keys, size_t count, size_t *kept) {
  *kept = 0;
  for (size_t i = 0, end; i < count; i = end) {
    for (end = i + 1; end < count && same_face(tetrahedra, order[i], order[end]);) end++;
    if (end == i + 1) keys[(*kept)++] = order[i];
  }
  return spore_sort_keys(keys, NULL, *kept);
}

bool spore_tetrahedral_mesh_boundary(const SporeTetrahedralMesh *mesh, uint32_t **triangles, size_t *triangle_count) {
  size_t count = 4 * mesh->tetrahedron_count, kept = 0;
  uint64_t *keys = SPORE_NEW_ARRAY(uint64_t, count);
  uint32_t *order = SPORE_NEW_ARRAY(uint32_t, count), *result = NULL;
  *triangles = NULL;
  *triangle_count = 0;
  if (keys && order && sort_faces(mesh->tetrahedra, order, keys, count) &&
      keep_single_faces(mesh->tetrahedra, order, keys, count, &kept))
    result = SPORE_NEW_ARRAY(uint32_t, 3 * kept);
  for (size_t i = 0; result && i < kept; i++) face_of(mesh->tetrahedra, (uint32_t)keys[i], result + 3 * i);
  spore_free(keys);
  spore_free(order);
  if (!result) return false;
  *triangles = result;
  *triangle_count = kept;
  return true;
}

bool spore_tetrahedral_mesh_neighbours(const SporeTetrahedralMesh *mesh, uint32_t **neighbours) {
  size_t count = 4 * mesh->tetrahedron_count;
  uint64_t *keys = SPORE_NEW_ARRAY(uint64_t, count);
  uint32_t *order = SPORE_NEW_ARRAY(uint32_t, count), *result = SPORE_NEW_ARRAY(uint32_t, count);
  bool done = keys && order && result && sort_faces(mesh->tetrahedra, order, keys, count);
  for (size_t i = 0; done && i < count; i++) result[i] = UINT32_MAX;
  for (size_t i = 0; done && i + 1 < count; i++)
    if (same_face(mesh->tetrahedra, order[i], order[i + 1])) {
      result[order[i]] = order[i + 1] / 4;
      result[order[i + 1]] = order[i] / 4;
    }
  spore_free(keys);
  spore_free(order);
  if (!done) spore_free(result);
  *neighbours = done ? result : NULL;
  return done;
}

bool spore_tetrahedral_mesh_drop_unused(SporeTetrahedralMesh *mesh, SporeError *error) {
  uint32_t *number = SPORE_NEW_ARRAY(uint32_t, mesh->vertex_count);
  size_t kept = 0;
  if (!number) return spore_mesh_no_memory(error);
  for (size_t i = 0; i < 4 * mesh->tetrahedron_count; i++) number[mesh->tetrahedra[i]] = 1;
  for (size_t v = 0; v < mesh->vertex_count; v++)
    if (number[v]) {
      memmove(mesh->vertices + 3 * kept, mesh->vertices + 3 * v, 3 * sizeof(double));
      number[v] = (uint32_t)kept++;
    }
  for (size_t i = 0; i < 4 * mesh->tetrahedron_count; i++) mesh->tetrahedra[i] = number[mesh->tetrahedra[i]];
  mesh->vertex_count = kept;
  spore_free(number);
  return true;
}

bool spore_tetrahedral_mesh_pieces(const SporeTetrahedralMesh *mesh, uint32_t **pieces, size_t *count,
                                   SporeError *error) {
  uint32_t *parent = SPORE_NEW_ARRAY(uint32_t, mesh->vertex_count);
  uint32_t *number = SPORE_NEW_ARRAY(uint32_t, mesh->vertex_count); /* of a set's root, + 1 */
  *pieces = parent && number ? SPORE_NEW_ARRAY(uint32_t, mesh->tetrahedron_count) : NULL;
  *count = 0;
  if (*pieces) {
    for (size_t v = 0; v < mesh->vertex_count; v++) parent[v] = (uint32_t)v;
    for (size_t i = 0; i < 4 * mesh->tetrahedron_count; i++)
      spore_set_join(parent, mesh->tetrahedra[i - i % 4], mesh->tetrahedra[i]);
    for (size_t t = 0; t < mesh->tetrahedron_count; t++) {
      uint32_t root = spore_set_find(parent, mesh->tetrahedra[4 * t]);
      if (!number[root]) number[root] = (uint32_t)++ * count;
      (*pieces)[t] = number[root] - 1;
    }
  }
  spore_free(parent);
  spore_free(number);
  return *pieces || spore_mesh_no_memory(error);
}
