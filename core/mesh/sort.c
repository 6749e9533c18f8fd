#include "core/mesh/sort.h"

#include <assert.h>
#include <string.h>

#include "core/base/memory.h"

#define DIGIT_BITS 11
#define DIGITS (1u << DIGIT_BITS)

static uint64_t greatest(const uint64_t *keys, size_t count) {
  uint64_t top = 0;
  for (size_t i = 0; i < count; i++) top |= keys[i];
  return top;
}

/* One counting pass on the digit at `shift`. */
static void sort_digit(const uint64_t *keys, const uint32_t *values, size_t count, unsigned shift,
                       uint64_t *sorted_keys, uint32_t *sorted_values) {
  assert(shift < 64);
  size_t start[DIGITS] = {0};
  for (size_t i = 0; i < count; i++) start[(keys[i] >> shift) & (DIGITS - 1)]++;
  size_t sum = 0;
  for (unsigned d = 0; d < DIGITS; d++) {
    size_t n = start[d];
    start[d] = sum;
    sum += n;
  }
  for (size_t i = 0; i < count; i++) {
    size_t to = start[(keys[i] >> shift) & (DIGITS - 1)]++;
    sorted_keys[to] = keys[i];
    if (values) sorted_values[to] = values[i];
  }
}

bool spore_sort_keys(uint64_t *keys, uint32_t *values, size_t count) {
  assert(count == 0 || keys);
  uint64_t *spare_keys = spore_allocate(count, sizeof *spare_keys);
  uint32_t *spare_values = values ? spore_allocate(count, sizeof *spare_values) : NULL;
  if (!spare_keys || (values && !spare_values)) {
    spore_free(spare_keys);
    spore_free(spare_values);
    return false;
  }
  uint64_t top = greatest(keys, count);
  uint64_t *from = keys, *to = spare_keys;
  uint32_t *from_values = values, *to_values = spare_values;
  for (unsigned shift = 0; shift < 64 && top >> shift; shift += DIGIT_BITS) {
    sort_digit(from, from_values, count, shift, to, to_values);
    uint64_t *k = from;
    from = to, to = k;
    uint32_t *v = from_values;
    from_values = to_values, to_values = v;
  }
  if (from != keys) {
    memcpy(keys, from, count * sizeof *keys);
    if (values) memcpy(values, from_values, count * sizeof *values);
  }
  spore_free(spare_keys);
  spore_free(spare_values);
  return true;
}
