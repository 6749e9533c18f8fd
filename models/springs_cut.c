/* Springs that change while they run: a cut one becomes an empty slot, at both of its ends; a coagulated one gets
 * shorter and stiffer. */
#include <string.h>

#include "core/base/memory.h"
#include "models/springs.h"

static size_t lane_count(const SporeSprings *springs) {
  return SPORE_LANES * (size_t)springs->slot_start[springs->group_count];
}

bool spore_springs_keep(const SporeSprings *springs, SporeSpringsWhole *whole) {
  size_t lanes = lane_count(springs);
  whole->neighbour = SPORE_NEW_ARRAY(uint32_t, lanes);
  whole->block = SPORE_NEW_ARRAY(uint32_t, lanes);
  whole->length = SPORE_NEW_ARRAY(double, lanes);
  whole->is_run = SPORE_NEW_ARRAY(bool, lanes / SPORE_LANES);
  if (!whole->neighbour || !whole->block || !whole->length || !whole->is_run) return false;
  memcpy(whole->neighbour, springs->neighbour, lanes * sizeof *whole->neighbour);
  memcpy(whole->block, springs->block, lanes * sizeof *whole->block);
  memcpy(whole->length, springs->length, lanes * sizeof *whole->length);
  memcpy(whole->is_run, springs->is_run, lanes / SPORE_LANES * sizeof *whole->is_run);
  return true;
}

void spore_springs_restore(SporeSprings *springs, const SporeSpringsWhole *whole) {
  size_t lanes = lane_count(springs);
  memcpy(springs->neighbour, whole->neighbour, lanes * sizeof *whole->neighbour);
  memcpy(springs->block, whole->block, lanes * sizeof *whole->block);
  memcpy(springs->length, whole->length, lanes * sizeof *whole->length);
  memcpy(springs->is_run, whole->is_run, lanes / SPORE_LANES * sizeof *whole->is_run);
  for (size_t i = 0; springs->share && i < lanes; i++) springs->share[i] = 1, springs->dose[i] = 0;
}

void spore_springs_forget(SporeSpringsWhole *whole) {
  spore_free(whole->neighbour);
  spore_free(whole->block);
  spore_free(whole->length);
  spore_free(whole->is_run);
  *whole = (SporeSpringsWhole){0};
}

/* From the lower node, so that both ends of a spring are told the same. */
static bool is_cut(const double *q, uint32_t a, uint32_t b, const SporeVec3 triangle[3]) {
  uint32_t low = a < b ? a : b, high = a < b ? b : a;
  return spore_vec3_crosses(spore_vec3_load(q + 3 * (size_t)low), spore_vec3_load(q + 3 * (size_t)high), triangle[0],
                            triangle[1], triangle[2]);
}

static void record(SporeCuts *cuts, uint32_t body, uint32_t a, uint32_t b) {
  if (cuts && a < b && cuts->count < cuts->capacity) cuts->edges[cuts->count++] = (SporeCutEdge){body, a, b};
}

size_t spore_springs_cut(SporeSprings *springs, const double *q, const SporeVec3 triangle[3], uint32_t body,
                         SporeCuts *cuts) {
  size_t ends = 0;
  for (size_t g = 0; g < springs->group_count; g++)
    for (size_t s = springs->slot_start[g]; s < springs->slot_start[g + 1]; s++)
      for (size_t lane = 0; lane < springs->lanes[g]; lane++) {
        size_t at = s * SPORE_LANES + lane;
        uint32_t node = springs->node[g * SPORE_LANES + lane], other = springs->neighbour[at];
        if (node == other || !is_cut(q, node, other, triangle)) continue;
        springs->neighbour[at] = node;
        springs->length[at] = -0.0;
        springs->block[at] = springs->diagonal[g * SPORE_LANES + lane];
        springs->is_run[s] = false;
        record(cuts, body, node, other); /* of its two ends the lower */
        ends++;
      }
  return ends / 2;
}

bool spore_springs_share(SporeSprings *springs) {
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
  double dose = spore_heat_dose(heat, springs->dose[at]);
  springs->dose[at] += dose;
  springs->length[at] -= heat->shrinkage * dose * whole->length[at];
  springs->share[at] += (heat->stiffening - 1) * dose;
  return dose > 0;
}

size_t spore_springs_coagulate(SporeSprings *springs, const SporeSpringsWhole *whole, const double *q,
                               const SporeHeat *heat) {
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
