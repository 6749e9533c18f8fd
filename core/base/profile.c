/* Time by phase. */
#include "core/base/profile.h"

#include <time.h>

uint64_t spore_clock_ns(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (uint64_t)now.tv_sec * UINT64_C(1000000000) + (uint64_t)now.tv_nsec;
}

void spore_profile_add(SporeProfilePhase *phase, uint64_t duration_ns) {
  phase->recent[phase->count % SPORE_PROFILE_SAMPLES] = duration_ns;
  phase->count++;
  phase->total_ns += duration_ns;
  if (duration_ns > phase->max_ns) phase->max_ns = duration_ns;
}

uint64_t spore_profile_last_ns(const SporeProfilePhase *phase) {
  return phase->count ? phase->recent[(phase->count - 1) % SPORE_PROFILE_SAMPLES] : 0;
}

/* The rank-th smallest (from 0), by Hoare's selection; reorders the values. */
static uint64_t select_rank(uint64_t *values, size_t count, size_t rank) {
  size_t low = 0, high = count - 1;
  while (low < high) {
    uint64_t pivot = values[low + (high - low) / 2];
    size_t i = low, j = high;
    for (;;) {
      while (values[i] < pivot) i++;
      while (values[j] > pivot) j--;
      if (i >= j) break;
      uint64_t swapped = values[i];
      values[i++] = values[j];
      values[j--] = swapped;
    }
    if (rank <= j) high = j;
    else low = j + 1;
  }
  return values[rank];
}

SporeProfileSummary spore_profile_summary(const SporeProfilePhase *phase) {
  uint64_t samples[SPORE_PROFILE_SAMPLES];
  size_t kept = phase->count < SPORE_PROFILE_SAMPLES ? (size_t)phase->count : SPORE_PROFILE_SAMPLES;
  if (kept == 0) return (SporeProfileSummary){0};
  for (size_t i = 0; i < kept; i++) samples[i] = phase->recent[i];
  return (SporeProfileSummary){
      .median_us = (double)select_rank(samples, kept, (kept - 1) / 2) * 1e-3,
      .p99_us = (double)select_rank(samples, kept, (kept - 1) * 99 / 100) * 1e-3,
      .max_us = (double)phase->max_ns * 1e-3,
      .mean_us = (double)phase->total_ns / (double)phase->count * 1e-3,
  };
}
