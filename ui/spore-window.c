/* The window itself: its template, its messages to the user, autosaving, what is dropped on it, and its end. */
#include <glib/gi18n.h>

#include "core/author/edits.h"
#include "core/io/scene_xml.h"
#include "core/scene/check.h"
#include "ui/jobs/loop-gaps.h"
#include "ui/spore-preferences.h"
#include "ui/spore-window-private.h"

#define MONITOR_MS 250

G_DEFINE_FINAL_TYPE(SporeWindow, spore_window, GTK_TYPE_APPLICATION_WINDOW)

/* Escape closes a message, where what has the focus has no use for it. */
static gboolean key_left(GtkWidget *window, GdkEventKey *event, SporeWindow *self) {
  return event->keyval == GDK_KEY_Escape && spore_window_close_message(self);
}

static void message_shown(SporeWindow *self) {
  if (self->player) spore_window_update_actions(self); /* else the document is being put into the window */
}

static void follow_messages(SporeWindow *self) {
  GtkWidget *const bars[] = {self->message_bar, self->missing_bar, self->hold_bar};
  for (guint i = 0; i < G_N_ELEMENTS(bars); i++)
    g_signal_connect_object(bars[i], "notify::visible", G_CALLBACK(message_shown), self, G_CONNECT_SWAPPED);
  g_signal_connect_after(self, "key-press-event", G_CALLBACK(key_left), self);
}

static void message_closed(GtkInfoBar *bar, int response, SporeWindow *self) { gtk_widget_hide(GTK_WIDGET(bar)); }

static void recovery_answered(GtkInfoBar *bar, int response, SporeWindow *self) {
  gtk_widget_hide(GTK_WIDGET(bar));
  if (response == GTK_RESPONSE_ACCEPT && !spore_window_recover(self)) {
    gtk_widget_show(GTK_WIDGET(bar)); /* something else goes on: it is still to be had */
    return;
  }
  if (response != GTK_RESPONSE_ACCEPT && self->leftover) spore_leftover_remove(self->leftover);
  g_clear_pointer(&self->leftover, spore_leftover_free);
  if (response != GTK_RESPONSE_ACCEPT) spore_window_offer_recovery(self); /* else once that one is open */
}

/* Bodies that fall. */

static SporeObject *loose_body(SporeWindow *self, guint index) {
  return spore_document_by_id(spore_editor_document_get(self->document), g_array_index(self->loose, guint, index));
}

/* Offers to hold what would fall out of sight. An offer that was closed comes back when something else would fall. */
static void offer_to_hold(SporeWindow *self, const GPtrArray *diagnostics) {
  guint before = self->loose->len;
  g_array_set_size(self->loose, 0);
  for (guint i = 0; i < diagnostics->len; i++) {
    const SporeDiagnostic *diagnostic = diagnostics->pdata[i];
    if (diagnostic->fix == SPORE_FIX_HOLD) g_array_append_val(self->loose, diagnostic->object);
  }
  guint count = self->loose->len;
  const SporeObject *only = count == 1 ? loose_body(self, 0) : NULL;
  g_autofree char *text =
      only ? g_strdup_printf(_("Nothing holds “%s”: when it plays, it falls"), spore_object_name(only))
           : g_strdup_printf(ngettext("Nothing holds %u body: when it plays, it falls",
                                      "Nothing holds %u bodies: when it plays, they fall", count),
                             count);
  gtk_label_set_text(GTK_LABEL(self->hold_text), text);
  gtk_button_set_label(GTK_BUTTON(self->hold_button), ngettext("Hold it", "Hold them", count));
  if (count == 0) gtk_widget_hide(self->hold_bar);
  else if (count > before) gtk_widget_show(self->hold_bar);
}

static gboolean hold_all(SporeWindow *self, SporeDocument *document, GError **error) {
  for (guint i = 0; i < self->loose->len; i++) {
    SporeObject *body = loose_body(self, i);
    if (body && !spore_edit_add_pin(document, body, error)) return FALSE;
  }
  return TRUE;
}

static void hold_answered(GtkInfoBar *bar, int response, SporeWindow *self) {
  SporeDocument *document = spore_editor_document_get(self->document);
  g_autoptr(GError) error = NULL;
  gtk_widget_hide(self->hold_bar);
  if (response != GTK_RESPONSE_ACCEPT) return;
  spore_document_begin(document, _("Hold"));
  if (!spore_edit_finish(document, hold_all(self, document, &error))) spore_window_failed(self, error);
}

