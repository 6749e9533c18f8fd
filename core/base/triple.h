/* Triple buffer: one thread writes whole values, another reads the newest; neither ever waits. The owner keeps three
 * values; this says which one belongs to whom. All zero is not a valid start: use SPORE_TRIPLE_INIT. */
#ifndef SPORE_BASE_TRIPLE_H
#define SPORE_BASE_TRIPLE_H

#include <stdatomic.h>
#include <stdbool.h>

typedef struct SporeTriple {
  int writing;        /* the writer's own */
  int reading;        /* the reader's own */
  atomic_int between; /* the third, with SPORE_TRIPLE_FRESH set when it is newer than the reader's */
} SporeTriple;

#define SPORE_TRIPLE_FRESH 4
#define SPORE_TRIPLE_INIT ((SporeTriple){.writing = 0, .reading = 1, .between = 2})

/* Writer: value [writing] is complete; *triple then names another to write. */
static inline void spore_triple_publish(SporeTriple *triple) {
  triple->writing = atomic_exchange(&triple->between, triple->writing | SPORE_TRIPLE_FRESH) & ~SPORE_TRIPLE_FRESH;
}

/* Reader: makes value [reading] the newest; false when it was already. */
static inline bool spore_triple_acquire(SporeTriple *triple) {
  if (!(atomic_load(&triple->between) & SPORE_TRIPLE_FRESH)) return false;
  triple->reading = atomic_exchange(&triple->between, triple->reading) & ~SPORE_TRIPLE_FRESH;
  return true;
}

#endif
