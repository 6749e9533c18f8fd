#include <glib/gi18n.h>

#include "core/scene/check.h"
#include "ui/spore-window-private.h"

#define AUTOSAVE_S 60
#define MONITOR_MS 250

G_DEFINE_FINAL_TYPE(SporeWindow, spore_window, GTK_TYPE_APPLICATION_WINDOW)

/* Telling. */

void spore_window_log(SporeWindow *self, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  g_autofree char *text = g_strdup_vprintf(format, arguments);
  va_end(arguments);
  g_autoptr(GDateTime) now = g_date_time_new_now_local();
  g_autofree char *clock = g_date_time_format(now, "%H:%M:%S");
  g_autofree char *line = g_strdup_printf("%s  %s\n", clock, text);
  GtkTextBuffer *buffer = gtk_text_view_get_buffer(GTK_TEXT_VIEW(self->log));
  GtkTextIter end;
  gtk_text_buffer_get_end_iter(buffer, &end);
  gtk_text_buffer_insert(buffer, &end, line, -1);
  /* By a mark: the line is not laid out yet. */
  gtk_text_buffer_place_cursor(buffer, &end);
  gtk_text_view_scroll_to_mark(GTK_TEXT_VIEW(self->log), gtk_text_buffer_get_insert(buffer), 0, FALSE, 0, 0);
}

void spore_window_show_tab(SporeWindow *self, GtkWidget *what) {
  g_action_group_change_action_state(G_ACTION_GROUP(self), "show-problems", g_variant_new_boolean(TRUE));
  while (gtk_widget_get_parent(what) != self->tabs) what = gtk_widget_get_parent(what);
  gtk_stack_set_visible_child(GTK_STACK(self->tabs), what);
}

void spore_window_complain(SporeWindow *self, const char *message) {
  gtk_label_set_text(GTK_LABEL(self->message), message);
  gtk_widget_show(self->message_bar);
  spore_window_log(self, "%s", message);
}

gboolean spore_window_failed(SporeWindow *self, const GError *error) {
  if (error && !g_error_matches(error, SPORE_ERROR, SPORE_ERROR_CANCELLED)) spore_window_complain(self, error->message);
  return error != NULL;
}

static void message_closed(GtkInfoBar *bar, int response, SporeWindow *self) { gtk_widget_hide(GTK_WIDGET(bar)); }

static void recovery_answered(GtkInfoBar *bar, int response, SporeWindow *self) {
  gtk_widget_hide(GTK_WIDGET(bar));
  if (response == GTK_RESPONSE_ACCEPT) spore_window_recover(self);
  else if (self->leftover) spore_leftover_remove(self->leftover);
  g_clear_pointer(&self->leftover, spore_leftover_free);
}

void spore_window_offer_recovery(SporeWindow *self) {
  self->leftover = spore_leftover_find();
  if (!self->leftover) return;
  g_autofree char *name =
      self->leftover->original ? g_path_get_basename(self->leftover->original) : g_strdup(_("Untitled"));
  g_autofree char *text = g_strdup_printf(_("SPORE ended unexpectedly. Unsaved work on %s was kept."), name);
  gtk_label_set_text(GTK_LABEL(self->recovery_text), text);
  gtk_widget_show(self->recovery_bar);
}

static void problems_checked(SporeProblems *problems, GPtrArray *diagnostics, SporeWindow *self) {
  guint count = 0;
  for (guint i = 0; i < diagnostics->len; i++)
    count += ((SporeDiagnostic *)g_ptr_array_index(diagnostics, i))->severity != SPORE_NOTE;
  g_autofree char *title = count ? g_strdup_printf(_("Problems (%u)"), count) : g_strdup(_("Problems"));
  gtk_container_child_set(GTK_CONTAINER(self->tabs), self->problems, "title", title, NULL);
  spore_outliner_set_problems(SPORE_OUTLINER(self->outliner), diagnostics);
}

