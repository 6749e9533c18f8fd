#include "core/base/memory.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#ifdef _WIN32
#include <malloc.h>
#endif

#define ALIGNMENT 64

static atomic_uint_fast64_t allocation_count;
static atomic_uint_fast64_t allocations_until_failure; /* 0: never */

static bool failure_is_due(void) {
  uint_fast64_t left = atomic_load(&allocations_until_failure);
  while (left > 0)
    if (atomic_compare_exchange_weak(&allocations_until_failure, &left, left - 1)) return left == 1;
  return false;
}

/* Bytes rounded up to whole cache lines, at least one; false on overflow. */
static bool padded_size(size_t count, size_t size, size_t *bytes) {
  if (__builtin_mul_overflow(count, size, bytes)) return false;
  if (*bytes > SIZE_MAX / 2) return false;
  *bytes = *bytes ? (*bytes + ALIGNMENT - 1) & ~(size_t)(ALIGNMENT - 1) : ALIGNMENT;
  return true;
}

static void *allocate_aligned(size_t count, size_t size) {
  atomic_fetch_add_explicit(&allocation_count, 1, memory_order_relaxed);
  size_t bytes;
  if (failure_is_due() || !padded_size(count, size, &bytes)) return NULL;
#ifdef _WIN32
  return _aligned_malloc(bytes, ALIGNMENT);
#else
  return aligned_alloc(ALIGNMENT, bytes);
#endif
}

void *spore_allocate(size_t count, size_t size) {
  void *memory = allocate_aligned(count, size);
  if (memory) memset(memory, 0, count * size);
  return memory;
}

void *spore_reallocate(void *memory, size_t old_count, size_t count, size_t size) {
  unsigned char *moved = allocate_aligned(count, size);
  if (!moved) return NULL;
  size_t kept = (memory ? old_count < count ? old_count : count : 0) * size;
  if (kept) memcpy(moved, memory, kept);
  memset(moved + kept, 0, count * size - kept);
  spore_free(memory);
  return moved;
}

void *spore_grow(void *memory, size_t *capacity, size_t first, size_t size) {
  size_t larger = *capacity ? 2 * *capacity : first;
  void *grown = spore_reallocate(memory, *capacity, larger, size);
  if (grown) *capacity = larger;
  return grown;
}

void spore_free(void *memory) {
#ifdef _WIN32
  _aligned_free(memory);
#else
  free(memory);
#endif
}

uint64_t spore_allocation_count(void) { return atomic_load(&allocation_count); }

void spore_allocation_fail_at(uint64_t n) { atomic_store(&allocations_until_failure, n); }

char *spore_copy_text(const char *text) {
  char *copy = SPORE_NEW_ARRAY(char, strlen(text) + 1);
  return copy ? strcpy(copy, text) : NULL;
}
