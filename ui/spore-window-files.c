/* The window's document: replacing it and following it, opening and saving, and what is asked before it is lost. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/io/bundle.h"
#include "core/io/scene_xml.h"
#include "core/author/track_edits.h"
#include "ui/document/asset-readers.h"
#include "ui/jobs/works.h"
#include "ui/jobs/loop-gaps.h"
#include "ui/spore-window-private.h"

/* The document of the window. */

static void update_title(SporeWindow *self) {
  g_autofree char *name = spore_editor_document_get_title(self->document);
  g_autofree char *title = g_strconcat(spore_editor_document_is_modified(self->document) ? "• " : "", name, NULL);
  const char *file = spore_editor_document_get_save_file(self->document);
  g_autofree char *folder = file ? g_path_get_dirname(file) : NULL;
  gtk_header_bar_set_title(GTK_HEADER_BAR(self->header), title);
  gtk_header_bar_set_subtitle(GTK_HEADER_BAR(self->header), folder);
  gtk_window_set_title(GTK_WINDOW(self), title);
}

static void update(SporeWindow *self) {
  update_title(self);
  spore_window_update_actions(self);
  spore_window_show_hands(self);
}

static void selection_changed(SporeWindow *self) {
  spore_window_mend(self, SPORE_CAUSE_SELECTION);
  spore_window_update_actions(self);
  spore_window_show_hands(self);
}

static void history_changed(SporeWindow *self) {
  self->fresh = FALSE;
  update(self);
}

static void scene_changed(SporeWindow *self) {
  spore_window_mend(self, SPORE_CAUSE_EDIT);
  history_changed(self);
}

/* What holds the window while a scene plays is told as such. */
static void tell_playing(SporeWindow *self, gboolean playing) {
  if (playing == self->gaps_play) return;
  self->gaps_play = playing;
  if (playing) spore_gaps_enter(_("Playing"));
  else spore_gaps_leave(_("Playing"));
}

static void player_changed(SporeWindow *self) {
  spore_window_show_job(self);
  gboolean playing = spore_player_is_playing(self->player);
  tell_playing(self, playing);
  const char *icon = playing ? "media-playback-pause-symbolic" : "media-playback-start-symbolic";
  gtk_image_set_from_icon_name(GTK_IMAGE(self->play_image), icon, GTK_ICON_SIZE_BUTTON);
  gtk_image_set_from_icon_name(GTK_IMAGE(self->large_play_image), icon, GTK_ICON_SIZE_BUTTON);
  gtk_button_set_label(GTK_BUTTON(self->large_play), playing ? _("Pause") : _("Play"));
  gtk_widget_set_tooltip_text(self->play_button, playing ? _("Pause (F5)") : _("Play (F5)"));
  atk_object_set_name(gtk_widget_get_accessible(self->play_button), playing ? _("Pause") : _("Play"));
  if (spore_window_is_at_start(self)) spore_window_mend(self, SPORE_CAUSE_RUN);
  update(self);
}

/* Another world counts its messages from 0. */
static void player_replaced(SporeWindow *self) {
  self->monitored_step = self->monitor_seen = 0;
  spore_problems_clear_run(SPORE_PROBLEMS(self->problems));
}

static void player_failed(SporeWindow *self, const char *message) { spore_window_complain(self, message); }

void spore_window_release_document(SporeWindow *self) {
  if (self->job) spore_job_cancel(self->job);
  tell_playing(self, FALSE);
  if (self->document) g_signal_handlers_disconnect_by_data(self->document, self);
  if (self->player) {
    g_signal_handlers_disconnect_by_data(self->player, self);
    spore_player_close(self->player);
  }
  g_clear_object(&self->player);
  g_clear_object(&self->document);
  spore_window_set_generator(self);
}

