/* Makes the boundary of a mesh a manifold surface: separates cells that are connected only by an edge or a vertex. */
#include <math.h>
#include <string.h>

#include "core/generate/common/common.h"
#include "core/generate/common/stars.h"
#include "core/mesh/common.h"
#include "core/mesh/sort.h"

#define ROUNDS 8
#define AROUND 256 /* cells around a vertex, at most */

static bool has(const uint32_t cell[4], uint32_t v) {
  return cell[0] == v || cell[1] == v || cell[2] == v || cell[3] == v;
}

static bool share_face(const uint32_t a[4], const uint32_t b[4]) {
  int shared = 0;
  for (int k = 0; k < 4; k++) shared += has(b, a[k]);
  return shared == 3;
}

/* Groups the cells around v (and `other`, unless it is UINT32_MAX) that are connected by faces: group[i] is the
 * group of cells[i]. Returns the number of groups; 0: too many cells. */
static size_t group_cells(const SporeStars *stars, uint32_t v, uint32_t other, uint32_t *cells, uint32_t *group,
                          size_t *count) {
  const uint32_t *all = stars->mesh->tetrahedra;
  size_t groups = 0, waiting[AROUND], depth = 0;
  *count = 0;
  for (size_t i = stars->first[v]; i < stars->first[v + 1]; i++) {
    if (other != UINT32_MAX && !has(all + 4 * (size_t)stars->cells[i], other)) continue;
    if (*count == AROUND) return 0;
    group[*count] = UINT32_MAX;
    cells[(*count)++] = stars->cells[i];
  }
  for (size_t i = 0; i < *count; i++) {
    if (group[i] != UINT32_MAX) continue;
    group[i] = (uint32_t)groups;
    waiting[depth++] = i;
    while (depth) {
      size_t at = waiting[--depth];
      for (size_t j = 0; j < *count; j++)
        if (group[j] == UINT32_MAX && share_face(all + 4 * (size_t)cells[at], all + 4 * (size_t)cells[j]))
          group[j] = (uint32_t)groups, waiting[depth++] = j;
    }
    groups++;
  }
  return groups;
}

/* Each further group of cells around a vertex gets a vertex of its own. */
static bool part_vertices(SporeTetrahedralMesh *mesh, size_t *parted, SporeError *error) {
  SporeStars stars;
  uint32_t cells[AROUND], group[AROUND];
  size_t count, before = mesh->vertex_count, room = before;
  if (!spore_stars_create(&stars, mesh, NULL, error)) return false;
  bool done = true;
  for (uint32_t v = 0; done && v < before; v++) {
    size_t groups = stars.outer[v] ? group_cells(&stars, v, UINT32_MAX, cells, group, &count) : 0;
    for (uint32_t g = 1; g < groups && done; g++) {
      if (mesh->vertex_count == room) {
        double *grown = spore_reallocate(mesh->vertices, 3 * room, 3 * (room + 256), sizeof *grown);
        done = grown != NULL || spore_mesh_no_memory(error);
        if (!done) break;
        mesh->vertices = grown, room += 256;
      }
      uint32_t made = (uint32_t)mesh->vertex_count++;
      memcpy(mesh->vertices + 3 * (size_t)made, mesh->vertices + 3 * (size_t)v, 3 * sizeof(double));
      for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 4 && group[i] == g; k++)
          if (mesh->tetrahedra[4 * (size_t)cells[i] + (size_t)k] == v)
            mesh->tetrahedra[4 * (size_t)cells[i] + (size_t)k] = made;
      (*parted)++;
    }
  }
  spore_stars_clear(&stars);
  return done;
}

/* Edges with more than two faces of the boundary, smaller vertex << 32 | larger, from spore_allocate. */
static bool list_knots(const SporeTetrahedralMesh *mesh, uint64_t **edges, size_t *count) {
  uint32_t *faces;
  size_t face_count;
  *count = 0;
  if (!spore_tetrahedral_mesh_boundary(mesh, &faces, &face_count)) return false;
  uint64_t *keys = *edges = SPORE_NEW_ARRAY(uint64_t, 3 * face_count);
  for (size_t i = 0; keys && i < 3 * face_count; i++) {
    uint32_t a = faces[i], b = faces[i % 3 == 2 ? i - 2 : i + 1];
    keys[i] = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
  }
  bool done = keys && spore_sort_keys(keys, NULL, 3 * face_count);
  for (size_t i = 0, end; done && i < 3 * face_count; i = end) {
    for (end = i + 1; end < 3 * face_count && keys[end] == keys[i];) end++;
    if (end - i > 2) keys[(*count)++] = keys[i];
  }
  spore_free(faces);
  if (!done) spore_free(keys), *edges = NULL;
  return done;
}

/* Marks all groups of cells around an edge except the largest for removal. */
static void drop_wedges(const SporeStars *stars, uint32_t a, uint32_t b, bool *gone) {
  uint32_t cells[AROUND], group[AROUND];
  double volume[AROUND] = {0};
  size_t count, groups = group_cells(stars, a, b, cells, group, &count), largest = 0;
  for (size_t i = 0; i < count && groups; i++) {
    SporeVec3 p[4];
    for (size_t k = 0; k < 4; k++)
      p[k] = spore_mesh_vertex(stars->mesh->vertices, stars->mesh->tetrahedra[4 * (size_t)cells[i] + k]);
    volume[group[i]] += spore_vec3_volume(p[0], p[1], p[2], p[3]);
  }
  for (size_t g = 1; g < groups; g++)
    if (volume[g] > volume[largest]) largest = g;
  for (size_t i = 0; i < count && groups > 1; i++)
    if (group[i] != largest) gone[cells[i]] = true;
}

static bool part_edges(SporeTetrahedralMesh *mesh, size_t *parted, SporeError *error) {
  SporeStars stars = {0};
  uint64_t *edges = NULL;
  size_t kept = 0;
  bool *gone = SPORE_NEW_ARRAY(bool, mesh->tetrahedron_count);
  bool done = (gone && list_knots(mesh, &edges, parted)) || spore_mesh_no_memory(error);
  done = done && spore_stars_create(&stars, mesh, NULL, error);
  for (size_t e = 0; done && e < *parted; e++)
    drop_wedges(&stars, (uint32_t)(edges[e] >> 32), (uint32_t)edges[e], gone);
  for (size_t t = 0; done && t < mesh->tetrahedron_count; t++)
    if (!gone[t]) memmove(mesh->tetrahedra + 4 * kept++, mesh->tetrahedra + 4 * t, 4 * sizeof *mesh->tetrahedra);
  if (done) mesh->tetrahedron_count = kept;
  spore_stars_clear(&stars);
  spore_free(edges);
  spore_free(gone);
  return done;
}

bool spore_tetrahedra_mend(SporeTetrahedralMesh *mesh, SporeError *error) {
  for (int round = 0; round < ROUNDS; round++) {
    size_t vertices = 0, edges = 0;
    if (!part_vertices(mesh, &vertices, error) || !part_edges(mesh, &edges, error)) return false;
    if (!edges) break;
  }
  return spore_tetrahedral_mesh_drop_unused(mesh, error);
}
