/* Keeping what the run shows as the scene's beginning. */
#include <glib/gi18n.h>

#include "core/author/pose_edits.h"
#include "ui/spore-window-private.h"

static void tell_kept(SporeWindow *self, const GPtrArray *left_out) {
  g_autofree char *text = left_out->len == 0
                              ? g_strdup(_("The scene begins so from now on, at rest."))
                              : g_strdup_printf(_("The scene begins so from now on, at rest; not all of it: %s"),
                                                (const char *)left_out->pdata[0]);
  for (guint i = 0; i < left_out->len; i++) spore_window_log(self, "%s", (const char *)left_out->pdata[i]);
  spore_window_complain_while(self, SPORE_CAUSE_EDIT, text, _("Undo"), "win.undo");
}

static void kept(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeWindow *self = owner;
  g_autoptr(GError) failure = NULL;
  if (spore_window_failed(self, error) || !self->document) return;
  if (spore_pose_work_apply(data, spore_editor_document_get(self->document), &failure))
    tell_kept(self, spore_pose_work_left_out(data));
  else spore_window_failed(self, failure);
}

/* A run that plays is paused: what is kept is what is seen then. Its files are written apart from the window. */
static void act_keep_pose(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeSession *session = spore_player_get_session(self->player);
  if (!session) return;
  spore_player_pause(self->player);
  if (!spore_session_stands(session)) {
    spore_window_complain(self, _("a step is still under way; wait until it has ended"));
    return;
  }
  g_autoptr(GError) error = NULL;
  SporePoseWork *work =
      spore_pose_work_new(spore_editor_document_get(self->document), spore_session_simulation(session), &error);
  if (work) spore_window_start_job(self, _("Keeping the pose"), spore_pose_work_run, work, spore_pose_work_free, kept);
  else spore_window_failed(self, error);
}

static void act_forget_pose(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GError) error = NULL;
  if (!spore_edit_forget_pose(spore_editor_document_get(self->document), &error)) spore_window_failed(self, error);
}

void spore_window_add_pose_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {{"keep-pose", act_keep_pose}, {"forget-pose", act_forget_pose}};
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
}