void spore_window_set_document(SporeWindow *self, SporeDocument *document) {
  spore_window_end_pick(self);
  spore_window_release_document(self);
  self->document = spore_editor_document_new(document);
  self->player = spore_player_new(self->document);
  self->monitored_step = self->monitor_seen = 0;
  self->missing = 0;
  gtk_widget_hide(self->missing_bar);
  g_autoptr(GVariant) speed = g_action_group_get_action_state(G_ACTION_GROUP(self), "speed");
  spore_player_set_speed(self->player, g_ascii_strtod(g_variant_get_string(speed, NULL), NULL));
  g_signal_connect_object(self->document, "history-changed", G_CALLBACK(history_changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->document, "changed", G_CALLBACK(scene_changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->document, "selection-changed", G_CALLBACK(selection_changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->player, "state-changed", G_CALLBACK(player_changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->player, "progressed", G_CALLBACK(spore_window_show_job), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->player, "replaced", G_CALLBACK(player_replaced), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->player, "failed", G_CALLBACK(player_failed), self, G_CONNECT_SWAPPED);
  spore_viewport_set_document(SPORE_VIEWPORT(self->viewport), self->document, self->player);
  spore_window_set_generator(self);
  spore_outliner_set_document(SPORE_OUTLINER(self->outliner), self->document);
  spore_inspector_set_document(SPORE_INSPECTOR(self->inspector), self->document);
  spore_problems_set_document(SPORE_PROBLEMS(self->problems), self->document);
  spore_plan_set_document(SPORE_PLAN(self->plan), self->document);
  spore_accuracy_set_document(SPORE_ACCURACY(self->accuracy), self->document);
  spore_plots_set_document(SPORE_PLOTS(self->plots), self->document, self->player);
  spore_timeline_set_player(SPORE_TIMELINE(self->timeline), self->player);
  spore_exercise_panel_set_document(SPORE_EXERCISE_PANEL(self->exercise), self->document, self->player);
  spore_exercise_guide_set_document(SPORE_EXERCISE_GUIDE(self->guide), self->document, self->player);
  gtk_widget_hide(self->message_bar);
  player_changed(self);
}

/* Choosing files. pattern: one or several, with blanks between. g_free; NULL: the user went back. */

static char *choose_file(SporeWindow *self, GtkFileChooserAction action, const char *title, const char *accept,
                         const char *pattern, const char *pattern_name, const char *proposed) {
  g_autoptr(GtkFileChooserNative) native =
      gtk_file_chooser_native_new(title, GTK_WINDOW(self), action, accept, _("_Cancel"));
  GtkFileChooser *chooser = GTK_FILE_CHOOSER(native);
  GtkFileFilter *filter = gtk_file_filter_new();
  gtk_file_filter_set_name(filter, pattern_name);
  g_auto(GStrv) patterns = g_strsplit(pattern, " ", -1);
  for (char **one = patterns; *one; one++) gtk_file_filter_add_pattern(filter, *one);
  gtk_file_chooser_add_filter(chooser, filter);
  gtk_file_chooser_set_do_overwrite_confirmation(chooser, TRUE);
  const char *scene = spore_editor_document_get_save_file(self->document);
  g_autofree char *folder = scene ? g_path_get_dirname(scene) : NULL;
  if (folder) gtk_file_chooser_set_current_folder(chooser, folder);
  if (proposed) gtk_file_chooser_set_current_name(chooser, proposed);
  if (gtk_native_dialog_run(GTK_NATIVE_DIALOG(native)) != GTK_RESPONSE_ACCEPT) return NULL;
  return gtk_file_chooser_get_filename(chooser);
}

static char *with_extension(char *file, const char *extension) {
  if (!file || g_str_has_suffix(file, extension)) return file;
  char *longer = g_strconcat(file, extension, NULL);
  g_free(file);
  return longer;
}

char *spore_window_choose_to_save(SporeWindow *self, const char *title, const char *extension, const char *kind,
                                  const char *proposed) {
  g_autofree char *pattern = g_strconcat("*", extension, NULL);
  return with_extension(choose_file(self, GTK_FILE_CHOOSER_ACTION_SAVE, title, _("_Save"), pattern, kind, proposed),
                        extension);
}

char *spore_window_choose_to_open(SporeWindow *self, const char *title, const char *patterns, const char *kind) {
  return choose_file(self, GTK_FILE_CHOOSER_ACTION_OPEN, title, _("_Open"), patterns, kind, NULL);
}

/* Saving. */

static gboolean save_to(SporeWindow *self, const char *file) {
  g_autoptr(GError) error = NULL;
  if (!spore_editor_document_save(self->document, file, &error)) return spore_window_wrote(self, file, error);
  spore_recovery_keep(self->recovery, self->document, NULL);
  spore_window_keep_marks(self); /* under the names that bodies have now */
  spore_window_remember(spore_editor_document_get_save_file(self->document));
  return spore_window_wrote(self, spore_editor_document_get_save_file(self->document), NULL);
}

static gboolean save_as(SporeWindow *self) {
  g_autofree char *title = spore_editor_document_get_title(self->document);
  if (spore_bundle_is_name(title)) title[strlen(title) - 1] = '\0'; /* .spore */
  g_autofree char *proposed = with_extension(g_strdup(title), ".spore");
  g_autofree char *file = spore_window_choose_to_save(self, _("Save scene"), ".spore", _("SPORE scenes"), proposed);
  return file && save_to(self, file);
}

static gboolean save(SporeWindow *self) {
  return spore_editor_document_get_save_file(self->document) ? save_to(self, NULL) : save_as(self);
}

gboolean spore_window_may_leave(SporeWindow *self) {
  if (!spore_editor_document_is_modified(self->document)) return TRUE;
  g_autofree char *name = spore_editor_document_get_title(self->document);
  GtkWidget *dialog = gtk_message_dialog_new(GTK_WINDOW(self), GTK_DIALOG_MODAL, GTK_MESSAGE_QUESTION, GTK_BUTTONS_NONE,
                                             _("Save changes to “%s”?"), name);
  gtk_message_dialog_format_secondary_text(GTK_MESSAGE_DIALOG(dialog), "%s",
                                           _("What was changed since the last save is lost otherwise."));
  gtk_dialog_add_buttons(GTK_DIALOG(dialog), _("_Discard"), GTK_RESPONSE_REJECT, _("_Cancel"), GTK_RESPONSE_CANCEL,
                         _("_Save"), GTK_RESPONSE_ACCEPT, NULL);
  gtk_dialog_set_default_response(GTK_DIALOG(dialog), GTK_RESPONSE_ACCEPT);
  int response = gtk_dialog_run(GTK_DIALOG(dialog));
  gtk_widget_destroy(dialog);
  if (response == GTK_RESPONSE_ACCEPT) return save(self);
  return response == GTK_RESPONSE_REJECT;
}

/* Opening. */

void spore_window_offer_recovery(SporeWindow *self) {
  self->leftover = spore_leftover_find(self->unreadable);
  if (!self->leftover) return;
  g_autofree char *name =
      self->leftover->original ? g_path_get_basename(self->leftover->original) : g_strdup(_("Untitled"));
  g_autoptr(GDateTime) when = g_date_time_new_from_unix_local(self->leftover->kept_s);
  g_autofree char *date = g_date_time_format(when, "%x %H:%M");
  g_autofree char *text = g_strdup_printf(_("SPORE ended unexpectedly. Unsaved work on %s was kept (%s)."), name, date);
  gtk_label_set_text(GTK_LABEL(self->recovery_text), text);
  gtk_widget_show(self->recovery_bar);
}

/* A leftover that cannot be read stays for another program or day; it keeps no other one from being offered. */
static void recover_the_others(SporeWindow *self, const SporeOpenWork *work, const GError *error) {
  if (!g_error_matches(error, SPORE_ERROR, SPORE_ERROR_CANCELLED))
    g_ptr_array_add(self->unreadable, g_path_get_dirname(work->file));
  spore_window_offer_recovery(self);
}

static void opened(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeWindow *self = owner;
  SporeOpenWork *work = data;
  spore_viewport_set_waiting(SPORE_VIEWPORT(self->viewport), FALSE);
  if (spore_window_failed(self, error)) {
    if (work->recovered) recover_the_others(self, work, error);
    return;
  }
  SporeDocument *document = g_steal_pointer(&work->document);
  g_clear_object(&self->job); /* this job is done: replacing the document cancels a running job */
  gtk_widget_hide(self->job_box);
  spore_window_set_document(self, document);
  if (work->recovered) {
    g_autofree char *folder = g_path_get_dirname(work->file);
    spore_editor_document_set_recovered(self->document, work->original);
    spore_recovery_adopt(self->recovery, folder);
    spore_window_offer_recovery(self); /* what else was left */
  }
  if (work->untitled) spore_editor_document_set_untitled(self->document);
  else if (!work->recovered) spore_window_remember(work->file);
  self->fresh = FALSE;
  spore_window_restore_marks(self);
  spore_window_update_actions(self);
  g_signal_emit_by_name(self->document, "history-changed");
  spore_window_log(self, _("Opened %s"), work->original ? work->original : work->file);
}

static gboolean start_open(SporeWindow *self, SporeOpenWork *work) {
  g_autofree char *base = g_path_get_basename(work->original ? work->original : work->file);
  g_autofree char *title = g_strdup_printf(_("Opening %s"), base);
  if (!spore_window_start_job(self, title, spore_open_work_run, work, spore_open_work_free, opened)) return FALSE;
  spore_viewport_set_waiting(SPORE_VIEWPORT(self->viewport), TRUE);
  return TRUE;
}

void spore_window_open(SporeWindow *self, const char *file) {
  if (!spore_window_may_leave(self)) return;
  start_open(self, spore_open_work_new(self->schema, file));
}

void spore_window_open_copy(SporeWindow *self, const char *file) {
  if (!spore_window_may_leave(self)) return;
  SporeOpenWork *work = spore_open_work_new(self->schema, file);
  work->untitled = TRUE;
  start_open(self, work);
}

gboolean spore_window_recover(SporeWindow *self) {
  if (!self->leftover || !spore_window_may_leave(self)) return FALSE;
  SporeOpenWork *work = spore_open_work_new(self->schema, self->leftover->scene);
  work->original = g_strdup(self->leftover->original);
  work->recovered = TRUE;
  return start_open(self, work);
}

/* Actions. */

static void act_new(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  if (self->document && !spore_window_may_leave(self)) return;
  SporeDocument *document = spore_document_new(self->schema);
  spore_document_set_readers(document, &spore_editor_readers);
  spore_window_set_document(self, document);
}

static void act_open(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_window_open(data, g_variant_get_string(parameter, NULL));
}

static void act_open_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) {
  g_autofree char *file = spore_window_choose_to_open(data, _("Open scene"), "*.spore *.sporez", _("SPORE scenes"));
  if (file) spore_window_open(data, file);
}

/* File of the demo scene. g_free; NULL: not installed. */
static char *find_demo(SporeWindow *self) {
  static const char *const names[] = {"laparoscopy.spore", "minimal.spore"};
  for (gsize i = 0; i < G_N_ELEMENTS(names); i++) {
    char *file = g_build_filename(self->scenes, names[i], NULL);
    if (g_file_test(file, G_FILE_TEST_IS_REGULAR)) return file;
    g_free(file);
  }
  return NULL;
}

static void act_open_demo(GSimpleAction *action, GVariant *parameter, gpointer data) {
  g_autofree char *file = find_demo(data);
  if (file) spore_window_open(data, file);
  else spore_window_complain(data, _("The demo scene is not installed"));
}

static void act_save(GSimpleAction *action, GVariant *parameter, gpointer data) { save(data); }

static void act_save_as(GSimpleAction *action, GVariant *parameter, gpointer data) {
  save_to(data, g_variant_get_string(parameter, NULL));
}

static void act_save_as_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) { save_as(data); }

static void save_recording(SporeWindow *self, const char *file) {
  SporeSession *session = spore_player_get_session(self->player);
  if (!session) return;
  SporeTrack *track = spore_session_recording(session);
  size_t size;
  char *text = spore_track_format(track, &size);
  g_autoptr(GError) error = NULL;
  if (text) {
    spore_write_file(file, text, size, &error);
    spore_window_wrote(self, file, error);
  }
  spore_free(text);
  spore_input_free(track);
}

static void act_save_recording(GSimpleAction *action, GVariant *parameter, gpointer data) {
  save_recording(data, g_variant_get_string(parameter, NULL));
}

/* In the scene, so that it is repeated when the scene is played. */
static void act_keep_recording(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeSession *session = spore_player_get_session(self->player);
  if (!session) return;
  SporeTrack *track = spore_session_recording(session);
  g_autoptr(GError) error = NULL;
  SporeObject *kept = spore_edit_keep_track(spore_editor_document_get(self->document), track, &error);
  spore_input_free(track);
  if (kept) spore_editor_document_select(self->document, spore_object_id(kept));
  else spore_window_failed(self, error);
}

static void act_save_recording_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) {
  g_autofree char *file =
      spore_window_choose_to_save(data, _("Save recorded input"), ".track", _("Recorded input"), "recording.track");
  if (file) save_recording(data, file);
}

/* From time 0, in place of the scene's own input, till the run goes back to the start. */
static void act_repeat_recording(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  spore_player_repeat(self->player, g_variant_get_string(parameter, NULL));
}

static void act_repeat_recording_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autofree char *file = spore_window_choose_to_open(self, _("Repeat recorded input"), "*.track", _("Recorded input"));
  if (file) spore_player_repeat(self->player, file);
}

