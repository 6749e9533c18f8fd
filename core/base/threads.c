/* A pool of workers that share the indices of a loop. */
#include "core/base/threads.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "core/base/memory.h"

/* macOS has no unnamed POSIX semaphores. */
#ifdef __APPLE__
#include <dispatch/dispatch.h>
typedef dispatch_semaphore_t Semaphore;
static bool semaphore_init(Semaphore *semaphore) { return (*semaphore = dispatch_semaphore_create(0)) != NULL; }
static void semaphore_clear(Semaphore *semaphore) { dispatch_release(*semaphore); }
static void semaphore_post(Semaphore *semaphore) { dispatch_semaphore_signal(*semaphore); }
static void semaphore_wait(Semaphore *semaphore) { dispatch_semaphore_wait(*semaphore, DISPATCH_TIME_FOREVER); }
#else
#include <errno.h>
#include <semaphore.h>
typedef sem_t Semaphore;
static bool semaphore_init(Semaphore *semaphore) { return sem_init(semaphore, 0, 0) == 0; }
static void semaphore_clear(Semaphore *semaphore) { sem_destroy(semaphore); }
static void semaphore_post(Semaphore *semaphore) { sem_post(semaphore); }
static void semaphore_wait(Semaphore *semaphore) {
  while (sem_wait(semaphore) != 0 && errno == EINTR) {
  }
}
#endif

#define SPINS 1000 /* some tens of microseconds: longer than the gap between two phases of a step */

/* A ticket is the job's number in the high half and the next index to hand out in the low half. An index is claimed
 * by compare-and-swap of the whole, so a worker that is late from an earlier job can never claim from a later one
 * with what it read before. CLOSED: the job's description is being written. */
#define CLOSED UINT32_MAX
#define BATCH ((size_t)UINT32_MAX - 1)

struct SporePool {
  _Atomic bool busy; /* from the first batch of a job to its end */
  _Atomic uint64_t ticket;
  /* Description of the job; valid while the ticket is the one that was read before it. */
  _Atomic(void (*)(void *, size_t)) work;
  _Atomic(void *) data;
  _Atomic size_t base, count;

  _Alignas(64) _Atomic size_t done; /* indices finished */
  _Atomic bool caller_sleeps;
  Semaphore finished;

  _Alignas(64) _Atomic int sleepers; /* workers in, or about to go into, semaphore_wait */
  _Atomic bool stop;
  Semaphore wake;

  int thread_count;
  pthread_t *workers; /* thread_count - 1 */
};

static inline void relax(void) {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  __asm__ __volatile__("yield");
#endif
}

/* Works until no index is left. */
static void help(SporePool *pool) {
  for (;;) {
    uint64_t ticket = atomic_load(&pool->ticket);
    uint32_t next = (uint32_t)ticket;
    void (*work)(void *, size_t) = atomic_load_explicit(&pool->work, memory_order_relaxed);
    void *data = atomic_load_explicit(&pool->data, memory_order_relaxed);
    size_t base = atomic_load_explicit(&pool->base, memory_order_relaxed);
    size_t count = atomic_load_explicit(&pool->count, memory_order_relaxed);
    if (next == CLOSED || next >= count) return;
    if (!atomic_compare_exchange_weak(&pool->ticket, &ticket, ticket + 1)) continue;
    work(data, base + next);
    if (atomic_fetch_add(&pool->done, 1) + 1 == count && atomic_exchange(&pool->caller_sleeps, false))
      semaphore_post(&pool->finished);
  }
}

/* Whether there may be something to do: a job newer than the last one seen, or the end. */
static bool is_called(SporePool *pool, uint32_t seen) {
  uint64_t ticket = atomic_load(&pool->ticket);
  return atomic_load(&pool->stop) || ((uint32_t)(ticket >> 32) != seen && (uint32_t)ticket != CLOSED);
}

/* Sleeps until it is woken, unless a job arrived in between. Each registration as a sleeper is taken back either here
 * or by the caller, which then posts once. */
static void sleep_until_called(SporePool *pool, uint32_t seen) {
  atomic_fetch_add(&pool->sleepers, 1);
  if (is_called(pool, seen)) {
    int sleepers = atomic_load(&pool->sleepers);
    while (sleepers > 0)
      if (atomic_compare_exchange_weak(&pool->sleepers, &sleepers, sleepers - 1)) return;
  }
  semaphore_wait(&pool->wake);
}

