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

/* Where the work is: the scene is put together twice, then both take their steps. */
typedef struct {
  const SporePlanWork *work;
  const SporeProgress *progress;
} Place;

static bool asked(void *data) {
  const Place *place = data;
  const SporePlanWork *work = place->work;
  double steps = work->unpruned ? (double)spore_world_step_count(work->unpruned->world) : 0;
  double fraction = work->unpruned ? 0.3 + 0.7 * steps / SPORE_PRUNING_STEPS : work->simulation ? 0.15 : 0;
  return !spore_progress(place->progress, fraction,
                         work->unpruned ? _("Taking steps, with nothing left out beside them")
                                        : _("Putting the scene together"));
}

gboolean spore_plan_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporePlanWork *work = data;
  Place place = {work, progress};
  const SporeCancel cancel = {asked, &place};
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

/* What it says. */

double spore_plan_work_measured_us(const SporePlanWork *work, const SporePlanStage *stage) {
  return work->measured && stage->profile ? spore_profile_summary(stage->profile).median_us : -1;
}

double spore_plan_work_saved_us(const SporePlanWork *work, const SporePlanLeftOut *left_out) {
  if (!work->unpruned) return -1;
  return spore_pruning_saved_us(work->simulation->world, work->unpruned->world, left_out->stages);
}

static void append_text(GString *csv, const char *text) {
  g_auto(GStrv) parts = g_strsplit(text, "\"", -1);
  g_autofree char *doubled = g_strjoinv("\"\"", parts);
  g_string_append_printf(csv, "\"%s\"", doubled);
}

/* Below 0: not known. */
static void append_us(GString *csv, double us) {
  char digits[G_ASCII_DTOSTR_BUF_SIZE];
  g_string_append_printf(csv, ",%s", us < 0 ? "" : g_ascii_formatd(digits, sizeof digits, "%.4g", us));
}

char *spore_plan_work_csv(const SporePlanWork *work) {
  const SporePlan *plan = spore_world_plan(work->simulation->world);
  GString *csv = g_string_new("what,included,items,estimate_us,measured_us,saves_us,reason\n");
  for (gsize i = 0; i < plan->stage_count; i++) {
    const SporePlanStage *stage = &plan->stages[i];
    append_text(csv, stage->name);
    g_string_append_printf(csv, ",%d,%zu", stage->included, stage->items);
    append_us(csv, stage->included ? stage->estimate_us : -1);
    append_us(csv, spore_plan_work_measured_us(work, stage));
    append_us(csv, -1);
    g_string_append_c(csv, ',');
    append_text(csv, stage->reason);
    g_string_append_c(csv, '\n');
  }
  for (gsize i = 0; i < plan->left_out_count; i++) {
    append_text(csv, plan->left_out[i].what);
    g_string_append(csv, ",0,,,");
    append_us(csv, spore_plan_work_saved_us(work, &plan->left_out[i]));
    g_string_append_c(csv, ',');
    append_text(csv, plan->left_out[i].reason);
    g_string_append_c(csv, '\n');
  }
  return g_string_free(csv, FALSE);
}

void spore_plan_work_free(gpointer data) {
  SporePlanWork *work = data;
  g_clear_pointer(&work->simulation, spore_simulation_free);
  g_clear_pointer(&work->unpruned, spore_simulation_free);
  spore_document_free(work->document);
  g_free(work);
}