/* Numbers and plots. */

static void save_numbers(SporeWindow *self, const char *file) {
  g_autoptr(GError) error = NULL;
  spore_plots_save(SPORE_PLOTS(self->plots), file, &error);
  spore_window_wrote(self, file, error);
}

static void act_save_numbers(GSimpleAction *action, GVariant *parameter, gpointer data) {
  g_autofree char *file = with_extension(g_variant_dup_string(parameter, NULL), ".csv");
  save_numbers(data, file);
}

static void act_save_plot(GSimpleAction *action, GVariant *parameter, gpointer data) {
  g_autofree char *file = with_extension(g_variant_dup_string(parameter, NULL), ".svg");
  save_numbers(data, file);
}

static void act_save_numbers_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) {
  g_autofree char *file = spore_window_choose_to_save(data, _("Save numbers"), ".csv", _("Tables (CSV)"), "run.csv");
  if (file) save_numbers(data, file);
}

static void act_save_plot_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) {
  g_autofree char *file = spore_window_choose_to_save(data, _("Save plot"), ".svg", _("Pictures (SVG)"), "plot.svg");
  if (file) save_numbers(data, file);
}

/* The plan. */

static void save_plan(SporeWindow *self, const char *file) {
  g_autoptr(GError) error = NULL;
  spore_plan_save(SPORE_PLAN(self->plan), file, &error);
  spore_window_wrote(self, file, error);
}

