/* The connected pieces of a surface; taking one out, and appending a surface. */
#include <assert.h>
#include <string.h>

#include "core/mesh/common.h"
#include "core/mesh/edit.h"
#include "core/mesh/half_edges.h"

static void join_across_edges(const SporeHalfEdges *halves, uint32_t *parent) {
  for (size_t i = 0, end; i < halves->count; i = end) {
    end = spore_half_edges_end(halves, i);
    for (size_t j = i + 1; j < end; j++) spore_set_join(parent, halves->half[i] / 3, halves->half[j] / 3);
  }
}

bool spore_triangle_mesh_pieces(const SporeTriangleMesh *mesh, uint32_t **pieces, size_t *count, SporeError *error) {
  SporeHalfEdges halves;
  size_t n = mesh->triangle_count;
  uint32_t *parent = SPORE_NEW_ARRAY(uint32_t, n), *number = SPORE_NEW_ARRAY(uint32_t, n);
  *pieces = NULL;
  *count = 0;
  bool done = parent && number && spore_half_edges_create(&halves, mesh->triangles, n);
  if (done) {
    for (size_t t = 0; t < n; t++) parent[t] = (uint32_t)t;
    join_across_edges(&halves, parent);
    /* The least member represents its set, so that it has its number before other members need it. */
    for (size_t t = 0; t < n; t++) {
      uint32_t first = spore_set_find(parent, (uint32_t)t);
      number[t] = first == t ? (uint32_t)(*count)++ : number[first];
    }
    *pieces = number;
    number = NULL;
    spore_half_edges_clear(&halves);
  }
  spore_free(parent);
  spore_free(number);
  return done || spore_mesh_no_memory(error);
}

bool spore_triangle_mesh_extract(const SporeTriangleMesh *mesh, const uint32_t *pieces, uint32_t piece,
                                 SporeTriangleMesh *part, SporeError *error) {
  assert(pieces);
  uint32_t *number = SPORE_NEW_ARRAY(uint32_t, mesh->vertex_count); /* + 1; 0: not used */
  size_t triangles = 0, vertices = 0;
  if (!number) return spore_mesh_no_memory(error);
  for (size_t t = 0; t < mesh->triangle_count; t++)
    if (pieces[t] == piece) {
      for (int k = 0; k < 3; k++) number[mesh->triangles[3 * t + (size_t)k]] = 1;
      triangles++;
    }
  for (size_t i = 0; i < mesh->vertex_count; i++)
    if (number[i]) number[i] = (uint32_t)++vertices;
  bool done = spore_triangle_mesh_allocate(part, vertices, triangles, error);
  size_t kept = 0;
  for (size_t i = 0; done && i < mesh->vertex_count; i++)
    if (number[i]) memcpy(part->vertices + 3 * (number[i] - 1), mesh->vertices + 3 * i, 3 * sizeof(double));
  for (size_t t = 0; done && t < mesh->triangle_count; t++)
    if (pieces[t] == piece) {
      for (size_t k = 0; k < 3; k++) part->triangles[3 * kept + k] = number[mesh->triangles[3 * t + k]] - 1;
      kept++;
    }
  spore_free(number);
  return done;
}

bool spore_triangle_mesh_append(SporeTriangleMesh *mesh, const SporeTriangleMesh *more, SporeError *error) {
  assert(mesh != more);
  SporeTriangleMesh both;
  if (!spore_triangle_mesh_allocate(&both, mesh->vertex_count + more->vertex_count,
                                    mesh->triangle_count + more->triangle_count, error))
    return false;
  if (mesh->vertex_count) memcpy(both.vertices, mesh->vertices, 3 * mesh->vertex_count * sizeof(double));
  if (more->vertex_count)
    memcpy(both.vertices + 3 * mesh->vertex_count, more->vertices, 3 * more->vertex_count * sizeof(double));
  if (mesh->triangle_count) memcpy(both.triangles, mesh->triangles, 3 * mesh->triangle_count * sizeof(uint32_t));
  for (size_t i = 0; i < 3 * more->triangle_count; i++)
    both.triangles[3 * mesh->triangle_count + i] = more->triangles[i] + (uint32_t)mesh->vertex_count;
  both.reoriented = mesh->reoriented || more->reoriented;
  spore_triangle_mesh_clear(mesh);
  *mesh = both;
  return true;
}
