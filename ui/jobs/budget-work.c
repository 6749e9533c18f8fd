/* Finds the settings of a copy of the scene that fit a budget. */
#include "ui/jobs/budget-work.h"

#include <glib/gi18n.h>

#include "ui/jobs/work-place.h"

SporeBudgetWork *spore_budget_work_new(const SporeDocument *document, double budget_us) {
  SporeBudgetWork *work = g_new0(SporeBudgetWork, 1);
  work->document = spore_document_copy(document);
  work->budget_us = budget_us;
  return work;
}

gboolean spore_budget_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeBudgetWork *work = data;
  SporeWorkPlace place;
  spore_work_place_init(&place, progress);
  const SporeBudgetOptions options = {
      .budget_us = work->budget_us, .cancel = &place.cancel, .progress = &place.progress};
  if (!spore_progress(&place.progress, 0, _("Putting the scene together")))
    return spore_error_raise(error, SPORE_ERROR_CANCELLED, "", "%s", _("cancelled"));
  g_autoptr(SporeSimulation) simulation = spore_simulation_new(work->document, NULL, NULL, &place.cancel, error);
  if (simulation) work->budget = spore_budget_find(work->document, simulation, NULL, NULL, &options, error);
  return work->budget != NULL;
}

void spore_budget_work_free(gpointer data) {
  SporeBudgetWork *work = data;
  spore_budget_free(work->budget);
  spore_document_free(work->document);
  g_free(work);
}