static void missing_answered(GtkInfoBar *bar, int response, SporeWindow *self) {
  if (response == GTK_RESPONSE_ACCEPT) spore_window_ask_to_locate(self);
  else gtk_widget_hide(GTK_WIDGET(bar));
}

static void problems_checked(SporeProblems *problems, GPtrArray *diagnostics, SporeWindow *self) {
  guint count = 0;
  for (guint i = 0; i < diagnostics->len; i++)
    count += ((SporeDiagnostic *)g_ptr_array_index(diagnostics, i))->severity != SPORE_NOTE;
  g_autofree char *title = count ? g_strdup_printf(_("Problems (%u)"), count) : g_strdup(_("Problems"));
  gtk_container_child_set(GTK_CONTAINER(self->tabs), self->problems, "title", title, NULL);
  spore_outliner_set_problems(SPORE_OUTLINER(self->outliner), diagnostics);
  offer_to_hold(self, diagnostics);
  spore_window_offer_to_locate(self, diagnostics);
  spore_window_offer_fix(self);
}

/* What held the window for long, once for each thing that was going on, and again when that got much longer. */
static void log_gaps(SporeWindow *self) {
  guint count;
  const SporeGap *gaps = spore_gaps_told(&count);
  g_array_set_size(self->gaps_logged_ms, MAX(count, self->gaps_logged_ms->len));
  for (guint i = 0; i < count; i++) {
    double *logged_ms = &g_array_index(self->gaps_logged_ms, double, i);
    if (gaps[i].longest_ms < 2 * *logged_ms) continue;
    *logged_ms = gaps[i].longest_ms;
    spore_window_log(self, _("The window stood still for %.0f ms (%s)"), gaps[i].longest_ms, gaps[i].what);
  }
}

/* What the simulation had to mend, and what held the window. */
static gboolean poll_monitor(gpointer data) {
  SporeWindow *self = data;
  log_gaps(self);
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

/* Leaving. */

static gboolean autosave(gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GError) error = NULL;
  if (!spore_recovery_keep(self->recovery, self->document, &error))
    spore_window_log(self, _("Unsaved work could not be kept: %s"), error->message);
  return G_SOURCE_CONTINUE;
}

/* What the user chose for all scenes holds at once. */
static void follow_preferences(SporeWindow *self) {
  GtkApplication *application = gtk_window_get_application(GTK_WINDOW(self));
  if (!application) return; /* the window is going */
  g_autofree char *turning = spore_preferences_state(application, "turning");
  g_autofree char *wheel = spore_preferences_state(application, "wheel");
  g_autofree char *pictures = spore_preferences_state(application, "pictures");
  g_autofree char *keeping = spore_preferences_state(application, "keeping");
  const SporeViewportHabits habits = {.middle_turns_alone = g_str_equal(turning, "middle"),
                                      .wheel_goes_away = g_str_equal(wheel, "farther"),
                                      .pictures = g_str_equal(pictures, "fine")    ? SPORE_PICTURES_FINE
                                                  : g_str_equal(pictures, "plain") ? SPORE_PICTURES_PLAIN
                                                                                   : SPORE_PICTURES_AUTOMATIC};
  spore_viewport_set_habits(SPORE_VIEWPORT(self->viewport), &habits);
  g_clear_handle_id(&self->autosave, g_source_remove);
  self->autosave = g_timeout_add_seconds((guint)g_ascii_strtoull(keeping, NULL, 10), autosave, self);
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
  if (spore_scene_is_name(files->pdata[0]))
    g_action_group_activate_action(G_ACTION_GROUP(self), "open", g_variant_new_string(files->pdata[0]));
  else spore_window_show_import_dialog(self, (const char *const *)files->pdata);
}

static void spore_window_dispose(GObject *object) {
  SporeWindow *self = SPORE_WINDOW(object);
  g_clear_handle_id(&self->autosave, g_source_remove);
  g_clear_handle_id(&self->monitor, g_source_remove);
  if (self->document) spore_window_release_document(self); /* once: the children are gone the second time */
  g_clear_object(&self->job);
  g_clear_pointer(&self->recovery, spore_recovery_free);
  g_clear_pointer(&self->leftover, spore_leftover_free);
  g_clear_pointer(&self->unreadable, g_ptr_array_unref);
  g_clear_pointer(&self->scenes, g_free);
  g_clear_pointer(&self->loose, g_array_unref);
  g_clear_pointer(&self->deleted, g_array_unref);
  g_clear_pointer(&self->gaps_logged_ms, g_array_unref);
  g_clear_object(&self->hands);
  G_OBJECT_CLASS(spore_window_parent_class)->dispose(object);
}

