/* Pacing: steps of simulated time kept in step with the clock, by absolute deadlines, and how well that went.
 *
 * A step is due to begin when the clock has reached the simulated time that it begins at, and to have ended when the
 * clock reaches the one that it ends at. */
#ifndef SPORE_MEASURE_PACE_H
#define SPORE_MEASURE_PACE_H

#include <stdbool.h>

#include "core/base/profile.h"

/* Time further behind than this is given up, so that a slow scene runs slowly instead of ever later. */
#define SPORE_PACE_SLACK_NS UINT64_C(100000000)

typedef struct SporePace {
  double speed;      /* simulated by clock time; 0: as fast as it goes, nothing is ever due */
  uint64_t clock_ns; /* when simulated time was time_s */
  double time_s;
  uint64_t start_ns; /* of the statistics */
  double start_s;
  uint64_t steps, misses;       /* steps ended; those that ended after they were due */
  uint64_t worst_late_ns;       /* at the end of a step */
  uint64_t given_up_ns;         /* in all */
  SporeProfilePhase begin_late; /* jitter: how long after it was due each step began */
} SporePace;

typedef struct SporePaceSummary {
  uint64_t steps, misses;
  double worst_late_us;
  double jitter_median_us, jitter_p99_us, jitter_max_us;
  double factor;     /* simulated by clock time since the start */
  double given_up_s; /* 0: it kept pace */
} SporePaceSummary;

/* Begins at simulated time `time_s`, now, with statistics of none. */
void spore_pace_start(SporePace *pace, double time_s, double speed);
/* Goes on at another speed; the statistics stay. */
void spore_pace_set_speed(SporePace *pace, double time_s, double speed);
/* When the step that begins at `time_s` is due, by spore_clock_ns; 0: at once. */
uint64_t spore_pace_due_ns(const SporePace *pace, double time_s);
/* The step that was due then begins now. */
void spore_pace_begin(SporePace *pace, uint64_t due_ns);
/* A step has ended at simulated time `time_s` now. */
void spore_pace_end(SporePace *pace, double time_s);
/* Waits in the kernel until then; returns early on a signal. */
void spore_pace_sleep_until(uint64_t due_ns);

SporePaceSummary spore_pace_summary(const SporePace *pace, double time_s);

#endif
