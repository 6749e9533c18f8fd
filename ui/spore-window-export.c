/* Exports of the scene for other programs. */
#include <glib/gi18n.h>
#include <string.h>

#include "ui/dialogs/spore-export-dialog.h"
#include "ui/jobs/export-work.h"
#include "ui/jobs/film-work.h"
#include "ui/spore-window-private.h"

static void exported(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeWindow *self = owner;
  const SporeExportWork *work = data;
  if (error) spore_window_wrote(self, NULL, error);
  if (error || !work) return;
  spore_window_mend(self, SPORE_CAUSE_FILE);
  g_autofree char *report = spore_export_work_report(work);
  spore_window_log(self, _("Exported %s"), work->output);
  spore_export_report_show(GTK_WINDOW(self), report);
}

static void drawn(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeWindow *self = owner;
  const SporeFilmWork *work = data;
  if (error) spore_window_wrote(self, NULL, error);
  if (error || !work) return;
  spore_window_mend(self, SPORE_CAUSE_FILE);
  g_autofree char *report = spore_film_work_report(work);
  spore_window_log(self, _("Exported %s"), work->file);
  spore_export_report_show(GTK_WINDOW(self), report);
}

/* Pictures of moments that lie so far apart are shown as fast as in life. Takes the input. */
static void draw_to(SporeWindow *self, const SporeExportFormat *format, const char *file, double time_s, double every_s,
                    SporeTrack *input) {
  g_autofree char *named = spore_film_file(format, file);
  SporeFilmWork *work = spore_film_work_new(spore_editor_document_get(self->document), named, time_s, 1);
  spore_film_work_add(work, input, NULL);
  if (every_s > 0) work->fps = 1 / every_s;
  if (format->moments != SPORE_EXPORT_SERIES || time_s > 0) {
    spore_window_start_job(self, _("Exporting"), spore_film_work_run, work, spore_film_work_free, drawn);
    return;
  }
  spore_film_work_free(work);
  spore_window_complain(self, _("A film of no time shows nothing; set a simulated time of more than 0 s"));
}

static void export_to(SporeWindow *self, const SporeExportFormat *format, const char *file, double time_s,
                      double every_s, gboolean as_played) {
  SporeSession *session = as_played ? spore_player_get_session(self->player) : NULL;
  SporeTrack *input = session ? spore_session_recording(session) : NULL;
  if (!format->write) {
    draw_to(self, format, file, time_s, every_s, input);
    return;
  }
  SporeExportWork *work =
      spore_export_work_new(spore_editor_document_get(self->document), format, file, input, time_s, every_s);
  spore_window_start_job(self, _("Exporting"), spore_export_work_run, work, spore_export_work_free, exported);
}

static const SporeExportFormat *find_format(SporeWindow *self, const char *name) {
  const SporeExportFormat *const tables[] = {spore_export_formats, spore_film_formats};
  for (gsize i = 0; i < G_N_ELEMENTS(tables); i++)
    for (const SporeExportFormat *format = tables[i]; format->name; format++)
      if (g_str_equal(format->name, name)) return format;
  g_autofree char *said = g_strdup_printf(_("There is no format %s; choose one in the dialog of Export"), name);
  spore_window_complain(self, said);
  return NULL;
}

/* The scene's name with the format's suffix. */
static char *proposed_name(SporeWindow *self, const SporeExportFormat *format) {
  g_autofree char *title = spore_editor_document_get_title(self->document);
  char *point = strrchr(title, '.');
  if (point && point != title) *point = '\0';
  return g_strconcat(title, format->suffix ? format->suffix : "-player", NULL);
}

static void dialog_answered(GtkWidget *dialog, int response, SporeWindow *self) {
  const SporeExportFormat *format = spore_export_dialog_get_format(dialog);
  double time_s = spore_export_dialog_get_time_s(dialog), every_s = spore_export_dialog_get_every_s(dialog);
  gboolean as_played = spore_export_dialog_get_as_played(dialog);
  gtk_widget_destroy(dialog);
  if (response != GTK_RESPONSE_ACCEPT) return;
  g_autofree char *name = proposed_name(self, format);
  g_autofree char *file =
      spore_window_choose_to_save(self, _(format->doc), format->suffix ? format->suffix : "", _(format->label), name);
  if (file) export_to(self, format, file, time_s, every_s, as_played);
}

static void act_export(GSimpleAction *action, GVariant *parameter, gpointer data) {
  const char *name, *file;
  double time_s, every_s;
  g_variant_get(parameter, "(&s&sdd)", &name, &file, &time_s, &every_s);
  const SporeExportFormat *format = find_format(data, name);
  if (format) export_to(data, format, file, time_s, every_s, FALSE);
}

static void act_export_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  GtkWidget *dialog = spore_export_dialog_new(GTK_WINDOW(self), spore_window_played_s(self));
  g_signal_connect(dialog, "response", G_CALLBACK(dialog_answered), self);
  gtk_window_present(GTK_WINDOW(dialog));
}

void spore_window_add_export_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {
      {"export", act_export, "(ssdd)"},
      {"export-dialog", act_export_dialog},
  };
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
}
