/* Progress and cancelling of long work. Long functions take a `const SporeProgress *`, which may be NULL. */
#ifndef SPORE_BASE_PROGRESS_H
#define SPORE_BASE_PROGRESS_H

#include <stdbool.h>
#include <stddef.h>

#include "core/base/error.h"

/* What long work calls to tell how far it is. */
typedef struct SporeProgress {
  /* fraction 0..1; stage: translated, may be NULL. Returns false to cancel. Called often from the working thread. */
  bool (*report)(void *data, double fraction, const char *stage);
  void *data;
  /* May be NULL. What the work has come to so far, to be looked at: count x 4 numbers (x y z r, m), borrowed for the
   * call. From the working thread. */
  void (*show)(void *data, const double *spheres, size_t count);
} SporeProgress;

/* True to go on. */
static inline bool spore_progress(const SporeProgress *progress, double fraction, const char *stage) {
  return !progress || !progress->report || progress->report(progress->data, fraction, stage);
}

/* The same for functions that fail with an error. False: cancelled, and *error says so. */
bool spore_progress_step(const SporeProgress *progress, double fraction, const char *stage, SporeError *error);

/* Part of a longer piece of work: its fractions go to first .. first + share of the whole. */
typedef struct SporeProgressPart {
  const SporeProgress *whole; /* or NULL */
  double first, share;
} SporeProgressPart;
/* As spore_progress_step, by the fraction of the part. */
bool spore_progress_part(const SporeProgressPart *part, double fraction, const char *stage, SporeError *error);

/* A part of some work, with a progress of its own: what it says and shows goes on to that of the whole. */
typedef struct SporeProgressShare {
  const SporeProgress *whole; /* or NULL */
  double done, share;         /* of the whole: before this part, and of it; may change from call to call */
} SporeProgressShare;

/* The share must outlive it. */
SporeProgress spore_progress_of_share(SporeProgressShare *share);

#endif