/* What the simulation had to mend. */
static gboolean poll_monitor(gpointer data) {
  SporeWindow *self = data;
  SporeSession *session = spore_player_get_session(self->player);
  if (!session) return G_SOURCE_CONTINUE;
  const SporeSnapshot *snapshot = spore_session_snapshot(session);
  guint64 count = snapshot->message_count;
  if (snapshot->step < self->monitored_step) spore_problems_clear_run(SPORE_PROBLEMS(self->problems));
  self->monitored_step = snapshot->step;
  if (count - self->monitor_seen > SPORE_MONITOR_MESSAGES) self->monitor_seen = count - SPORE_MONITOR_MESSAGES;
  for (; self->monitor_seen < count; self->monitor_seen++) {
    const SporeMonitorMessage *message = &snapshot->messages[self->monitor_seen % SPORE_MONITOR_MESSAGES];
    spore_window_log(self, _("Step %llu: %s"), (unsigned long long)message->step, message->text);
    spore_problems_add_run(SPORE_PROBLEMS(self->problems), message->step, message->text);
  }
  return G_SOURCE_CONTINUE;
}

/* Jobs. */

void spore_window_show_job(SporeWindow *self) {
  SporeJob *job = self->job || !self->generator ? self->job : spore_generator_get_job(self->generator);
  gtk_widget_set_visible(self->job_box, job != NULL);
  if (!job) return;
  g_autofree char *stage = spore_job_get_stage(job);
  g_autofree char *text =
      *stage ? g_strdup_printf("%s: %s", spore_job_get_title(job), stage) : g_strdup(spore_job_get_title(job));
  gtk_label_set_text(GTK_LABEL(self->job_label), text);
  gtk_progress_bar_set_fraction(GTK_PROGRESS_BAR(self->job_bar), spore_job_get_fraction(job));
}

static void job_finished(SporeJob *job, SporeWindow *self) {
  if (self->job != job) return;
  g_clear_object(&self->job);
  spore_window_show_job(self);
  spore_window_update_actions(self);
}

gboolean spore_window_start_job(SporeWindow *self, const char *title, SporeJobWork work, gpointer data,
                                GDestroyNotify free_data, SporeJobDone done) {
  if (self->job || spore_generator_is_working(self->generator)) {
    spore_window_complain(self, _("Something else is still being worked on; wait for it or cancel it"));
    free_data(data);
    return FALSE;
  }
  spore_recovery_keep(self->recovery, self->document, NULL);
  self->job = spore_job_start(title, work, data, free_data, done, G_OBJECT(self));
  g_signal_connect_object(self->job, "progressed", G_CALLBACK(spore_window_show_job), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->job, "finished", G_CALLBACK(job_finished), self, 0);
  spore_window_show_job(self);
  spore_window_update_actions(self);
  return TRUE;
}

/* Following document and player. */

void spore_window_set_enabled(SporeWindow *self, const char *action, gboolean enabled) {
  g_simple_action_set_enabled(G_SIMPLE_ACTION(g_action_map_lookup_action(G_ACTION_MAP(self), action)), enabled);
}

static const char *hint_for(SporeWindow *self) {
  if (spore_window_picking_hint(self)) return spore_window_picking_hint(self);
  SporeDocument *document = spore_editor_document_get(self->document);
  if (spore_object_child_count(spore_document_section(document, "bodies")) == 0)
    return _("Import a mesh to begin, or open the demo");
  g_autoptr(GVariant) tool = g_action_group_get_action_state(G_ACTION_GROUP(self), "tool");
  if (spore_viewport_edits_regions(SPORE_VIEWPORT(self->viewport)))
    return _("Click puts the region there; its middle and its rim have a handle to drag; N and P choose, Insert adds");
  gboolean edits = g_str_equal(g_variant_get_string(tool, NULL), "edit");
  if (edits && !spore_viewport_has_edited(SPORE_VIEWPORT(self->viewport)))
    return _("Nothing to edit by hand here: select an organ that has spheres or a middle line");
  if (edits)
    return _("Drag moves a sphere or point, the wheel resizes it; N and P choose, Insert adds, Delete deletes");
  if (spore_player_is_playing(self->player))
    return _("Choose Probe: drag leads an instrument, the right button closes it; Ctrl+drag pulls tissue; F5 pauses");
  if (!spore_player_get_session(self->player))
    return _("Click selects, middle button turns, wheel zooms, F frames; F5 plays");
  return _("Paused: F5 goes on, F6 makes one step, Shift+F5 goes back to the start");
}

