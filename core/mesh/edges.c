/* The edges of triangles and tetrahedra, each once. */
#include <assert.h>

#include "core/mesh/common.h"
#include "core/mesh/sort.h"

/* Unique edges of elements; `pairs` lists the pairs of corners that an edge joins. */
static bool unique_edges(const uint32_t *elements, size_t count, size_t corners, const uint8_t (*pairs)[2],
                         size_t pair_count, uint32_t **edges, size_t *edge_count) {
  assert(corners == 3 || corners == 4);
  *edges = NULL;
  *edge_count = 0;
  uint64_t *keys = spore_allocate(count * pair_count, sizeof *keys);
  size_t n = 0;
  if (!keys) return false;
  for (size_t e = 0; e < count; e++)
    for (size_t p = 0; p < pair_count; p++) {
      uint32_t a = elements[corners * e + pairs[p][0]], b = elements[corners * e + pairs[p][1]];
      if (a != b) keys[n++] = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
    }
  bool sorted = spore_sort_keys(keys, NULL, n);
  size_t unique = 0;
  for (size_t i = 0; sorted && i < n; i++)
    if (i == 0 || keys[i] != keys[i - 1]) keys[unique++] = keys[i];
  uint32_t *result = sorted ? SPORE_NEW_ARRAY(uint32_t, 2 * unique) : NULL;
  for (size_t i = 0; result && i < unique; i++) {
    result[2 * i] = (uint32_t)(keys[i] >> 32);
    result[2 * i + 1] = (uint32_t)keys[i];
  }
  spore_free(keys);
  if (!result) return false;
  *edges = result;
  *edge_count = unique;
  return true;
}

bool spore_edges_of_triangles(const uint32_t *triangles, size_t count, uint32_t **edges, size_t *edge_count) {
  static const uint8_t pairs[3][2] = {{0, 1}, {1, 2}, {2, 0}};
  return unique_edges(triangles, count, 3, pairs, 3, edges, edge_count);
}

bool spore_edges_of_tetrahedra(const uint32_t *tetrahedra, size_t count, uint32_t **edges, size_t *edge_count) {
  static const uint8_t pairs[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  return unique_edges(tetrahedra, count, 4, pairs, 6, edges, edge_count);
}
