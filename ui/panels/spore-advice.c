/* The box of the advisor. */
#include "ui/panels/spore-advice.h"

#include <glib/gi18n.h>

#include "ui/jobs/advice-work.h"
#include "ui/panels/report.h"
#include "ui/panels/spore-finding.h"

static gpointer work_new(const SporeDocument *document, gpointer data) { return spore_advice_work_new(document); }

static gpointer take(gpointer work) { return g_steal_pointer(&((SporeAdviceWork *)work)->advice); }

static void found_free(gpointer found) { spore_advice_free(found); }

static void describe_body(GString *text, const SporeAdviceElement *body, double step_us) {
  double saved_us;
  const char *change = spore_advice_change(body, &saved_us);
  g_autofree char *verdict = spore_choice_label(spore_verdict_names[body->verdict]);
  g_string_append_printf(text, "\n%s: %s (%s)", body->name, verdict, body->reason);
  if (change) g_string_append_printf(text, _("; %s: saves %.1f of %.1f µs a step"), change, saved_us, step_us);
}

static char *describe(gconstpointer data) {
  const SporeAdvice *advice = data;
  GString *text = g_string_new(NULL);
  g_string_append_printf(
      text, _("Replayed for %.3g s. Half the step, or a start a little off, moves bodies by %.2g %% of their length"),
      advice->time_s, 100 * advice->floor.floor);
  if (advice->exercise.steps > 0)
    g_string_append_printf(text, _("; of the exercise %zu of %zu steps are done, score %.1f"),
                           advice->exercise.steps_done, advice->exercise.steps, advice->exercise.score);
  for (gsize k = 0; k < advice->count; k++) describe_body(text, &advice->elements[k], advice->floor.step_us);
  return g_string_free(text, FALSE);
}

static gboolean applies(gconstpointer found, SporeDocument *document) {
  return spore_advice_count(found, document) > 0;
}

static gboolean apply_to(gconstpointer found, SporeDocument *document, GError **error) {
  return spore_advice_apply(found, document, error);
}

static const SporeFindingKind kind = {.find = N_("Physical or effect?"),
                                      .find_hint = N_("Replay the scene without the physics of each of its bodies, "
                                                      "clamps and emitters, with its recorded input: who would miss "
                                                      "what?"),
                                      .apply = N_("Apply advice"),
                                      .apply_hint =
                                          N_("Let what nobody would miss be effects, as one step that can be undone"),
                                      .job = N_("Advice"),
                                      .under_way = N_("Replaying the scene without the physics of each body …"),
                                      .cancelled = N_("Cancelled: nothing is advised"),
                                      .work_new = work_new,
                                      .work_run = spore_advice_work_run,
                                      .work_free = spore_advice_work_free,
                                      .take = take,
                                      .found_free = found_free,
                                      .describe = describe,
                                      .applies = applies,
                                      .apply_to = apply_to};

GtkWidget *spore_advice_box_new(void) { return spore_finding_new(&kind, NULL); }
