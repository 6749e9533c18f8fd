/* Pictures of the view, and films: of the run so far, of an attempt at the exercise, of two attempts side by side. */
#include <glib/gi18n.h>

#include "ui/document/attempts.h"
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
  if (error) spore_window_wrote(self, NULL, error);
  if (error || !work) return;
  spore_window_mend(self, SPORE_CAUSE_FILE);
  spore_window_log(self, _("Saved %s: %llu pictures, %.2f s"), work->file, (unsigned long long)work->filmed.pictures,
                   work->filmed.length_s);
}

static void film(SporeWindow *self, SporeFilmWork *work) {
  spore_window_start_job(self, _("Filming"), spore_film_work_run, work, spore_film_work_free, filmed);
}

static void film_run(SporeWindow *self, const char *file) {
  double end_s = spore_window_played_s(self);
  if (end_s <= 0) {
    spore_window_complain(self, _("Nothing has run yet; play the scene first (F5), then film what was played"));
    return;
  }
  SporeDocument *document = spore_editor_document_get(self->document);
  SporeFilmWork *work = spore_film_work_new(document, file, end_s, chosen_speed(self));
  spore_film_work_add(work, spore_session_recording(spore_player_get_session(self->player)), NULL);
  film(self, work);
}

static const SporeAttempt *find_attempt(const GArray *attempts, gint64 when) {
  for (guint i = 0; i < attempts->len; i++)
    if (g_array_index(attempts, SporeAttempt, i).when == when) return &g_array_index(attempts, SporeAttempt, i);
  return NULL;
}

/* whens: of gint64, when each attempt ended. */
static void film_attempts(SporeWindow *self, const char *file, GVariant *whens) {
  const char *scene = spore_editor_document_get_save_file(self->document);
  g_autoptr(GArray) attempts = spore_attempts_read(scene);
  SporeFilmWork *work = spore_film_work_new(spore_editor_document_get(self->document), file, 0, chosen_speed(self));
  gsize count = MIN(g_variant_n_children(whens), SPORE_FILMING_MOST);
  for (gsize i = 0; i < count; i++) {
    gint64 when;
    g_variant_get_child(whens, i, "x", &when);
    const SporeAttempt *attempt = find_attempt(attempts, when);
    if (!attempt) break;
    spore_film_work_add(work, NULL, spore_attempts_track_file(scene, attempt));
    work->end_s = MAX(work->end_s, attempt->time_s); /* the exercise's clock began with the run */
  }
  if (count > 0 && work->count == count) {
    film(self, work);
    return;
  }
  spore_film_work_free(work);
  spore_window_complain(self, _("The scene has no such attempt; tick one in the list of attempts, or two"));
}

static void act_save_film(GSimpleAction *action, GVariant *parameter, gpointer data) {
  film_run(data, g_variant_get_string(parameter, NULL));
}

static void act_save_film_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) {
  g_autofree char *file =
      spore_window_choose_to_save(data, _("Save a film of this run"), ".webm", _("Films (WebM)"), "run.webm");
  if (file) film_run(data, file);
}

static void act_film_attempts(GSimpleAction *action, GVariant *parameter, gpointer data) {
  const char *file;
  g_autoptr(GVariant) whens = NULL;
  g_variant_get(parameter, "(&s@ax)", &file, &whens);
  film_attempts(data, file, whens);
}

static void act_film_attempts_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) {
  const char *title = g_variant_n_children(parameter) > 1 ? _("Save a film of two attempts side by side")
                                                          : _("Save a film of the attempt");
  g_autofree char *file = spore_window_choose_to_save(data, title, ".webm", _("Films (WebM)"), "attempt.webm");
  if (file) film_attempts(data, file, parameter);
}

static void save_picture(SporeWindow *self, const char *file) {
  g_autoptr(GError) error = NULL;
  spore_viewport_save_picture(SPORE_VIEWPORT(self->viewport), file, &error);
  spore_window_wrote(self, file, error);
}

static void act_save_picture(GSimpleAction *action, GVariant *parameter, gpointer data) {
  save_picture(data, g_variant_get_string(parameter, NULL));
}

static void act_save_picture_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) {
  g_autofree char *file =
      spore_window_choose_to_save(data, _("Save a picture of the view"), ".png", _("Pictures (PNG)"), "view.png");
  if (file) save_picture(data, file);
}

void spore_window_add_film_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {
      {"save-picture", act_save_picture, "s"},
      {"save-picture-dialog", act_save_picture_dialog},
      {"save-film", act_save_film, "s"},
      {"save-film-dialog", act_save_film_dialog},
      {"film-attempts", act_film_attempts, "(sax)"},
      {"film-attempts-dialog", act_film_attempts_dialog, "ax"},
  };
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
}
