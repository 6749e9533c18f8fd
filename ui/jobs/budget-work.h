/* A scene within a budget, as data for a SporeJob. No GTK. */
#ifndef SPORE_UI_JOBS_BUDGET_WORK_H
#define SPORE_UI_JOBS_BUDGET_WORK_H

#include "core/author/budget.h"
#include "core/base/progress.h"

typedef struct SporeBudgetWork {
  SporeDocument *document; /* a copy of the scene, the worker's own */
  double budget_us;
  SporeBudget *budget; /* out; taken by setting it to NULL */
} SporeBudgetWork;

SporeBudgetWork *spore_budget_work_new(const SporeDocument *document, double budget_us);
gboolean spore_budget_work_run(gpointer work, const SporeProgress *progress, GError **error);
void spore_budget_work_free(gpointer work);

#endif
