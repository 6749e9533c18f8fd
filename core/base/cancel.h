/* Whether long work is to end before it is done. */
#ifndef SPORE_BASE_CANCEL_H
#define SPORE_BASE_CANCEL_H

#include <stdbool.h>
#include <stddef.h>

/* What the kernel asks between two bounded pieces of work. The work is bounded by counts of blocks, columns and
 * iterations and never by a clock, so that asking changes no result. Functions take a `const SporeCancel *`, which may
 * be NULL: nobody ends the work. */
typedef struct SporeCancel {
  /* True: end the work. The answer stays true until the work has ended. Called from any thread, several at once. */
  bool (*asked)(void *data);
  void *data;
} SporeCancel;

/* Whether the work is to end. NULL: never. */
static inline bool spore_cancel_asked(const SporeCancel *cancel) { return cancel && cancel->asked(cancel->data); }

#endif
