/* The order in which springs are met: chains, side by side in batches. */
#include "models/net/springs_sweep.h"

#include <assert.h>
#include <stdlib.h>

#include "core/base/memory.h"
#include "models/net/spring_chains.h"
#include "models/net/springs.h"

#define LAST_COLOUR (SPORE_CHAIN_COLOURS - 1)

void spore_springs_sweep_clear(SporeSpringsSweep *sweep) {
  spore_free(sweep->batches);
  spore_free(sweep->node);
  spore_free(sweep->lanes);
  spore_free(sweep->slot);
  spore_free(sweep->length);
  spore_free(sweep->share);
  spore_free(sweep->held);
  spore_free(sweep->idle);
  spore_free(sweep->work);
  *sweep = (SporeSpringsSweep){0};
}

static int compare_pairs(const void *first, const void *second) {
  const SporeSpringPair *a = first, *b = second;
  if (a->a != b->a) return a->a < b->a ? -1 : 1;
  return a->b < b->b ? -1 : a->b > b->b;
}

/* Each spring once, in the order of their nodes; returns their number. */
static size_t list_pairs(const SporeSprings *springs, SporeSpringPair *pairs) {
  size_t count = 0;
  for (size_t g = 0; g < springs->group_count; g++)
    for (size_t i = SPORE_LANES * (size_t)springs->slot_start[g]; i < SPORE_LANES * (size_t)springs->slot_start[g + 1];
         i++) {
      uint32_t a = springs->node[g * SPORE_LANES + i % SPORE_LANES], b = springs->neighbour[i];
      if (a < b) pairs[count++] = (SporeSpringPair){a, b, (uint32_t)i};
    }
  qsort(pairs, count, sizeof *pairs, compare_pairs);
  return count;
}

typedef struct Place { /* of a chain in the order of batches */
  uint8_t colour;
  uint32_t length, chain;
} Place;

/* By colour, then the longest first. */
static int compare_places(const void *first, const void *second) {
  const Place *a = first, *b = second;
  if (a->colour != b->colour) return a->colour < b->colour ? -1 : 1;
  if (a->length != b->length) return a->length > b->length ? -1 : 1;
  return a->chain < b->chain ? -1 : a->chain > b->chain;
}

static Place *place_chains(const SporeSpringChains *chains) {
  Place *places = SPORE_NEW_ARRAY(Place, chains->count);
  for (uint32_t c = 0; places && c < chains->count; c++)
    places[c] = (Place){chains->colour[c], (uint32_t)spore_spring_chain_length(chains, c), c};
  if (places) qsort(places, chains->count, sizeof *places, compare_places);
  return places;
}

/* How many chains from `first` on go into one batch. */
static size_t batch_at(const Place *places, size_t count, size_t first) {
  size_t end = first + 1;
  if (places[first].colour == LAST_COLOUR) return 1; /* these may have nodes in common */
  while (end < count && end - first < SPORE_LANES && places[end].colour == places[first].colour) end++;
  return end - first;
}

static size_t padded(size_t count) { return (count + SPORE_LANES - 1) / SPORE_LANES * SPORE_LANES; }

static size_t spring_room(const SporeSpringsBatch *batch) { return padded(batch->length * batch->width); }
static size_t node_room(const SporeSpringsBatch *batch) { return spring_room(batch) + SPORE_LANES; }

/* Lays the batches out; false: no memory. */
static bool make_room(SporeSpringsSweep *sweep, const Place *places, size_t count) {
  size_t nodes = 0, springs = 0;
  sweep->batches = SPORE_NEW_ARRAY(SporeSpringsBatch, count);
  for (size_t first = 0, taken; sweep->batches && first < count; first += taken) {
    taken = batch_at(places, count, first);
    SporeSpringsBatch *batch = &sweep->batches[sweep->count++];
    *batch =
        (SporeSpringsBatch){taken > 1 ? SPORE_LANES : 1, places[first].length, nodes, springs, nodes / SPORE_LANES};
    nodes += node_room(batch);
    springs += spring_room(batch);
    size_t room = node_room(batch) + 3 * SPORE_LANES;
    if (room > sweep->room) sweep->room = room;
  }
  sweep->whole = count == 0 || places[count - 1].colour == 0;
  sweep->node = SPORE_NEW_ARRAY(uint32_t, nodes);
  sweep->lanes = SPORE_NEW_ARRAY(uint8_t, nodes / SPORE_LANES);
  sweep->slot = SPORE_NEW_ARRAY(uint32_t, springs);
  sweep->length = SPORE_NEW_ARRAY(double, springs);
  sweep->share = SPORE_NEW_ARRAY(double, springs);
  sweep->held = SPORE_NEW_ARRAY(double, springs);
  sweep->idle = SPORE_NEW_ARRAY(double, springs);
  sweep->work = SPORE_NEW_ARRAY(double, SPORE_SPRINGS_COLUMNS * sweep->room);
  return sweep->batches && sweep->node && sweep->lanes && sweep->slot && sweep->length && sweep->share && sweep->held &&
         sweep->idle && sweep->work;
}

