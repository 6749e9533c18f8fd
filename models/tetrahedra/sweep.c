/* The order in which tetrahedra are met one after the other. */
#include "models/tetrahedra/sweep.h"

#include <assert.h>

#include "core/base/memory.h"
#include "models/common/batches.h"

void spore_tetrahedra_sweep_clear(SporeTetrahedraSweep *sweep) {
  spore_free(sweep->batches);
  spore_free(sweep->lanes);
  spore_free(sweep->source);
  *sweep = (SporeTetrahedraSweep){0};
}

/* Corners of all tetrahedra, 4 each, and where each is: batch x SPORE_LANES + lane. Returns their number. */
static size_t list(const SporeTetrahedra *tetrahedra, uint32_t *nodes, uint32_t *where) {
  size_t count = 0;
  for (size_t n = 0; n < tetrahedra->batch_count; n++)
    for (size_t lane = 0; lane < tetrahedra->lanes[n]; lane++) {
      for (size_t k = 0; k < 4; k++) nodes[4 * count + k] = tetrahedra->batches[n].node[k][lane];
      where[count++] = (uint32_t)(n * SPORE_LANES + lane);
    }
  return count;
}

static bool make(SporeTetrahedraSweep *sweep, const uint32_t *order, const uint32_t *where) {
  sweep->batches = SPORE_NEW_ARRAY(SporeTetrahedronBatch, sweep->count);
  sweep->lanes = SPORE_NEW_ARRAY(uint8_t, sweep->count);
  sweep->source = SPORE_NEW_ARRAY(uint32_t, sweep->count * SPORE_LANES);
  if (!sweep->batches || !sweep->lanes || !sweep->source) return false;
  for (size_t i = 0; i < sweep->count * SPORE_LANES; i++) {
    bool holds = order[i] != UINT32_MAX;
    sweep->source[i] = where[holds ? order[i] : order[i - i % SPORE_LANES]];
    sweep->lanes[i / SPORE_LANES] += holds;
  }
  sweep->stale = true;
  return true;
}

bool spore_tetrahedra_sweep_create(SporeTetrahedraSweep *sweep, const SporeTetrahedra *tetrahedra, size_t node_count) {
  assert(!tetrahedra->middles);
  if (sweep->source) return true;
  size_t most = tetrahedra->batch_count * SPORE_LANES;
  uint32_t *nodes = SPORE_NEW_ARRAY(uint32_t, 4 * most), *where = SPORE_NEW_ARRAY(uint32_t, most), *order = NULL;
  if (nodes && where) order = spore_batches_order(nodes, 4, list(tetrahedra, nodes, where), node_count, &sweep->count);
  bool made = order && make(sweep, order, where);
  spore_free(nodes);
  spore_free(where);
  spore_free(order);
  return made;
}

static void refresh(SporeTetrahedraSweep *sweep, const SporeTetrahedra *tetrahedra) {
  for (size_t i = 0; i < sweep->count * SPORE_LANES; i++) {
    SporeTetrahedronBatch *to = &sweep->batches[i / SPORE_LANES];
    const SporeTetrahedronBatch *from = &tetrahedra->batches[sweep->source[i] / SPORE_LANES];
    size_t lane = i % SPORE_LANES, its = sweep->source[i] % SPORE_LANES;
    for (size_t k = 0; k < 4; k++) to->node[k][lane] = from->node[k][its];
    for (size_t k = 0; k < 9; k++) to->inverse[k][lane] = from->inverse[k][its];
    to->volume[lane] = from->volume[its];
  }
  sweep->stale = false;
}

void spore_tetrahedra_sweep(SporeTetrahedraSweep *sweep, const SporeTetrahedra *tetrahedra, SporeElasticity elasticity,
                            const SporeSweep *at) {
  assert(sweep->source && at->h > 0);
  if (sweep->stale) refresh(sweep, tetrahedra);
  SPORE_KERNEL(spore_tetrahedra_sweep_batches)(sweep, elasticity, at);
}