void spore_window_show_hint(SporeWindow *self) {
  const char *hint = hint_for(self);
  gtk_label_set_text(GTK_LABEL(self->hint), hint);
  gtk_widget_set_tooltip_text(self->hint, hint); /* a narrow window has no room for all of it */
}

static void update_title(SporeWindow *self) {
  g_autofree char *name = spore_editor_document_get_title(self->document);
  g_autofree char *title = g_strconcat(spore_editor_document_is_modified(self->document) ? "• " : "", name, NULL);
  const char *file = spore_editor_document_get_save_file(self->document);
  g_autofree char *folder = file ? g_path_get_dirname(file) : NULL;
  gtk_header_bar_set_title(GTK_HEADER_BAR(self->header), title);
  gtk_header_bar_set_subtitle(GTK_HEADER_BAR(self->header), folder);
  gtk_window_set_title(GTK_WINDOW(self), title);
}

void spore_window_update_actions(SporeWindow *self) {
  SporeDocument *document = spore_editor_document_get(self->document);
  SporeObject *selected = spore_editor_document_selected(self->document);
  gboolean named = selected && spore_object_name(selected),
           idle = !self->job && !spore_generator_is_working(self->generator);
  gboolean session = spore_player_get_session(self->player) != NULL;
  gboolean playing = spore_player_is_playing(self->player);
  gboolean bodies = spore_object_child_count(spore_document_section(document, "bodies")) > 0;
  spore_window_set_enabled(self, "undo", spore_document_can_undo(document));
  spore_window_set_enabled(self, "redo", spore_document_can_redo(document));
  spore_window_set_enabled(self, "save",
                           spore_editor_document_is_modified(self->document) ||
                               !spore_editor_document_get_save_file(self->document));
  spore_window_set_enabled(self, "delete", named);
  spore_window_set_enabled(self, "rename", named);
  spore_window_set_enabled(self, "rename-dialog", named);
  spore_window_update_generator(self, bodies);
  spore_window_set_enabled(self, "add-pin", bodies);
  spore_window_set_enabled(self, "import", idle);
  spore_window_set_enabled(self, "import-dialog", idle);
  spore_window_set_enabled(self, "import-dialog-with", idle);
  spore_window_set_enabled(self, "change-mesh", idle && bodies);
  spore_window_set_enabled(self, "change-mesh-dialog", idle && bodies);
  spore_window_set_enabled(self, "measure-mapping", idle && bodies);
  spore_window_set_enabled(self, "play", bodies && !playing);
  spore_window_set_enabled(self, "pause", playing);
  spore_window_set_enabled(self, "play-pause", bodies);
  spore_window_set_enabled(self, "step", bodies && !playing);
  spore_window_set_enabled(self, "reset", session);
  spore_window_set_enabled(self, "save-recording", session);
  spore_window_set_enabled(self, "save-recording-dialog", session);
}

static void update(SporeWindow *self) {
  update_title(self);
  spore_window_update_actions(self);
  spore_window_show_hint(self);
}

static void history_changed(SporeWindow *self) {
  self->fresh = FALSE;
  update(self);
}

static void player_changed(SporeWindow *self) {
  gboolean playing = spore_player_is_playing(self->player);
  gtk_image_set_from_icon_name(GTK_IMAGE(self->play_image),
                               playing ? "media-playback-pause-symbolic" : "media-playback-start-symbolic",
                               GTK_ICON_SIZE_BUTTON);
  gtk_widget_set_tooltip_text(self->play_button, playing ? _("Pause (F5)") : _("Play (F5)"));
  atk_object_set_name(gtk_widget_get_accessible(self->play_button), playing ? _("Pause") : _("Play"));
  update(self);
}

/* Another world counts its messages from 0. */
static void player_replaced(SporeWindow *self) {
  self->monitored_step = self->monitor_seen = 0;
  spore_problems_clear_run(SPORE_PROBLEMS(self->problems));
}

static void player_failed(SporeWindow *self, const char *message) { spore_window_complain(self, message); }

