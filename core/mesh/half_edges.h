/* Directed sides of triangles, grouped by the edge they lie on. */
#ifndef SPORE_MESH_HALF_EDGES_H
#define SPORE_MESH_HALF_EDGES_H

#include <assert.h>

#include "core/mesh/mesh.h"

/* Half-edge h is side h % 3 of triangle h / 3, from corner h % 3 to the next. Sides of no length in the indices
 * (a to a) are left out. */
typedef struct SporeHalfEdges {
  size_t count;
  uint64_t *edge; /* count, ascending: smaller vertex << 32 | larger vertex */
  uint32_t *half; /* count: half-edge number */
} SporeHalfEdges;

bool spore_half_edges_create(SporeHalfEdges *halves, const uint32_t *triangles, size_t triangle_count);
void spore_half_edges_clear(SporeHalfEdges *halves);

/* Index behind the last half-edge on the same edge as `begin`. */
static inline size_t spore_half_edges_end(const SporeHalfEdges *halves, size_t begin) {
  assert(begin < halves->count);
  size_t end = begin + 1;
  while (end < halves->count && halves->edge[end] == halves->edge[begin]) end++;
  return end;
}

/* True when there is an edge between two vertices. */
bool spore_half_edges_have(const SporeHalfEdges *halves, uint32_t a, uint32_t b);

/* The next side of the same triangle. */
static inline uint32_t spore_half_edge_after(uint32_t half) { return half % 3 == 2 ? half - 2 : half + 1; }

/* True when the half-edge runs from the smaller to the larger vertex. */
static inline bool spore_half_edge_ascends(const uint32_t *triangles, uint32_t half) {
  return triangles[half] < triangles[spore_half_edge_after(half)];
}

/* Disjoint sets with path halving; `parent` starts as the identity. The least member stands for the set. */
static inline uint32_t spore_set_find(uint32_t *parent, uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}
static inline void spore_set_join(uint32_t *parent, uint32_t a, uint32_t b) {
  a = spore_set_find(parent, a);
  b = spore_set_find(parent, b);
  if (a < b) parent[b] = a;
  else parent[a] = b;
}

#endif
