/* A small pool of workers. What is computed does not depend on how many there are. */
#ifndef SPORE_BASE_THREADS_H
#define SPORE_BASE_THREADS_H

#include <stddef.h>

/* The workers; opaque. */
typedef struct SporePool SporePool;

/* threads counts the caller: 1 makes no worker. NULL: no memory or no threads to be had. */
SporePool *spore_pool_create(int threads);
/* Ends the workers and waits for them; they must have no work. NULL is allowed. */
void spore_pool_free(SporePool *pool);
/* How many threads compute, the caller among them; 1 for NULL. */
int spore_pool_threads(const SporePool *pool);

/* Calls work(data, i) for each i in 0..count-1, in any order on any thread, and returns when all are done.
 * Takes no lock and allocates nothing. pool NULL runs in the caller; so does one that has work already, so that what
 * runs in a pool may itself call it. */
void spore_pool_run(SporePool *pool, size_t count, void (*work)(void *data, size_t index), void *data);

/* The pool for what takes `work` units of roughly 10 ns; NULL where that is not worth calling workers, who may have
 * gone to sleep: below some 30 us. */
static inline SporePool *spore_pool_for(SporePool *pool, size_t work) { return work >= 3000 ? pool : NULL; }

#endif
