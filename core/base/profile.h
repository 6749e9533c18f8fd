/* Time by phase. Fixed memory, no locks: one writer. */
#ifndef SPORE_BASE_PROFILE_H
#define SPORE_BASE_PROFILE_H

#include <stddef.h>
#include <stdint.h>

/* Monotonic clock. */
uint64_t spore_clock_ns(void);

#define SPORE_PROFILE_SAMPLES 4096 /* the last ones of a phase are kept */

/* The times that one phase took. All zero but for the name is a valid start. */
typedef struct SporeProfilePhase {
  const char *name;
  uint64_t count;                         /* samples ever taken */
  uint64_t recent[SPORE_PROFILE_SAMPLES]; /* ns, ring */
  uint64_t total_ns, max_ns;
} SporeProfilePhase;

/* What the samples of a phase come to. */
typedef struct SporeProfileSummary {
  double median_us, p99_us, max_us, mean_us; /* of the samples kept; max and mean of all */
} SporeProfileSummary;

/* Duration of the last sample, ns; 0 where there is none. */
uint64_t spore_profile_last_ns(const SporeProfilePhase *phase);
/* Adds a sample. */
void spore_profile_add(SporeProfilePhase *phase, uint64_t duration_ns);
/* Sums up the samples so far; all 0 without samples. Works on a copy of 32 KiB on the stack. */
SporeProfileSummary spore_profile_summary(const SporeProfilePhase *phase);

#endif
