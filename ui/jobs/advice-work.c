/* Asks the advisor about a copy of the scene. */
#include "ui/jobs/advice-work.h"

#include <glib/gi18n.h>

#include "ui/jobs/work-place.h"

SporeAdviceWork *spore_advice_work_new(const SporeDocument *document) {
  SporeAdviceWork *work = g_new0(SporeAdviceWork, 1);
  work->document = spore_document_copy(document);
  return work;
}

gboolean spore_advice_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeAdviceWork *work = data;
  SporeWorkPlace place;
  spore_work_place_init(&place, progress);
  const SporeAdviceOptions options = {.cancel = &place.cancel, .progress = &place.progress};
  if (!spore_progress(&place.progress, 0, _("Putting the scene together")))
    return spore_error_raise(error, SPORE_ERROR_CANCELLED, "", "%s", _("cancelled"));
  g_autoptr(SporeSimulation) simulation = spore_simulation_new(work->document, NULL, NULL, &place.cancel, error);
  if (simulation) work->advice = spore_advice_find(work->document, simulation, &options, error);
  return work->advice != NULL;
}

void spore_advice_work_free(gpointer data) {
  SporeAdviceWork *work = data;
  spore_advice_free(work->advice);
  spore_document_free(work->document);
  g_free(work);
}