static void bind_children(GtkWidgetClass *widget) {
  gtk_widget_class_bind_template_child(widget, SporeWindow, header);
  gtk_widget_class_bind_template_child(widget, SporeWindow, play_button);
  gtk_widget_class_bind_template_child(widget, SporeWindow, play_image);
  gtk_widget_class_bind_template_child(widget, SporeWindow, speed_button);
  gtk_widget_class_bind_template_child(widget, SporeWindow, menu_button);
  gtk_widget_class_bind_template_child(widget, SporeWindow, messages);
  gtk_widget_class_bind_template_child(widget, SporeWindow, message_bar);
  gtk_widget_class_bind_template_child(widget, SporeWindow, message);
  gtk_widget_class_bind_template_child(widget, SporeWindow, message_remedy);
  gtk_widget_class_bind_template_child(widget, SporeWindow, recovery_bar);
  gtk_widget_class_bind_template_child(widget, SporeWindow, hold_bar);
  gtk_widget_class_bind_template_child(widget, SporeWindow, hold_text);
  gtk_widget_class_bind_template_child(widget, SporeWindow, hold_button);
  gtk_widget_class_bind_template_child(widget, SporeWindow, missing_bar);
  gtk_widget_class_bind_template_child(widget, SporeWindow, missing_text);
  gtk_widget_class_bind_template_child(widget, SporeWindow, recovery_text);
  gtk_widget_class_bind_template_child(widget, SporeWindow, outliner);
  gtk_widget_class_bind_template_child(widget, SporeWindow, viewport);
  gtk_widget_class_bind_template_child(widget, SporeWindow, inspector);
  gtk_widget_class_bind_template_child(widget, SporeWindow, plan);
  gtk_widget_class_bind_template_child(widget, SporeWindow, accuracy);
  gtk_widget_class_bind_template_child(widget, SporeWindow, problems);
  gtk_widget_class_bind_template_child(widget, SporeWindow, plots);
  gtk_widget_class_bind_template_child(widget, SporeWindow, timeline);
  gtk_widget_class_bind_template_child(widget, SporeWindow, exercise);
  gtk_widget_class_bind_template_child(widget, SporeWindow, guide);
  gtk_widget_class_bind_template_child(widget, SporeWindow, controls);
  gtk_widget_class_bind_template_child(widget, SporeWindow, large_play);
  gtk_widget_class_bind_template_child(widget, SporeWindow, large_play_image);
  gtk_widget_class_bind_template_child(widget, SporeWindow, generator_panel);
  gtk_widget_class_bind_template_child(widget, SporeWindow, middle);
  gtk_widget_class_bind_template_child(widget, SporeWindow, bottom);
  gtk_widget_class_bind_template_child(widget, SporeWindow, tab_row);
  gtk_widget_class_bind_template_child(widget, SporeWindow, tab_switcher);
  gtk_widget_class_bind_template_child(widget, SporeWindow, tabs);
  gtk_widget_class_bind_template_child(widget, SporeWindow, log);
  gtk_widget_class_bind_template_child(widget, SporeWindow, hint);
  gtk_widget_class_bind_template_child(widget, SporeWindow, job_box);
  gtk_widget_class_bind_template_child(widget, SporeWindow, job_label);
  gtk_widget_class_bind_template_child(widget, SporeWindow, job_bar);
  gtk_widget_class_bind_template_child(widget, SporeWindow, mesh_operations);
  gtk_widget_class_bind_template_child(widget, SporeWindow, menu);
  gtk_widget_class_bind_template_child(widget, SporeWindow, speeds);
  gtk_widget_class_bind_template_child(widget, SporeWindow, all_tabs);
  gtk_widget_class_bind_template_child(widget, SporeWindow, templates);
  gtk_widget_class_bind_template_child(widget, SporeWindow, recent);
  gtk_widget_class_bind_template_child(widget, SporeWindow, link_kinds);
  gtk_widget_class_bind_template_child(widget, SporeWindow, instrument_kinds);
  gtk_widget_class_bind_template_child(widget, SporeWindow, fluid_kinds);
}