/* Lane `lane` of a batch; the lanes before it are longer. */
static void fill_lane(SporeSpringsSweep *sweep, const SporeSpringsBatch *batch, size_t lane,
                      const SporeSpringChains *chains, size_t chain, const SporeSpringPair *pairs) {
  size_t length = spore_spring_chain_length(chains, chain), begin = chains->start[chain];
  for (size_t i = lane; i < node_room(batch); i += batch->width) {
    size_t n = i / batch->width;
    sweep->node[batch->node + i] = chains->node[begin + chain + (n < length ? n : length)];
    if (n <= length) sweep->lanes[batch->group + i / SPORE_LANES]++;
  }
  for (size_t i = lane; i < spring_room(batch); i += batch->width) {
    size_t n = i / batch->width;
    sweep->slot[batch->spring + i] = n < length ? pairs[chains->spring[begin + n]].slot : UINT32_MAX;
    sweep->idle[batch->spring + i] = n >= length;
  }
}

static void fill(SporeSpringsSweep *sweep, const Place *places, const SporeSpringChains *chains,
                 const SporeSpringPair *pairs) {
  size_t first = 0;
  for (size_t b = 0; b < sweep->count; b++) {
    const SporeSpringsBatch *batch = &sweep->batches[b];
    size_t taken = batch_at(places, chains->count, first);
    for (size_t lane = 0; lane < taken; lane++)
      fill_lane(sweep, batch, lane, chains, places[first + lane].chain, pairs);
    for (size_t i = 0; batch->width > 1 && i < spring_room(batch); i++)
      if (i % SPORE_LANES >= taken) sweep->slot[batch->spring + i] = UINT32_MAX, sweep->idle[batch->spring + i] = 1;
    for (size_t i = 0; batch->width > 1 && i < node_room(batch); i++)
      if (i % SPORE_LANES >= taken) sweep->node[batch->node + i] = sweep->node[batch->node];
    first += taken;
  }
}

bool spore_springs_order(SporeSprings *springs, size_t node_count) {
  if (springs->sweep.batches) return true;
  size_t slots = SPORE_LANES * (size_t)springs->slot_start[springs->group_count];
  SporeSpringPair *pairs = SPORE_NEW_ARRAY(SporeSpringPair, slots);
  SporeSpringChains chains = {0};
  bool found = pairs && spore_spring_chains_find(&chains, pairs, list_pairs(springs, pairs), springs->rest, node_count);
  Place *places = found ? place_chains(&chains) : NULL;
  bool made = places && make_room(&springs->sweep, places, chains.count);
  if (made) fill(&springs->sweep, places, &chains, pairs);
  else spore_springs_sweep_clear(&springs->sweep);
  springs->sweep.stale = true;
  spore_free(pairs);
  spore_free(places);
  spore_spring_chains_clear(&chains);
  return made;
}

/* Whether the spring from node j of the batch is there still. */
static bool is_held(const SporeSprings *springs, const SporeSpringsBatch *batch, size_t j) {
  const uint32_t *node = springs->sweep.node + batch->node + j;
  uint32_t slot = springs->sweep.slot[batch->spring + j];
  return slot != UINT32_MAX &&
         springs->neighbour[slot] == (node[0] > node[batch->width] ? node[0] : node[batch->width]);
}

static void refresh(SporeSprings *springs) {
  SporeSpringsSweep *sweep = &springs->sweep;
  for (size_t b = 0; b < sweep->count; b++) {
    const SporeSpringsBatch *batch = &sweep->batches[b];
    for (size_t j = 0; j < spring_room(batch); j++) {
      size_t i = batch->spring + j;
      sweep->held[i] = is_held(springs, batch, j);
      if (sweep->slot[i] == UINT32_MAX) continue;
      sweep->length[i] = springs->length[sweep->slot[i]];
      sweep->share[i] = sweep->held[i] * (springs->share ? springs->share[sweep->slot[i]] : 1);
    }
  }
  sweep->stale = false;
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

/* Whether no node is in two chains. */
static bool is_whole(const SporeSprings *springs, size_t kinds) {
  size_t stiff = 0;
  for (size_t k = 0; k < kinds; k++) {
    if (!(springs[k].stiffness > 0)) continue;
    if (!springs[k].sweep.whole || stiff++ > 0) return false;
  }
  return true;
}

double spore_springs_sweep_part(const SporeSprings *springs, size_t kinds) {
  return is_whole(springs, kinds) ? 0.6 : 0.9;
}
