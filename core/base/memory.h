/* Memory. Every allocation of the kernel passes here, and above it every one of a size that comes from a file and may
 * be refused, so that tests can count and refuse them. */
#ifndef SPORE_BASE_MEMORY_H
#define SPORE_BASE_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* count x size zeroed bytes, aligned to 64; NULL when there is no memory or the product overflows.
 * count 0 gives a valid pointer that may be freed. */
void *spore_allocate(size_t count, size_t size);
/* Grows or shrinks; what is new is zeroed; the old block stays valid on NULL. old_count is what it held. */
void *spore_reallocate(void *memory, size_t old_count, size_t count, size_t size);
/* Frees memory that one of the functions here gave; NULL is allowed. */
void spore_free(void *memory);
/* A copy of the text, from spore_allocate; NULL: no memory. */
char *spore_copy_text(const char *text);

/* Memory for twice *capacity elements of `size` bytes, or for `first`, in place of `memory`; *capacity is set, and
 * what is new is zeroed. NULL: no memory; the old block stays valid. See spore_room_for_one. */
void *spore_grow(void *memory, size_t *capacity, size_t first, size_t size);

/* `memory` with room for one more than `count` elements: itself, or in its place one of twice *capacity elements, or of
 * `first`, what is new zeroed. NULL: no memory; the old block stays valid. */
static inline void *spore_room_for_one(void *memory, size_t count, size_t *capacity, size_t first, size_t size) {
  return count < *capacity ? memory : spore_grow(memory, capacity, first, size);
}

/* One zeroed structure; NULL: no memory. */
#define SPORE_NEW(Type) ((Type *)spore_allocate(1, sizeof(Type)))
/* `count` zeroed structures; NULL: no memory. */
#define SPORE_NEW_ARRAY(Type, count) ((Type *)spore_allocate((count), sizeof(Type)))

/* For tests. Number of calls of spore_allocate and spore_reallocate by this process so far. */
uint64_t spore_allocation_count(void);
/* For tests. The n-th allocation from now (1 = the next) gives NULL; 0 switches it off. */
void spore_allocation_fail_at(uint64_t n);

#endif
