/* Springs that change while they run. A removed spring becomes an empty slot at both of its ends; a coagulated spring
 * gets shorter and stiffer. */
#include <assert.h>
#include <string.h>

#include "core/base/memory.h"
#include "models/net/springs.h"

static size_t lane_count(const SporeSprings *springs) {
  return SPORE_LANES * (size_t)springs->slot_start[springs->group_count];
}

bool spore_springs_keep(const SporeSprings *springs, size_t node_count, SporeSpringsWhole *whole) {
  size_t lanes = lane_count(springs);
  whole->neighbour = SPORE_NEW_ARRAY(uint32_t, lanes);
  whole->block = SPORE_NEW_ARRAY(uint32_t, lanes);
  whole->length = SPORE_NEW_ARRAY(double, lanes);
  whole->is_run = SPORE_NEW_ARRAY(bool, lanes / SPORE_LANES);
  whole->place = SPORE_NEW_ARRAY(uint32_t, node_count);
  if (!whole->neighbour || !whole->block || !whole->length || !whole->is_run || !whole->place) return false;
  memcpy(whole->neighbour, springs->neighbour, lanes * sizeof *whole->neighbour);
  memcpy(whole->block, springs->block, lanes * sizeof *whole->block);
  memcpy(whole->length, springs->length, lanes * sizeof *whole->length);
  memcpy(whole->is_run, springs->is_run, lanes / SPORE_LANES * sizeof *whole->is_run);
  for (size_t i = 0; i < node_count; i++) whole->place[i] = UINT32_MAX;
  for (size_t g = 0; g < springs->group_count; g++)
    for (size_t lane = 0; lane < springs->lanes[g]; lane++)
      whole->place[springs->node[g * SPORE_LANES + lane]] = (uint32_t)(g * SPORE_LANES + lane);
  return true;
}

void spore_springs_restore(SporeSprings *springs, const SporeSpringsWhole *whole) {
  assert(whole->neighbour && whole->place);
  size_t lanes = lane_count(springs);
  memcpy(springs->neighbour, whole->neighbour, lanes * sizeof *whole->neighbour);
  memcpy(springs->block, whole->block, lanes * sizeof *whole->block);
  memcpy(springs->length, whole->length, lanes * sizeof *whole->length);
  memcpy(springs->is_run, whole->is_run, lanes / SPORE_LANES * sizeof *whole->is_run);
  springs->lines->ready = false;
  springs->sweep.stale = true;
  for (size_t i = 0; springs->share && i < lanes; i++) springs->share[i] = 1, springs->dose[i] = 0;
}

void spore_springs_forget(SporeSpringsWhole *whole) {
  spore_free(whole->neighbour);
  spore_free(whole->block);
  spore_free(whole->length);
  spore_free(whole->is_run);
  spore_free(whole->place);
  *whole = (SporeSpringsWhole){0};
}

size_t spore_springs_find(const SporeSprings *springs, const SporeSpringsWhole *whole, uint32_t a, uint32_t b) {
  assert(whole->place);
  uint32_t place = whole->place[a];
  if (place == UINT32_MAX || a == b) return SPORE_NO_SPRING;
  size_t g = place / SPORE_LANES;
  for (size_t s = springs->slot_start[g]; s < springs->slot_start[g + 1]; s++) {
    size_t at = s * SPORE_LANES + place % SPORE_LANES;
    if (whole->neighbour[at] == b) return at;
  }
  return SPORE_NO_SPRING;
}

void spore_springs_visit(const SporeSprings *springs, void (*visit)(void *data, uint32_t a, uint32_t b, double length),
                         void *data) {
  for (size_t g = 0; g < springs->group_count; g++)
    for (size_t s = springs->slot_start[g]; s < springs->slot_start[g + 1]; s++)
      for (size_t lane = 0; lane < springs->lanes[g]; lane++) {
        size_t at = s * SPORE_LANES + lane;
        uint32_t node = springs->node[g * SPORE_LANES + lane];
        if (node < springs->neighbour[at]) visit(data, node, springs->neighbour[at], springs->length[at]);
      }
}

/* One end, at node a. */
static void empty(SporeSprings *springs, const SporeSpringsWhole *whole, uint32_t a, size_t at) {
  assert(whole->place[a] != UINT32_MAX);
  springs->neighbour[at] = a;
  springs->length[at] = -0.0;
  springs->block[at] = springs->diagonal[whole->place[a]];
  springs->is_run[at / SPORE_LANES] = false;
  springs->lines->ready = false;
  springs->sweep.stale = true;
}

bool spore_springs_part(SporeSprings *springs, const SporeSpringsWhole *whole, uint32_t a, uint32_t b) {
  if (!spore_springs_tie(springs, whole, a, b)) return false;
  empty(springs, whole, a, spore_springs_find(springs, whole, a, b));
  empty(springs, whole, b, spore_springs_find(springs, whole, b, a));
  return true;
}

bool spore_springs_share(SporeSprings *springs) {
  assert(!springs->share && !springs->dose);
  size_t lanes = lane_count(springs);
  springs->share = SPORE_NEW_ARRAY(double, lanes);
  springs->dose = SPORE_NEW_ARRAY(double, lanes);
  if (!springs->share || !springs->dose) return false;
  for (size_t i = 0; i < lanes; i++) springs->share[i] = 1;
  return true;
}

static bool is_near(const double *q, uint32_t node, const SporeHeat *heat) {
  return spore_vec3_distance(spore_vec3_load(q + 3 * (size_t)node), heat->point) < heat->radius;
}

static bool coagulate(SporeSprings *springs, const SporeSpringsWhole *whole, size_t at, const SporeHeat *heat) {
  assert(springs->share && springs->dose);
  double dose = spore_heat_dose(heat, springs->dose[at]);
  springs->dose[at] += dose;
  springs->length[at] -= heat->shrinkage * dose * whole->length[at];
  springs->share[at] += (heat->stiffening - 1) * dose;
  springs->sweep.stale = true;
  return dose > 0;
}

size_t spore_springs_coagulate(SporeSprings *springs, const SporeSpringsWhole *whole, const double *q,
                               const SporeHeat *heat) {
  assert(heat->radius >= 0);
  size_t ends = 0;
  for (size_t g = 0; g < springs->group_count; g++)
    for (size_t lane = 0; lane < springs->lanes[g]; lane++) {
      uint32_t node = springs->node[g * SPORE_LANES + lane];
      if (!is_near(q, node, heat)) continue;
      for (size_t s = springs->slot_start[g]; s < springs->slot_start[g + 1]; s++) {
        size_t at = s * SPORE_LANES + lane;
        uint32_t other = springs->neighbour[at];
        if (other != node && is_near(q, other, heat)) ends += coagulate(springs, whole, at, heat);
      }
    }
  return ends / 2;
}
