/* Elements in batches, by colours. */
#include "models/common/batches.h"

#include <assert.h>
#include <stdbool.h>

#include "core/base/memory.h"
#include "core/math/simd.h"

/* Elements of one colour have no node in common; those of the last one may, and are met one by one. */
#define WORDS 2
#define COLOURS (64 * WORDS)

static bool has(const uint64_t *words, size_t colour) { return words[colour / 64] >> colour % 64 & 1; }

/* colour: of each element; counts: elements of a colour; taken: WORDS a node, zero. */
static void colour_elements(const uint32_t *nodes, size_t corners, size_t count, uint64_t *taken, uint8_t *colour,
                            size_t counts[COLOURS]) {
  for (size_t e = 0; e < count; e++) {
    uint64_t all[WORDS] = {0};
    size_t first = 0;
    for (size_t k = 0; k < corners; k++)
      for (size_t w = 0; w < WORDS; w++) all[w] |= taken[WORDS * (size_t)nodes[corners * e + k] + w];
    while (first < COLOURS - 1 && has(all, first)) first++;
    for (size_t k = 0; k < corners; k++)
      taken[WORDS * (size_t)nodes[corners * e + k] + first / 64] |= (uint64_t)1 << first % 64;
    colour[e] = (uint8_t)first;
    counts[first]++;
  }
}

static size_t lanes_of(size_t colour) { return colour == COLOURS - 1 ? 1 : SPORE_LANES; }

/* Number of batches; first: of each colour. */
static size_t count_batches(const size_t counts[COLOURS], size_t first[COLOURS]) {
  size_t count = 0;
  for (size_t c = 0; c < COLOURS; c++) {
    first[c] = count;
    count += (counts[c] + lanes_of(c) - 1) / lanes_of(c);
  }
  return count;
}

static void fill(uint32_t *order, size_t batches, const uint8_t *colour, size_t count, const size_t first[COLOURS]) {
  size_t filled[COLOURS] = {0};
  for (size_t i = 0; i < batches * SPORE_LANES; i++) order[i] = UINT32_MAX;
  for (size_t e = 0; e < count; e++) {
    size_t c = colour[e], lanes = lanes_of(c), at = filled[c]++;
    order[(first[c] + at / lanes) * SPORE_LANES + at % lanes] = (uint32_t)e;
  }
}

uint32_t *spore_batches_order(const uint32_t *nodes, size_t corners, size_t count, size_t node_count, size_t *batches) {
  assert(corners > 0 && batches);
  size_t counts[COLOURS] = {0}, first[COLOURS];
  uint64_t *taken = SPORE_NEW_ARRAY(uint64_t, WORDS * node_count);
  uint8_t *colour = SPORE_NEW_ARRAY(uint8_t, count);
  uint32_t *order = NULL;
  if (taken && colour) {
    colour_elements(nodes, corners, count, taken, colour, counts);
    *batches = count_batches(counts, first);
    order = SPORE_NEW_ARRAY(uint32_t, *batches * SPORE_LANES);
    if (order) fill(order, *batches, colour, count, first);
  }
  spore_free(taken);
  spore_free(colour);
  return order;
}
