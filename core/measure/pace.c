/* Keeps steps in pace with the clock, and counts how late they begin and end. */
#include "core/measure/pace.h"

#include <time.h>

void spore_pace_start(SporePace *pace, double time_s, double speed) {
  uint64_t now = spore_clock_ns();
  *pace = (SporePace){.speed = speed, .clock_ns = now, .start_ns = now, .time_s = time_s, .start_s = time_s};
}

void spore_pace_set_speed(SporePace *pace, double time_s, double speed) {
  pace->speed = speed;
  pace->clock_ns = spore_clock_ns();
  pace->time_s = time_s;
}

uint64_t spore_pace_due_ns(const SporePace *pace, double time_s) {
  if (!(pace->speed > 0)) return 0;
  double ahead_s = (time_s - pace->time_s) / pace->speed;
  return ahead_s > 0 ? pace->clock_ns + (uint64_t)(1e9 * ahead_s) : pace->clock_ns;
}

static uint64_t late_ns(uint64_t due_ns) {
  uint64_t now = spore_clock_ns();
  return now > due_ns ? now - due_ns : 0;
}

void spore_pace_begin(SporePace *pace, uint64_t due_ns) {
  if (pace->speed > 0) spore_profile_add(&pace->begin_late, late_ns(due_ns));
}

void spore_pace_end(SporePace *pace, double time_s) {
  pace->steps++;
  if (!(pace->speed > 0)) return;
  uint64_t late = late_ns(spore_pace_due_ns(pace, time_s));
  pace->misses += late > 0;
  if (late > pace->worst_late_ns) pace->worst_late_ns = late;
  if (late <= SPORE_PACE_SLACK_NS) return;
  pace->clock_ns += late;
  pace->given_up_ns += late;
}

void spore_pace_sleep_until(uint64_t due_ns) {
#ifdef __linux__
  struct timespec at = {.tv_sec = (time_t)(due_ns / 1000000000u), .tv_nsec = (long)(due_ns % 1000000000u)};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, NULL);
#else
  uint64_t now = spore_clock_ns(), left = due_ns > now ? due_ns - now : 0;
  struct timespec wait = {.tv_sec = (time_t)(left / 1000000000u), .tv_nsec = (long)(left % 1000000000u)};
  nanosleep(&wait, NULL);
#endif
}

SporePaceSummary spore_pace_summary(const SporePace *pace, double time_s) {
  SporeProfileSummary jitter = spore_profile_summary(&pace->begin_late);
  double passed_s = 1e-9 * (double)(spore_clock_ns() - pace->start_ns);
  return (SporePaceSummary){.steps = pace->steps,
                            .misses = pace->misses,
                            .worst_late_us = 1e-3 * (double)pace->worst_late_ns,
                            .jitter_median_us = jitter.median_us,
                            .jitter_p99_us = jitter.p99_us,
                            .jitter_max_us = jitter.max_us,
                            .factor = passed_s > 0 ? (time_s - pace->start_s) / passed_s : 0,
                            .given_up_s = 1e-9 * (double)pace->given_up_ns};
}
