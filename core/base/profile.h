/* Time by phase. Fixed memory, no locks: one writer. */
#ifndef SPORE_BASE_PROFILE_H
#define SPORE_BASE_PROFILE_H

#include <stddef.h>
#include <stdint.h>

/* Monotonic clock. */
uint64_t spore_clock_ns(void);

#define SPORE_PROFILE_SAMPLES 4096 /* the last ones of a phase are kept */

typedef struct SporeProfilePhase {
  const char *name;
  uint64_t count;                         /* samples ever taken */
  uint32_t recent[SPORE_PROFILE_SAMPLES]; /* ns, ring */
  uint64_t total_ns, max_ns;
} SporeProfilePhase;

typedef struct SporeProfileSummary {
  double median_us, p99_us, max_us, mean_us; /* of the samples kept; max and mean of all */
} SporeProfileSummary;

/* Of the last sample. */
uint64_t spore_profile_last_ns(const SporeProfilePhase *phase);
void spore_profile_add(SporeProfilePhase *phase, uint64_t duration_ns);
SporeProfileSummary spore_profile_summary(const SporeProfilePhase *phase);

#endif
