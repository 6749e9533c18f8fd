/* Pacing: keeps simulated time in step with the clock by absolute deadlines, and measures how well that works.
 *
 * A step is due to begin when the clock reaches the simulated time of its beginning. It is due to have ended when the
 * clock reaches the simulated time of its end. */
#ifndef SPORE_MEASURE_PACE_H
#define SPORE_MEASURE_PACE_H

#include <stdbool.h>

#include "core/base/profile.h"

/* A delay above this is given up, so that a slow scene runs slowly instead of falling further and further behind. */
#define SPORE_PACE_SLACK_NS UINT64_C(100000000)

typedef struct SporePace {
  double speed;      /* simulated time by clock time; 0: as fast as possible, no step is ever due */
  uint64_t clock_ns; /* when simulated time was time_s */
  double time_s;
  uint64_t start_ns; /* of the statistics */
  double start_s;
  uint64_t steps, misses;       /* steps that ended; steps that ended too late */
  uint64_t worst_late_ns;       /* at the end of a step */
  uint64_t given_up_ns;         /* in all */
  SporeProfilePhase begin_late; /* jitter: delay of each step's beginning */
} SporePace;

typedef struct SporePaceSummary {
  uint64_t steps, misses;
  double worst_late_us;
  double jitter_median_us, jitter_p99_us, jitter_max_us;
  double factor;     /* simulated time by clock time, since the start */
  double given_up_s; /* 0: it kept pace */
} SporePaceSummary;

/* Begins now at simulated time `time_s`, with empty statistics. */
void spore_pace_start(SporePace *pace, double time_s, double speed);
/* Goes on at another speed; the statistics stay. */
void spore_pace_set_speed(SporePace *pace, double time_s, double speed);
/* When the step that begins at `time_s` is due, by spore_clock_ns; 0: at once. */
uint64_t spore_pace_due_ns(const SporePace *pace, double time_s);
/* Notes that the step which was due at `due_ns` begins now. */
void spore_pace_begin(SporePace *pace, uint64_t due_ns);
/* Notes that a step has ended now, at simulated time `time_s`. */
void spore_pace_end(SporePace *pace, double time_s);
/* Sleeps until `due_ns`; returns early on a signal. */
void spore_pace_sleep_until(uint64_t due_ns);

SporePaceSummary spore_pace_summary(const SporePace *pace, double time_s);

#endif
