/* The half-edges of a surface, sorted by edge. */
#include "core/mesh/half_edges.h"

#include "core/base/memory.h"
#include "core/mesh/sort.h"

bool spore_half_edges_create(SporeHalfEdges *halves, const uint32_t *triangles, size_t triangle_count) {
  *halves =
      (SporeHalfEdges){0, SPORE_NEW_ARRAY(uint64_t, 3 * triangle_count), SPORE_NEW_ARRAY(uint32_t, 3 * triangle_count)};
  if (halves->edge && halves->half) {
    for (size_t h = 0; h < 3 * triangle_count; h++) {
      uint32_t a = triangles[h], b = triangles[h % 3 == 2 ? h - 2 : h + 1];
      if (a == b) continue;
      halves->edge[halves->count] = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
      halves->half[halves->count++] = (uint32_t)h;
    }
    if (spore_sort_keys(halves->edge, halves->half, halves->count)) return true;
  }
  spore_half_edges_clear(halves);
  return false;
}

void spore_half_edges_clear(SporeHalfEdges *halves) {
  spore_free(halves->edge);
  spore_free(halves->half);
  *halves = (SporeHalfEdges){0};
}

bool spore_half_edges_have(const SporeHalfEdges *halves, uint32_t a, uint32_t b) {
  uint64_t key = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
  size_t low = 0, high = halves->count;
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (halves->edge[middle] < key) low = middle + 1;
    else high = middle;
  }
  return low < halves->count && halves->edge[low] == key;
}
