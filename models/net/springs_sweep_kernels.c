/* Springs met one after the other. */
#include <assert.h>

#include "models/net/springs.h"
#include "models/net/springs_lines.h"

SPORE_INLINE SporeVd3 place_of(SporeVd4 row) { return (SporeVd3){row.x, row.y, row.z}; }

/* Nodes of `count` springs, moved by s along the lines. */
SPORE_INLINE void move(double *now, const uint32_t *node, size_t count, SporeVd4 row, SporeVd step, SporeVd3 line) {
  SporeVd weighed = row.w * step;
  row.x += weighed * line.x, row.y += weighed * line.y, row.z += weighed * line.z;
  spore_vd4_scatter(now, node, count, row);
}

SPORE_INLINE void meet(const SporeSprings *springs, const SporeSpringsBatch *batch, size_t lane, size_t count,
                       const SporeSweep *at, bool damped) {
  const uint32_t *a = batch->a + lane, *b = batch->b + lane;
  SporeVd4 first = spore_vd4_gather(at->now, a), second = spore_vd4_gather(at->now, b);
  SporeVd length = spore_vd_load(batch->length + lane), square;
  SporeVd3 line = spore_vd3_sub(place_of(first), place_of(second));
  line = spore_line_not_short(springs->rest, a, b, line, length, &square);
  SporeVd stiffness = at->h * at->h * springs->stiffness * spore_vd_load(batch->share + lane), drag = {0};
  SporeVd pull = stiffness * (square - length * spore_vd_sqrt(square)); /* times l^2, as the line is n l */
  if (damped) {
    SporeVd3 moved = spore_vd3_sub(spore_vd3_gather(at->before, a), spore_vd3_gather(at->before, b));
    moved = spore_vd3_sub(spore_vd3_sub(place_of(first), place_of(second)), moved);
    drag = at->h * springs->damping * spore_vd_load(batch->held + lane);
    pull += drag * spore_vd3_dot(line, moved);
  }
  SporeVd step = -pull / (square * (1 + (first.w + second.w) * (stiffness + drag)));
  move(at->now, a, count, first, step, line);
  move(at->now, b, count, second, -step, line);
}

SPORE_INLINE void sweep(const SporeSprings *springs, const SporeSweep *at, bool damped) {
  const SporeSpringsSweep *order = &springs->sweep;
  for (size_t i = 0; i < order->count; i++) {
    const SporeSpringsBatch *batch = &order->batches[i];
    if (__builtin_expect(batch->count == SPORE_LANES, 1)) {
      for (size_t lane = 0; lane < SPORE_LANES; lane += SPORE_WIDTH)
        meet(springs, batch, lane, SPORE_WIDTH, at, damped);
      continue;
    }
    for (size_t lane = 0; lane < batch->count; lane += SPORE_WIDTH)
      meet(springs, batch, lane, batch->count - lane, at, damped);
  }
}

void SPORE_LEVEL_NAME(spore_springs_sweep_batches)(const SporeSprings *springs, const SporeSweep *at) {
  assert(at->h > 0 && springs->stiffness > 0);
  if (springs->damping > 0) sweep(springs, at, true);
  else sweep(springs, at, false);
}
