/* Nodes get the number of edges that lie between them and one at the end of the mesh as their level. A tetrahedron's
 * nodes are of one level or of two that follow each other, so that slabs made of whole levels touch their neighbours
 * alone. From a node at the end, found as the last that a search from the last reaches (Gibbs, Poole and Stockmeyer
 * 1976, "An algorithm for reducing the bandwidth and profile of a sparse matrix"), levels are many and small. */
#include "models/tetrahedra/slabs.h"

#include <assert.h>

#include "core/base/memory.h"

#define UNSEEN UINT32_MAX

typedef struct Search {
  const uint32_t *corners;
  size_t count, node_count;
  uint32_t *start, *element; /* node: its tetrahedra */
  uint32_t *level;           /* node; UNSEEN: not reached yet */
  uint32_t *queue;           /* nodes in the order in which they are reached */
} Search;

static void search_clear(Search *search) {
  spore_free(search->start);
  spore_free(search->element);
  spore_free(search->level);
  spore_free(search->queue);
}

static bool search_init(Search *search, const uint32_t *corners, size_t count, size_t node_count) {
  *search = (Search){.corners = corners, .count = count, .node_count = node_count};
  if (count > UINT32_MAX / 4) return false;
  search->start = SPORE_NEW_ARRAY(uint32_t, node_count + 2);
  search->element = SPORE_NEW_ARRAY(uint32_t, 4 * count);
  search->level = SPORE_NEW_ARRAY(uint32_t, node_count);
  search->queue = SPORE_NEW_ARRAY(uint32_t, node_count);
  if (!search->start || !search->element || !search->level || !search->queue) return false;
  for (size_t k = 0; k < 4 * count; k++) search->start[corners[k] + 2]++;
  for (size_t i = 0; i < node_count; i++) search->start[i + 2] += search->start[i + 1];
  for (size_t k = 0; k < 4 * count; k++) search->element[search->start[corners[k] + 1]++] = (uint32_t)(k / 4);
  for (size_t i = 0; i < node_count; i++) search->level[i] = UNSEEN;
  return true;
}

/* Numbers all that hangs together with `node`, which gets `level`. Returns the nodes reached, in the queue. */
static size_t spread(Search *search, uint32_t node, uint32_t level) {
  assert(node < search->node_count);
  size_t reached = 1;
  search->queue[0] = node;
  search->level[node] = level;
  for (size_t next = 0; next < reached; next++) {
    uint32_t from = search->queue[next];
    for (uint32_t e = search->start[from]; e < search->start[from + 1]; e++)
      for (int k = 0; k < 4; k++) {
        uint32_t to = search->corners[4 * (size_t)search->element[e] + (size_t)k];
        if (search->level[to] != UNSEEN) continue;
        search->level[to] = search->level[from] + 1;
        search->queue[reached++] = to;
      }
  }
  return reached;
}

/* The same from the node that is reached last from the one reached last. Returns the level behind. */
static uint32_t spread_from_end(Search *search, uint32_t node, uint32_t level) {
  assert(node < search->node_count && search->level[node] == UNSEEN);
  for (int round = 0; round < 2; round++) {
    size_t reached = spread(search, node, level);
    node = search->queue[reached - 1];
    for (size_t i = 0; i < reached; i++) search->level[search->queue[i]] = UNSEEN;
  }
  size_t reached = spread(search, node, level);
  return search->level[search->queue[reached - 1]] + 1;
}

static uint32_t set_levels(Search *search) {
  uint32_t level = 0;
  for (uint32_t i = 0; i < search->node_count; i++)
    if (search->level[i] == UNSEEN) level = spread_from_end(search, i, level);
  return level;
}

static uint32_t level_of(const Search *search, size_t tetrahedron) {
  assert(tetrahedron < search->count);
  uint32_t least = UNSEEN;
  for (int k = 0; k < 4; k++) {
    uint32_t level = search->level[search->corners[4 * tetrahedron + (size_t)k]];
    if (level < least) least = level;
  }
  return least;
}

/* Ends a slab where a level ends and its share is reached. size: levels, tetrahedra in each; becomes their slab. */
static void cut(SporeSlabs *slabs, uint32_t *size, uint32_t levels, size_t count, size_t wanted) {
  size_t taken = 0;
  for (uint32_t l = 0; l < levels; l++) {
    taken += size[l];
    size[l] = (uint32_t)slabs->count;
    size_t begin = slabs->start[slabs->count], left = count - begin;
    if (left > 0 && (taken - begin) * (wanted - slabs->count) >= left) slabs->start[++slabs->count] = (uint32_t)taken;
  }
}

static void divide(SporeSlabs *slabs, const Search *search, uint32_t *size, uint32_t levels, size_t wanted) {
  for (size_t t = 0; t < search->count; t++) size[level_of(search, t)]++;
  cut(slabs, size, levels, search->count, wanted);
  for (size_t t = 0; t < search->count; t++) slabs->order[slabs->start[size[level_of(search, t)]]++] = (uint32_t)t;
  for (size_t s = slabs->count; s > 0; s--) slabs->start[s] = slabs->start[s - 1];
  slabs->start[0] = 0;
}

bool spore_slabs_create(SporeSlabs *slabs, const uint32_t *corners, size_t count, size_t node_count, size_t wanted) {
  assert(count > 0 && wanted > 0);
  Search search;
  *slabs = (SporeSlabs){0};
  bool made = search_init(&search, corners, count, node_count);
  uint32_t levels = made ? set_levels(&search) : 0;
  uint32_t *size = SPORE_NEW_ARRAY(uint32_t, levels);
  slabs->start = SPORE_NEW_ARRAY(uint32_t, wanted + 1);
  slabs->order = SPORE_NEW_ARRAY(uint32_t, count);
  made = made && size && slabs->start && slabs->order;
  if (made) divide(slabs, &search, size, levels, wanted);
  spore_free(size);
  search_clear(&search);
  if (!made) spore_slabs_clear(slabs);
  return made;
}

void spore_slabs_clear(SporeSlabs *slabs) {
  spore_free(slabs->start);
  spore_free(slabs->order);
  *slabs = (SporeSlabs){0};
}