static void release_document(SporeWindow *self) {
  if (self->job) spore_job_cancel(self->job);
  if (self->document) g_signal_handlers_disconnect_by_data(self->document, self);
  if (self->player) g_signal_handlers_disconnect_by_data(self->player, self);
  g_clear_object(&self->player);
  g_clear_object(&self->document);
  spore_window_set_generator(self);
}

void spore_window_set_document(SporeWindow *self, SporeDocument *document) {
  release_document(self);
  self->document = spore_editor_document_new(document);
  self->player = spore_player_new(self->document);
  self->monitored_step = self->monitor_seen = 0;
  g_autoptr(GVariant) speed = g_action_group_get_action_state(G_ACTION_GROUP(self), "speed");
  spore_player_set_speed(self->player, g_ascii_strtod(g_variant_get_string(speed, NULL), NULL));
  g_signal_connect_object(self->document, "history-changed", G_CALLBACK(history_changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->document, "changed", G_CALLBACK(history_changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->document, "selection-changed", G_CALLBACK(spore_window_update_actions), self,
                          G_CONNECT_SWAPPED);
  g_signal_connect_object(self->player, "state-changed", G_CALLBACK(player_changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->player, "replaced", G_CALLBACK(player_replaced), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->player, "failed", G_CALLBACK(player_failed), self, G_CONNECT_SWAPPED);
  spore_viewport_set_document(SPORE_VIEWPORT(self->viewport), self->document, self->player);
  spore_window_set_generator(self);
  spore_outliner_set_document(SPORE_OUTLINER(self->outliner), self->document);
  spore_inspector_set_document(SPORE_INSPECTOR(self->inspector), self->document);
  spore_problems_set_document(SPORE_PROBLEMS(self->problems), self->document);
  gtk_widget_hide(self->message_bar);
  player_changed(self);
}

/* Leaving. */

static gboolean autosave(gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GError) error = NULL;
  if (!spore_recovery_keep(self->recovery, self->document, &error))
    spore_window_log(self, _("Unsaved work could not be kept: %s"), error->message);
  return G_SOURCE_CONTINUE;
}

static gboolean close_asked(GtkWidget *widget, GdkEvent *event, SporeWindow *self) {
  return spore_window_may_leave(self) ? GDK_EVENT_PROPAGATE : GDK_EVENT_STOP;
}

static void files_dropped(GtkWidget *widget, GdkDragContext *context, int x, int y, GtkSelectionData *data, guint info,
                          guint time, SporeWindow *self) {
  g_auto(GStrv) uris = gtk_selection_data_get_uris(data);
  g_autoptr(GPtrArray) files = g_ptr_array_new_with_free_func(g_free);
  for (char **uri = uris; uri && *uri; uri++) {
    char *file = g_filename_from_uri(*uri, NULL, NULL);
    if (file) g_ptr_array_add(files, file);
  }
  gtk_drag_finish(context, files->len > 0, FALSE, time);
  if (files->len == 0) return;
  g_ptr_array_add(files, NULL);
  if (g_str_has_suffix(files->pdata[0], ".spore"))
    g_action_group_activate_action(G_ACTION_GROUP(self), "open", g_variant_new_string(files->pdata[0]));
  else spore_window_show_import_dialog(self, (const char *const *)files->pdata);
}

static void spore_window_dispose(GObject *object) {
  SporeWindow *self = SPORE_WINDOW(object);
  g_clear_handle_id(&self->autosave, g_source_remove);
  g_clear_handle_id(&self->monitor, g_source_remove);
  release_document(self);
  g_clear_object(&self->job);
  g_clear_pointer(&self->recovery, spore_recovery_free);
  g_clear_pointer(&self->leftover, spore_leftover_free);
  G_OBJECT_CLASS(spore_window_parent_class)->dispose(object);
}

static void bind_children(GtkWidgetClass *widget) {
  gtk_widget_class_bind_template_child(widget, SporeWindow, header);
  gtk_widget_class_bind_template_child(widget, SporeWindow, play_button);
  gtk_widget_class_bind_template_child(widget, SporeWindow, play_image);
  gtk_widget_class_bind_template_child(widget, SporeWindow, speed_button);
  gtk_widget_class_bind_template_child(widget, SporeWindow, message_bar);
  gtk_widget_class_bind_template_child(widget, SporeWindow, message);
  gtk_widget_class_bind_template_child(widget, SporeWindow, recovery_bar);
  gtk_widget_class_bind_template_child(widget, SporeWindow, recovery_text);
  gtk_widget_class_bind_template_child(widget, SporeWindow, outliner);
  gtk_widget_class_bind_template_child(widget, SporeWindow, viewport);
  gtk_widget_class_bind_template_child(widget, SporeWindow, inspector);
  gtk_widget_class_bind_template_child(widget, SporeWindow, problems);
  gtk_widget_class_bind_template_child(widget, SporeWindow, generator_panel);
  gtk_widget_class_bind_template_child(widget, SporeWindow, bottom);
  gtk_widget_class_bind_template_child(widget, SporeWindow, tabs);
  gtk_widget_class_bind_template_child(widget, SporeWindow, log);
  gtk_widget_class_bind_template_child(widget, SporeWindow, hint);
  gtk_widget_class_bind_template_child(widget, SporeWindow, job_box);
  gtk_widget_class_bind_template_child(widget, SporeWindow, job_label);
  gtk_widget_class_bind_template_child(widget, SporeWindow, job_bar);
  gtk_widget_class_bind_template_child(widget, SporeWindow, renderer);
  gtk_widget_class_bind_template_child(widget, SporeWindow, mesh_operations);
}

static void spore_window_class_init(SporeWindowClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_window_dispose;
  g_type_ensure(SPORE_TYPE_OUTLINER);
  g_type_ensure(SPORE_TYPE_VIEWPORT);
  g_type_ensure(SPORE_TYPE_INSPECTOR);
  g_type_ensure(SPORE_TYPE_PROBLEMS);
  g_type_ensure(SPORE_TYPE_GENERATOR_PANEL);
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-window.ui");
  bind_children(widget);
  gtk_widget_class_bind_template_callback(widget, close_asked);
  gtk_widget_class_bind_template_callback(widget, files_dropped);
  gtk_widget_class_bind_template_callback(widget, message_closed);
  gtk_widget_class_bind_template_callback(widget, recovery_answered);
  gtk_widget_class_bind_template_callback(widget, problems_checked);
}

static void spore_window_init(SporeWindow *self) {
  self->fresh = TRUE;
  self->recovery = spore_recovery_new();
  gtk_widget_init_template(GTK_WIDGET(self));
  spore_window_add_file_actions(self);
  spore_window_add_mesh_actions(self);
  spore_window_add_scene_actions(self);
  spore_window_add_generator_actions(self);
  gtk_drag_dest_set(GTK_WIDGET(self), GTK_DEST_DEFAULT_ALL, NULL, 0, GDK_ACTION_COPY);
  gtk_drag_dest_add_uri_targets(GTK_WIDGET(self));
  self->autosave = g_timeout_add_seconds(AUTOSAVE_S, autosave, self);
  self->monitor = g_timeout_add(MONITOR_MS, poll_monitor, self);
}

gboolean spore_window_is_fresh(SporeWindow *self) { return self->fresh && !self->job; }

static gboolean name_renderer(gpointer data) {
  SporeWindow *self = data;
  gtk_label_set_text(GTK_LABEL(self->renderer), spore_viewport_get_renderer(SPORE_VIEWPORT(self->viewport)));
  gtk_widget_set_tooltip_text(self->renderer, gtk_label_get_text(GTK_LABEL(self->renderer)));
  return G_SOURCE_REMOVE;
}

SporeWindow *spore_window_new(SporeApplication *application) {
  SporeWindow *self = g_object_new(SPORE_TYPE_WINDOW, "application", application, NULL);
  g_action_group_activate_action(G_ACTION_GROUP(self), "new", NULL);
  self->fresh = TRUE;
  /* After the first frame, which makes the context. */
  g_idle_add_full(G_PRIORITY_LOW, name_renderer, g_object_ref(self), g_object_unref);
  return self;
}