static void act_save_plan(GSimpleAction *action, GVariant *parameter, gpointer data) {
  save_plan(data, g_variant_get_string(parameter, NULL));
}

static void act_save_plan_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) {
  g_autofree char *file = spore_window_choose_to_save(data, _("Save the plan"), ".csv", _("Tables (CSV)"), "plan.csv");
  if (file) save_plan(data, file);
}

/* The accuracy study. */

static void save_study(SporeWindow *self, const char *file) {
  g_autoptr(GError) error = NULL;
  spore_accuracy_save(SPORE_ACCURACY(self->accuracy), file, &error);
  spore_window_wrote(self, file, error);
}

static void act_save_study(GSimpleAction *action, GVariant *parameter, gpointer data) {
  save_study(data, g_variant_get_string(parameter, NULL));
}

/* A file of the kind that the suffix says. g_free; NULL: none was chosen, or there is no such kind. */
static char *choose_report(SporeWindow *self, const char *title, const char *name, const char *suffix) {
  static const char *const kinds[][2] = {{".html", N_("Pages (HTML)")},
                                         {".csv", N_("Tables (CSV)")},
                                         {".json", N_("Objects (JSON)")},
                                         {".svg", N_("Pictures (SVG)")}};
  for (gsize i = 0; i < G_N_ELEMENTS(kinds); i++) {
    if (!g_str_equal(suffix, kinds[i][0])) continue;
    g_autofree char *proposed = g_strconcat(name, suffix, NULL);
    return spore_window_choose_to_save(self, title, suffix, _(kinds[i][1]), proposed);
  }
  return NULL;
}

