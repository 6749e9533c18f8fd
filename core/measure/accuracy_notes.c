/* What all parts of the accuracy study ask: its clock, what was cut, the finest level, the order of a method. */
#include <stdarg.h>
#include <stdio.h>
#include <time.h>

#include "core/base/memory.h"
#include "core/measure/accuracy_private.h"

double spore_processor_s(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double spore_study_elapsed_s(const SporeStudy *study) { return spore_processor_s() - study->started_s; }

void spore_study_cut(SporeStudy *study, const char *format, ...) {
  SporeAccuracyReport *report = study->report;
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  char **cuts = spore_reallocate(report->cuts, report->cut_count, report->cut_count + 1, sizeof *cuts);
  if (!cuts) return;
  report->cuts = cuts;
  if ((cuts[report->cut_count] = spore_copy_text(text))) report->cut_count++;
}

int spore_study_finest_level(const SporeAccuracyReport *report) {
  int level = -1;
  for (size_t i = 0; i < report->level_count; i++)
    if (report->levels[i].level > level) level = report->levels[i].level;
  return level;
}

double spore_study_nominal_order(SporeIntegratorKind kind) {
  switch (kind) {
  case SPORE_INTEGRATOR_RK4:
    return 4;
  case SPORE_INTEGRATOR_VERLET:
  case SPORE_INTEGRATOR_IMPLICIT_MIDPOINT:
  case SPORE_INTEGRATOR_BDF2:
  case SPORE_INTEGRATOR_TR_BDF2:
    return 2;
  default:
    return 1;
  }
}
