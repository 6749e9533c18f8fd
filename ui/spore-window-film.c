/* Films: of the run so far. */
#include <glib/gi18n.h>

#include "ui/jobs/film-work.h"
#include "ui/spore-window-private.h"

/* A film goes as fast as the run was played; one that was played as fast as it went, in real time. */
static double chosen_speed(SporeWindow *self) {
  g_autoptr(GVariant) state = g_action_group_get_action_state(G_ACTION_GROUP(self), "speed");
  double speed = g_ascii_strtod(g_variant_get_string(state, NULL), NULL);
  return speed > 0 ? speed : 1;
}

static void filmed(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeWindow *self = owner;
  const SporeFilmWork *work = data;
  if (spore_window_failed(self, error)) return;
  if (work)
    spore_window_log(self, _("Saved %s: %llu pictures, %.2f s"), work->file, (unsigned long long)work->filmed.pictures,
                     work->filmed.length_s);
}

static void film_run(SporeWindow *self, const char *file) {
  SporeSession *session = spore_player_get_session(self->player);
  double end_s = session ? spore_session_snapshot(session)->time_s : 0;
  if (end_s <= 0) {
    spore_window_complain(self, _("Nothing has run yet; play the scene first (F5), then film what was played"));
    return;
  }
  SporeFilmWork *work = spore_film_work_new(spore_editor_document_get(self->document), file,
                                            spore_session_recording(session), NULL, end_s, chosen_speed(self));
  spore_window_start_job(self, _("Filming"), spore_film_work_run, work, spore_film_work_free, filmed);
}

static void act_save_film(GSimpleAction *action, GVariant *parameter, gpointer data) {
  film_run(data, g_variant_get_string(parameter, NULL));
}

static void act_save_film_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) {
  g_autofree char *file =
      spore_window_choose_to_save(data, _("Save a film of this run"), ".webm", _("Films (WebM)"), "run.webm");
  if (file) film_run(data, file);
}

void spore_window_add_film_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {
      {"save-film", act_save_film, "s"},
      {"save-film-dialog", act_save_film_dialog},
  };
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
}
