/* The order in which springs are met one after the other. */
#include "models/net/springs_sweep.h"

#include <assert.h>
#include <stdlib.h>

#include "core/base/memory.h"
#include "models/common/batches.h"
#include "models/net/springs.h"

typedef struct Pair { /* a spring: its nodes a < b, and its slot at a */
  uint32_t a, b, slot;
} Pair;

static int compare_pairs(const void *first, const void *second) {
  const Pair *a = first, *b = second;
  if (a->a != b->a) return a->a < b->a ? -1 : 1;
  return a->b < b->b ? -1 : a->b > b->b;
}

/* Each spring once, in the order of their nodes; returns their number. */
static size_t list_pairs(const SporeSprings *springs, Pair *pairs) {
  size_t count = 0;
  for (size_t g = 0; g < springs->group_count; g++)
    for (size_t i = SPORE_LANES * (size_t)springs->slot_start[g]; i < SPORE_LANES * (size_t)springs->slot_start[g + 1];
         i++) {
      uint32_t a = springs->node[g * SPORE_LANES + i % SPORE_LANES], b = springs->neighbour[i];
      if (a < b) pairs[count++] = (Pair){a, b, (uint32_t)i};
    }
  qsort(pairs, count, sizeof *pairs, compare_pairs);
  return count;
}

/* Lanes without a spring repeat the first one; they are not written back. */
static void fill_batch(SporeSpringsBatch *batch, const Pair *pairs, const uint32_t *order) {
  batch->count = 0;
  for (size_t lane = 0; lane < SPORE_LANES; lane++) {
    const Pair *pair = &pairs[order[lane] == UINT32_MAX ? order[0] : order[lane]];
    batch->a[lane] = pair->a, batch->b[lane] = pair->b, batch->slot[lane] = pair->slot;
    batch->count += order[lane] != UINT32_MAX;
  }
}

static bool make_batches(SporeSpringsSweep *sweep, const Pair *pairs, size_t count, uint32_t *nodes,
                         size_t node_count) {
  for (size_t k = 0; k < count; k++) nodes[2 * k] = pairs[k].a, nodes[2 * k + 1] = pairs[k].b;
  uint32_t *order = spore_batches_order(nodes, 2, count, node_count, &sweep->count);
  sweep->batches = order ? SPORE_NEW_ARRAY(SporeSpringsBatch, sweep->count) : NULL;
  for (size_t i = 0; sweep->batches && i < sweep->count; i++)
    fill_batch(&sweep->batches[i], pairs, order + i * SPORE_LANES);
  spore_free(order);
  return sweep->batches != NULL;
}

bool spore_springs_order(SporeSprings *springs, size_t node_count) {
  if (springs->sweep.batches) return true;
  size_t slots = SPORE_LANES * (size_t)springs->slot_start[springs->group_count];
  Pair *pairs = SPORE_NEW_ARRAY(Pair, slots);
  uint32_t *nodes = SPORE_NEW_ARRAY(uint32_t, 2 * slots);
  bool made = pairs && nodes && make_batches(&springs->sweep, pairs, list_pairs(springs, pairs), nodes, node_count);
  springs->sweep.stale = true;
  spore_free(pairs);
  spore_free(nodes);
  return made;
}

static void refresh(SporeSprings *springs) {
  for (size_t i = 0; i < springs->sweep.count; i++) {
    SporeSpringsBatch *batch = &springs->sweep.batches[i];
    for (size_t lane = 0; lane < SPORE_LANES; lane++) {
      uint32_t slot = batch->slot[lane];
      batch->held[lane] = springs->neighbour[slot] == batch->b[lane];
      batch->length[lane] = springs->length[slot];
      batch->share[lane] = batch->held[lane] * (springs->share ? springs->share[slot] : 1);
    }
  }
  springs->sweep.stale = false;
}

void spore_springs_sweep(SporeSprings *springs, size_t kinds, const SporeSweep *at) {
  assert(at->before && at->now && at->h > 0);
  for (size_t k = 0; k < kinds; k++) {
    if (!(springs[k].stiffness > 0)) continue;
    assert(springs[k].sweep.batches);
    if (springs[k].sweep.stale) refresh(&springs[k]);
    SPORE_KERNEL(spore_springs_sweep_batches)(&springs[k], at);
  }
}
