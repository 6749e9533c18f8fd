/* What a scene needs of a step, and what it leaves out, as data for a SporeJob. No GTK. */
#ifndef SPORE_UI_JOBS_PLAN_WORK_H
#define SPORE_UI_JOBS_PLAN_WORK_H

#include "core/base/progress.h"
#include "core/measure/pruning.h"
#include "core/scene/compile.h"

typedef struct SporePlanWork {
  SporeDocument *document;                /* a copy of the scene, the worker's own */
  guint64 revision;                       /* of the scene then */
  gboolean measured;                      /* beside itself with nothing left out */
  SporeSimulation *simulation, *unpruned; /* out; unpruned: NULL where nothing is measured */
  SporePruning pruning;                   /* out, where measured */
} SporePlanWork;
SporePlanWork *spore_plan_work_new(const SporeDocument *document, gboolean measured);
gboolean spore_plan_work_run(gpointer work, const SporeProgress *progress, GError **error);
void spore_plan_work_free(gpointer work);

/* Of a work that was done. us a step; below 0: not measured. What leaving out saves may be below 0 where that is noise,
 * too. */
double spore_plan_work_measured_us(const SporePlanWork *work, const SporePlanStage *stage);
double spore_plan_work_saved_us(const SporePlanWork *work, const SporePlanLeftOut *left_out);
/* The plan as a table, what is in and what is left out, numbers in the C locale; fields are empty where nothing is
 * known. g_free. */
char *spore_plan_work_csv(const SporePlanWork *work);

#endif