static void spore_window_class_init(SporeWindowClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_window_dispose;
  g_type_ensure(SPORE_TYPE_OUTLINER);
  g_type_ensure(SPORE_TYPE_VIEWPORT);
  g_type_ensure(SPORE_TYPE_INSPECTOR);
  g_type_ensure(SPORE_TYPE_PLAN);
  g_type_ensure(SPORE_TYPE_ACCURACY);
  g_type_ensure(SPORE_TYPE_PROBLEMS);
  g_type_ensure(SPORE_TYPE_PLOTS);
  g_type_ensure(SPORE_TYPE_TIMELINE);
  g_type_ensure(SPORE_TYPE_EXERCISE_PANEL);
  g_type_ensure(SPORE_TYPE_EXERCISE_GUIDE);
  g_type_ensure(SPORE_TYPE_GENERATOR_PANEL);
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-window.ui");
  bind_children(widget);
  gtk_widget_class_bind_template_callback(widget, close_asked);
  gtk_widget_class_bind_template_callback(widget, files_dropped);
  gtk_widget_class_bind_template_callback(widget, message_closed);
  gtk_widget_class_bind_template_callback(widget, recovery_answered);
  gtk_widget_class_bind_template_callback(widget, hold_answered);
  gtk_widget_class_bind_template_callback(widget, missing_answered);
  gtk_widget_class_bind_template_callback(widget, problems_checked);
}

static void spore_window_init(SporeWindow *self) {
  self->deleted = g_array_new(FALSE, FALSE, sizeof(guint32));
  self->loose = g_array_new(FALSE, FALSE, sizeof(guint));
  self->gaps_logged_ms = g_array_new(FALSE, TRUE, sizeof(double));
  self->fresh = TRUE;
  self->recovery = spore_recovery_new();
  self->unreadable = g_ptr_array_new_with_free_func(g_free);
  gtk_widget_init_template(GTK_WIDGET(self));
  spore_viewport_set_messages(SPORE_VIEWPORT(self->viewport), self->messages);
  spore_viewport_set_controls(SPORE_VIEWPORT(self->viewport), self->controls);
  spore_window_add_tab_actions(self);
  spore_window_add_search_action(self);
  spore_window_add_file_actions(self);
  spore_window_add_template_actions(self);
  spore_window_add_film_actions(self);
  spore_window_add_export_actions(self);
  spore_window_add_mesh_actions(self);
  spore_window_add_locate_actions(self);
  spore_window_add_scene_actions(self);
  spore_window_add_body_actions(self);
  spore_window_add_pick_actions(self);
  spore_window_add_link_actions(self);
  spore_window_add_instrument_actions(self);
  spore_window_add_fluid_actions(self);
  spore_window_add_placement_actions(self);
  spore_window_add_pose_actions(self);
  spore_window_add_fix_actions(self);
  spore_window_add_exercise_actions(self);
  spore_window_add_generator_actions(self);
  spore_window_follow_recent(self);
  follow_messages(self);
  gtk_drag_dest_set(GTK_WIDGET(self), GTK_DEST_DEFAULT_ALL, NULL, 0, GDK_ACTION_COPY);
  gtk_drag_dest_add_uri_targets(GTK_WIDGET(self));
  self->monitor = g_timeout_add(MONITOR_MS, poll_monitor, self);
}

gboolean spore_window_is_fresh(SporeWindow *self) { return self->fresh && !self->job; }

const char *spore_window_get_renderer(SporeWindow *self) {
  return spore_viewport_get_renderer(SPORE_VIEWPORT(self->viewport));
}

SporeWindow *spore_window_new(GtkApplication *application, const SporeSchema *schema, const char *scenes) {
  SporeWindow *self = g_object_new(SPORE_TYPE_WINDOW, "application", application, NULL);
  g_signal_connect_object(application, "action-state-changed", G_CALLBACK(follow_preferences), self, G_CONNECT_SWAPPED);
  follow_preferences(self);
  self->schema = schema;
  self->scenes = g_strdup(scenes);
  spore_window_fill_template_menu(self);
  spore_window_fill_link_menu(self);
  spore_window_fill_instrument_menu(self);
  spore_window_fill_fluid_menu(self);
  g_action_group_activate_action(G_ACTION_GROUP(self), "new", NULL);
  self->fresh = TRUE;
  return self;
}
