/* Puts a scene together to read its plan, and times it beside itself with nothing left out. */
#include "ui/jobs/plan-work.h"

#include <glib/gi18n.h>

SporePlanWork *spore_plan_work_new(const SporeDocument *document, gboolean measured) {
  SporePlanWork *work = g_new0(SporePlanWork, 1);
  work->document = spore_document_copy(document);
  work->revision = spore_document_revision(document);
  work->measured = measured;
  return work;
}

static bool asked(void *data) { return !spore_progress(data, 0.5, _("Planning the step")); }

gboolean spore_plan_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporePlanWork *work = data;
  const SporeCancel cancel = {asked, (void *)(guintptr)progress};
  g_autofree double *ratios = g_new(double, SPORE_PRUNING_STEPS);
  work->simulation = spore_simulation_new(work->document, NULL, NULL, &cancel, error);
  if (!work->simulation) return FALSE;
  if (!work->measured) return TRUE;
  work->unpruned = spore_simulation_new_unpruned(work->document, NULL, NULL, &cancel, error);
  if (!work->unpruned) return FALSE;
  return spore_pruning_measure(work->simulation->world, work->unpruned->world, SPORE_PRUNING_STEPS, ratios,
                               &work->pruning) ||
         spore_error_raise(error, SPORE_ERROR_CANCELLED, "", "%s", _("cancelled"));
}

void spore_plan_work_free(gpointer data) {
  SporePlanWork *work = data;
  g_clear_pointer(&work->simulation, spore_simulation_free);
  g_clear_pointer(&work->unpruned, spore_simulation_free);
  spore_document_free(work->document);
  g_free(work);
}
