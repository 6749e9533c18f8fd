/* How far a work is that both tells its progress and asks whether to go on. No GTK. */
#ifndef SPORE_UI_JOBS_WORK_PLACE_H
#define SPORE_UI_JOBS_WORK_PLACE_H

#include "core/base/cancel.h"
#include "core/base/progress.h"

/* To ask whether to go on is to repeat the last word of the progress, so that asking does not change what is said. */
typedef struct SporeWorkPlace {
  const SporeProgress *whole;
  double fraction;
  SporeProgress progress; /* for the work */
  SporeCancel cancel;     /* likewise */
} SporeWorkPlace;

/* The place stays where it is while the work goes on. */
void spore_work_place_init(SporeWorkPlace *place, const SporeProgress *whole);

#endif