static void act_save_study_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) {
  const char *suffix = g_variant_get_string(parameter, NULL);
  g_autofree char *file = choose_report(data, _("Save the study"), "accuracy", suffix);
  if (file) save_study(data, file);
}

/* The exercise. */

static void save_exercise(SporeWindow *self, const char *file) {
  g_autoptr(GError) error = NULL;
  spore_exercise_panel_save(SPORE_EXERCISE_PANEL(self->exercise), file, &error);
  spore_window_wrote(self, file, error);
}

static void act_save_exercise(GSimpleAction *action, GVariant *parameter, gpointer data) {
  save_exercise(data, g_variant_get_string(parameter, NULL));
}

static void act_save_exercise_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) {
  const char *suffix = g_variant_get_string(parameter, NULL);
  g_autofree char *file = choose_report(data, _("Save the report"), "exercise", suffix);
  if (file) save_exercise(data, file);
}

static void act_close(GSimpleAction *action, GVariant *parameter, gpointer data) { gtk_window_close(data); }

void spore_window_add_file_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {
      {"new", act_new},
      {"open", act_open, "s"},
      {"open-dialog", act_open_dialog},
      {"open-demo", act_open_demo},
      {"save", act_save},
      {"save-as", act_save_as, "s"},
      {"save-as-dialog", act_save_as_dialog},
      {"save-recording", act_save_recording, "s"},
      {"keep-recording", act_keep_recording},
      {"save-recording-dialog", act_save_recording_dialog},
      {"repeat-recording", act_repeat_recording, "s"},
      {"repeat-recording-dialog", act_repeat_recording_dialog},
      {"save-numbers", act_save_numbers, "s"},
      {"save-numbers-dialog", act_save_numbers_dialog},
      {"save-plot", act_save_plot, "s"},
      {"save-plot-dialog", act_save_plot_dialog},
      {"save-plan", act_save_plan, "s"},
      {"save-plan-dialog", act_save_plan_dialog},
      {"save-study", act_save_study, "s"},
      {"save-study-dialog", act_save_study_dialog, "s"},
      {"save-exercise", act_save_exercise, "s"},
      {"save-exercise-dialog", act_save_exercise_dialog, "s"},
      {"close", act_close},
  };
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
}
