/* Runs an accuracy study of a copy of the scene. */
#include "ui/jobs/accuracy-work.h"

#include <glib/gi18n.h>
#include <string.h>

#include "ui/jobs/work-place.h"

SporeAccuracyWork *spore_accuracy_work_new(const SporeDocument *document) {
  SporeAccuracyWork *work = g_new0(SporeAccuracyWork, 1);
  work->document = spore_document_copy(document);
  work->methods = g_array_new(FALSE, FALSE, sizeof(SporeAccuracyMethod));
  return work;
}

/* Whether a body that is studied has the level. */
static gboolean has_level(const SporeDocument *document, const char *wanted, const char *level) {
  SporeObject *bodies = spore_document_section(document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i), *fidelity = spore_object_child_of(body, "fidelity");
    if (wanted && strcmp(wanted, spore_object_name(body)) != 0) continue;
    if (fidelity && spore_object_child_of(fidelity, level)) return TRUE;
  }
  return FALSE;
}

gboolean spore_accuracy_work_has_levels(const SporeDocument *document, const char *body) {
  return has_level(document, body, spore_lod_names[SPORE_LOD_COARSE]) ||
         has_level(document, body, spore_lod_names[SPORE_LOD_MEDIUM]);
}

gboolean spore_accuracy_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeAccuracyWork *work = data;
  SporeWorkPlace place;
  spore_work_place_init(&place, progress);
  static const double factors[] = {0.5, 1, 2};
  int levels[SPORE_LOD_COUNT];
  SporeAccuracyOptions options = {.body = work->body,
                                  .methods = (const SporeAccuracyMethod *)(gconstpointer)work->methods->data,
                                  .method_count = work->methods->len,
                                  .levels = levels,
                                  .spheres = factors,
                                  .sphere_count = work->spheres ? G_N_ELEMENTS(factors) : 0,
                                  .time_s = work->time_s,
                                  .full = work->full,
                                  .cancel = &place.cancel,
                                  .progress = &place.progress};
  for (int k = 0; work->levels && k < SPORE_LOD_COUNT; k++)
    if (k == SPORE_LOD_FINE || has_level(work->document, work->body, spore_lod_names[k]))
      levels[options.level_count++] = k;
  if (!spore_progress(&place.progress, 0, _("Putting the scene together")))
    return spore_error_raise(error, SPORE_ERROR_CANCELLED, "", "%s", _("cancelled"));
  g_autoptr(SporeSimulation) simulation = spore_simulation_new(work->document, NULL, NULL, &place.cancel, error);
  if (simulation) work->study = spore_accuracy_study_new(work->document, simulation, NULL, NULL, &options, error);
  return work->study != NULL;
}

void spore_accuracy_work_free(gpointer data) {
  SporeAccuracyWork *work = data;
  spore_accuracy_study_free(work->study);
  spore_document_free(work->document);
  g_array_unref(work->methods);
  g_free(work->body);
  g_free(work);
}
