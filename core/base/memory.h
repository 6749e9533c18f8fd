/* Memory. Every allocation of the kernel passes here, so that tests can count and refuse them. */
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
void spore_free(void *memory);

#define SPORE_NEW(Type) ((Type *)spore_allocate(1, sizeof(Type)))
#define SPORE_NEW_ARRAY(Type, count) ((Type *)spore_allocate((count), sizeof(Type)))

/* For tests. Number of calls of spore_allocate and spore_reallocate by this process so far. */
uint64_t spore_allocation_count(void);
/* For tests. The n-th allocation from now (1 = the next) gives NULL; 0 switches it off. */
void spore_allocation_fail_at(uint64_t n);

/* Arena: scratch memory of a step. Blocks are taken with spore_arena_take and given back all together by
 * releasing a mark. It never grows inside a step: a take that does not fit returns NULL and is remembered in
 * high_water, and spore_arena_reserve between steps makes room. */
typedef struct SporeArena {
  unsigned char *memory;
  size_t capacity, used, high_water; /* bytes */
} SporeArena;

bool spore_arena_reserve(SporeArena *arena, size_t bytes);            /* only when nothing is taken; false: no memory */
void *spore_arena_take(SporeArena *arena, size_t count, size_t size); /* not zeroed, aligned to 64 */
static inline size_t spore_arena_mark(const SporeArena *arena) { return arena->used; }
static inline void spore_arena_release(SporeArena *arena, size_t mark) { arena->used = mark; }
void spore_arena_clear(SporeArena *arena); /* frees everything */

#endif