static void *worker_main(void *argument) {
  SporePool *pool = argument;
  uint32_t seen = 0;
  while (!atomic_load(&pool->stop)) {
    for (int spins = SPINS; spins > 0 && !is_called(pool, seen); spins--) relax();
    if (!is_called(pool, seen)) sleep_until_called(pool, seen);
    seen = (uint32_t)(atomic_load(&pool->ticket) >> 32);
    help(pool);
  }
  return NULL;
}

static void wake_workers(SporePool *pool, size_t wanted) {
  int sleepers = atomic_load(&pool->sleepers), woken;
  do woken = (size_t)sleepers < wanted ? sleepers : (int)wanted;
  while (!atomic_compare_exchange_weak(&pool->sleepers, &sleepers, sleepers - woken));
  for (int i = 0; i < woken; i++) semaphore_post(&pool->wake);
}

static void wait_until_done(SporePool *pool, size_t count) {
  for (int spins = SPINS; spins > 0; spins--) {
    if (atomic_load(&pool->done) == count) return;
    relax();
  }
  while (atomic_load(&pool->done) != count) {
    atomic_store(&pool->caller_sleeps, true);
    /* Where the last worker has taken the flag already, it posts, and the post must be consumed. */
    if (atomic_load(&pool->done) == count && atomic_exchange(&pool->caller_sleeps, false)) return;
    semaphore_wait(&pool->finished);
  }
}

static void run_batch(SporePool *pool, size_t base, size_t count, void (*work)(void *, size_t), void *data) {
  uint32_t job = (uint32_t)(atomic_load(&pool->ticket) >> 32);
  atomic_store(&pool->ticket, (uint64_t)(job + 1) << 32 | CLOSED);
  atomic_store_explicit(&pool->work, work, memory_order_relaxed);
  atomic_store_explicit(&pool->data, data, memory_order_relaxed);
  atomic_store_explicit(&pool->base, base, memory_order_relaxed);
  atomic_store_explicit(&pool->count, count, memory_order_relaxed);
  atomic_store_explicit(&pool->done, 0, memory_order_relaxed);
  atomic_store(&pool->ticket, (uint64_t)(job + 2) << 32);
  wake_workers(pool, count - 1);
  help(pool);
  wait_until_done(pool, count);
}

static bool take(SporePool *pool) {
  return !atomic_load_explicit(&pool->busy, memory_order_relaxed) && !atomic_exchange(&pool->busy, true);
}

void spore_pool_run(SporePool *pool, size_t count, void (*work)(void *data, size_t index), void *data) {
  if (!pool || pool->thread_count == 1 || count < 2 || !take(pool)) {
    for (size_t i = 0; i < count; i++) work(data, i);
    return;
  }
  for (size_t base = 0; base < count; base += BATCH)
    run_batch(pool, base, count - base < BATCH ? count - base : BATCH, work, data);
  atomic_store(&pool->busy, false);
}

SporePool *spore_pool_create(int threads) {
  SporePool *pool = SPORE_NEW(SporePool);
  if (!pool) return NULL;
  pool->thread_count = 1;
  pool->workers = SPORE_NEW_ARRAY(pthread_t, threads > 1 ? (size_t)threads - 1 : 0);
  if (!pool->workers || !semaphore_init(&pool->finished)) {
    spore_free(pool->workers);
    spore_free(pool);
    return NULL;
  }
  if (!semaphore_init(&pool->wake)) {
    semaphore_clear(&pool->finished);
    spore_free(pool->workers);
    spore_free(pool);
    return NULL;
  }
  for (; pool->thread_count < threads; pool->thread_count++)
    if (pthread_create(&pool->workers[pool->thread_count - 1], NULL, worker_main, pool) != 0) {
      spore_pool_free(pool);
      return NULL;
    }
  return pool;
}

void spore_pool_free(SporePool *pool) {
  if (!pool) return;
  atomic_store(&pool->stop, true);
  wake_workers(pool, (size_t)pool->thread_count);
  for (int i = 0; i < pool->thread_count - 1; i++) pthread_join(pool->workers[i], NULL);
  semaphore_clear(&pool->finished);
  semaphore_clear(&pool->wake);
  spore_free(pool->workers);
  spore_free(pool);
}

int spore_pool_threads(const SporePool *pool) { return pool ? pool->thread_count : 1; }
