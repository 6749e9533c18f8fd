/* What the accuracy study notes in its report while it goes on, and looks up there. */
#include <stdarg.h>
#include <stdio.h>

#include "core/base/memory.h"
#include "core/measure/accuracy_private.h"

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
