/* A small pool of workers. What is computed does not depend on how many there are. */
#ifndef SPORE_BASE_THREADS_H
#define SPORE_BASE_THREADS_H

#include <stddef.h>

typedef struct SporePool SporePool;

/* threads counts the caller: 1 makes no worker. NULL: no memory or no threads to be had. */
SporePool *spore_pool_create(int threads);
void spore_pool_free(SporePool *pool);
int spore_pool_threads(const SporePool *pool);

/* Calls work(data, i) for each i in 0..count-1, in any order on any thread, and returns when all are done.
 * Takes no lock and allocates nothing. pool NULL runs in the caller. */
void spore_pool_run(SporePool *pool, size_t count, void (*work)(void *data, size_t index), void *data);

#endif
