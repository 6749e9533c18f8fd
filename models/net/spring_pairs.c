#include "models/net/spring_pairs.h"

#include <assert.h>

#include "core/base/memory.h"
#include "core/mesh/half_edges.h"
#include "core/mesh/sort.h"

#define STRAIGHT                                                                                                       \
  (-0.75) /* cosine: between 135 degrees, a diagonal's neighbour, and 144, a vertex of five triangles                  \
           */

void spore_pairs_clear(SporePairs *pairs) {
  spore_free(pairs->keys);
  *pairs = (SporePairs){0};
}

static bool append(SporePairs *pairs, uint32_t a, uint32_t b) {
  assert(a != b);
  if (pairs->count == pairs->capacity) {
    size_t capacity = pairs->capacity ? 2 * pairs->capacity : 256;
    uint64_t *keys = spore_reallocate(pairs->keys, pairs->capacity, capacity, sizeof *keys);
    if (!keys) return false;
    pairs->keys = keys;
    pairs->capacity = capacity;
  }
  pairs->keys[pairs->count++] = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
  return true;
}

/* Sorts, and drops repeats and what is in `other` (may be NULL). */
static bool settle(SporePairs *pairs, const SporePairs *other, const SporePairs *another) {
  if (!spore_sort_keys(pairs->keys, NULL, pairs->count)) return false;
  const SporePairs *taken[2] = {other, another};
  size_t at[2] = {0, 0}, kept = 0;
  for (size_t i = 0; i < pairs->count; i++) {
    uint64_t key = pairs->keys[i];
    bool found = kept > 0 && pairs->keys[kept - 1] == key;
    for (int k = 0; k < 2; k++) {
      if (!taken[k]) continue;
      while (at[k] < taken[k]->count && taken[k]->keys[at[k]] < key) at[k]++;
      found = found || (at[k] < taken[k]->count && taken[k]->keys[at[k]] == key);
    }
    if (!found) pairs->keys[kept++] = key;
  }
  pairs->count = kept;
  return true;
}

bool spore_pairs_structural(SporePairs *pairs, const SporeTriangleMesh *mesh) {
  for (size_t h = 0; h < 3 * mesh->triangle_count; h++) {
    uint32_t a = mesh->triangles[h], b = mesh->triangles[h % 3 == 2 ? h - 2 : h + 1];
    if (a != b && !append(pairs, a, b)) return false;
  }
  return settle(pairs, NULL, NULL);
}

bool spore_pairs_shear(SporePairs *pairs, const SporeTriangleMesh *mesh, const SporePairs *structural) {
  assert(structural->count == 0 || structural->keys);
  SporeHalfEdges halves;
  if (!spore_half_edges_create(&halves, mesh->triangles, mesh->triangle_count)) return false;
  bool good = true;
  for (size_t begin = 0, end; good && begin < halves.count; begin = end) {
    end = spore_half_edges_end(&halves, begin);
    for (size_t i = begin; i < end; i++)
      for (size_t j = begin; good && j < i; j++) {
        /* The corner across from side s of a triangle is corner s + 2. */
        uint32_t hi = halves.half[i], hj = halves.half[j];
        uint32_t a = mesh->triangles[hi - hi % 3 + (hi + 2) % 3], b = mesh->triangles[hj - hj % 3 + (hj + 2) % 3];
        good = a == b || append(pairs, a, b);
      }
  }
  spore_half_edges_clear(&halves);
  return good && settle(pairs, structural, NULL);
}

/* Neighbours of vertex i: neighbour[start[i] .. start[i + 1]). */
static bool neighbours_of(const SporePairs *edges, size_t vertex_count, uint32_t **start, uint32_t **neighbour) {
  *start = SPORE_NEW_ARRAY(uint32_t, vertex_count + 2);
  *neighbour = SPORE_NEW_ARRAY(uint32_t, 2 * edges->count);
  if (!*start || !*neighbour) return false;
  uint32_t *fill = *start + 1; /* one place ahead: after filling it is where the next vertex begins */
  for (size_t e = 0; e < edges->count; e++) {
    fill[(edges->keys[e] >> 32) + 1]++;
    fill[(uint32_t)edges->keys[e] + 1]++;
  }
  for (size_t i = 0; i < vertex_count; i++) fill[i + 1] += fill[i];
  for (size_t e = 0; e < edges->count; e++) {
    uint32_t a = (uint32_t)(edges->keys[e] >> 32), b = (uint32_t)edges->keys[e];
    (*neighbour)[fill[a]++] = b;
    (*neighbour)[fill[b]++] = a;
  }
  return true;
}

static bool is_straight(const double *vertices, uint32_t a, uint32_t middle, uint32_t b) {
  assert(a != middle && b != middle);
  SporeVec3 m = spore_vec3_load(vertices + 3 * (size_t)middle);
  SporeVec3 da = spore_vec3_sub(spore_vec3_load(vertices + 3 * (size_t)a), m);
  SporeVec3 db = spore_vec3_sub(spore_vec3_load(vertices + 3 * (size_t)b), m);
  return spore_vec3_dot(da, db) < STRAIGHT * spore_vec3_length(da) * spore_vec3_length(db);
}

bool spore_pairs_bending(SporePairs *pairs, const SporeTriangleMesh *mesh, const SporePairs *structural,
                         const SporePairs *shear) {
  assert(structural->count == 0 || structural->keys);
  uint32_t *start, *neighbour;
  bool good = neighbours_of(structural, mesh->vertex_count, &start, &neighbour);
  for (size_t i = 0; good && i < mesh->vertex_count; i++)
    for (uint32_t j = start[i]; good && j < start[i + 1]; j++)
      for (uint32_t k = start[i]; good && k < j; k++)
        if (is_straight(mesh->vertices, neighbour[j], (uint32_t)i, neighbour[k]))
          good = append(pairs, neighbour[j], neighbour[k]);
  spore_free(start);
  spore_free(neighbour);
  return good && settle(pairs, structural, shear);
}
