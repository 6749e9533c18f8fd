/* One-click fixes of what the checks find. */
#include <glib/gi18n.h>

#include "core/author/fix.h"
#include "ui/spore-window-private.h"

static void run_through(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeWindow *self = owner;
  g_autoptr(GError) failure = NULL;
  if (spore_window_failed(self, error) || !self->document) return;
  if (!spore_fix_work_apply(data, spore_editor_document_get(self->document), &failure))
    spore_window_failed(self, failure);
}

/* What generates something is a job. */
static void fix(SporeWindow *self, const SporeDiagnostic *problem) {
  SporeDocument *document = spore_editor_document_get(self->document);
  g_autoptr(GError) error = NULL;
  SporeFixWork *work = spore_fix_work_new(document, problem, &error);
  if (work && spore_fix_work_is_long(work)) {
    spore_window_start_job(self, _("Generating"), spore_fix_work_run, work, spore_fix_work_free, run_through);
    return;
  }
  if (!work || !spore_fix_work_apply(work, document, &error)) spore_window_failed(self, error);
  g_clear_pointer(&work, spore_fix_work_free);
}

static void fix_or_locate(SporeWindow *self, const SporeDiagnostic *problem) {
  if (problem->fix == SPORE_FIX_LOCATE) spore_window_ask_to_locate(self);
  else fix(self, problem);
}

/* What the message tells of. */
static void act_fix_said(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  const SporeDiagnostic *problem = spore_window_said_problem(self);
  gtk_widget_hide(self->message_bar);
  if (problem) fix_or_locate(self, problem);
}

static void act_fix(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  const SporeDiagnostic *problem = spore_problems_selected(SPORE_PROBLEMS(self->problems));
  if (!problem) spore_window_complain(self, _("select a problem first, in the Problems tab"));
  else fix_or_locate(self, problem);
}

void spore_window_add_fix_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {{"fix", act_fix}, {"fix-said", act_fix_said}};
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
}
