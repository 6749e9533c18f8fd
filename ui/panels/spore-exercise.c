/* The exercise of the scene, as it is authored and as it is played. */
#include "ui/panels/spore-exercise.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/author/exercise_edits.h"
#include "core/author/exercise_report.h"
#include "core/exercise/event.h"
#include "core/io/scene_xml.h"
#include "ui/document/attempts.h"
#include "ui/jobs/track-work.h"
#include "ui/panels/attempt-list.h"
#include "ui/panels/exercise-look.h"
#include "ui/panels/exercise-rows.h"
#include "ui/panels/report.h"
#include "ui/panels/spore-property-row.h"

#define REFRESH_MS 100

struct _SporeExercisePanel {
  GtkBox parent;
  GtkWidget *state, *told, *play, *content, *columns, *steps, *metrics, *heads, *settings, *attempt_list, *add_step,
      *add_metric;
  GtkSizeGroup *widths[SPORE_METRIC_COLUMNS];
  SporeEditorDocument *document;
  SporePlayer *player;
  guint timer, rebuild;
  GArray *attempts;   /* of SporeAttempt, at this scene */
  gboolean selecting; /* the selection of the document is being shown */
};

G_DEFINE_FINAL_TYPE(SporeExercisePanel, spore_exercise_panel, GTK_TYPE_BOX)

static const SporeObject *section_of(SporeExercisePanel *self) {
  return spore_document_section(spore_editor_document_get(self->document), "exercise");
}

static SporeSession *session_of(SporeExercisePanel *self) {
  return self->player ? spore_player_get_session(self->player) : NULL;
}

/* Where there is no run. */
static const char *idle_text(SporeExercisePanel *self) {
  return spore_object_child_count(section_of(self)) == 0
             ? _("No exercise yet: add a step, then click on the body that it is done to")
             : _("Begin plays the scene; the clock and the figures begin with it");
}

static void set_text(GtkWidget *label, const char *text) {
  gtk_label_set_text(GTK_LABEL(label), text);
  gtk_widget_set_tooltip_text(label, text); /* a narrow panel has no room for all of it */
}

/* look: NULL: there is no run. */
static void show_state(SporeExercisePanel *self, const SporeExerciseLook *look) {
  g_autofree char *text = look ? spore_exercise_look_text(look, section_of(self)) : g_strdup(idle_text(self));
  set_text(self->state, text);
  set_text(self->told, spore_exercise_look_told(look, section_of(self)));
  gtk_widget_set_visible(self->told, *gtk_label_get_text(GTK_LABEL(self->told)) != '\0');
}

static void show_run(SporeExercisePanel *self) {
  SporeSession *session = session_of(self);
  g_auto(SporeExerciseLook) look = {0};
  gboolean runs = spore_exercise_look_take(session, &look);
  show_state(self, runs ? &look : NULL);
  SporeDocument *document = spore_editor_document_get(self->document);
  g_autoptr(GList) steps = gtk_container_get_children(GTK_CONTAINER(self->steps));
  g_autoptr(GList) metrics = gtk_container_get_children(GTK_CONTAINER(self->metrics));
  for (GList *row = steps; row; row = row->next) {
    const SporeObject *step = spore_document_by_id(document, spore_exercise_row_id(row->data));
    spore_step_row_show(row->data, runs && step ? spore_exercise_look_step(&look, spore_object_name(step)) : NULL);
  }
  for (GList *row = metrics; row; row = row->next) {
    const SporeObject *metric = spore_document_by_id(document, spore_exercise_row_id(row->data));
    spore_metric_row_show(row->data,
                          runs && metric ? spore_exercise_look_metric(&look, spore_object_name(metric)) : NULL);
  }
}

static void show_attempts(SporeExercisePanel *self) {
  const char *scene = spore_editor_document_get_save_file(self->document);
  spore_fill_attempt_list(GTK_BOX(self->attempt_list), scene, self->attempts);
}

static void kept_track(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeExercisePanel *self = owner;
  if (error) spore_report(GTK_WIDGET(self), error);
  else if (self->document) show_attempts(self);
}

/* The run that the attempt ended in is still there, unless the user went back to the start at once. */
static void keep_track(SporeExercisePanel *self, SporeSession *session, const char *scene,
                       const SporeAttempt *attempt) {
  g_auto(SporeExerciseLook) look = {0};
  if (!spore_exercise_look_take(session, &look) || look.state.time_s != attempt->time_s) return;
  SporeTrackWork *work = spore_track_work_new(scene, attempt, spore_session_recording(session));
  g_autoptr(SporeJob) job = spore_job_start(_("Keeping the attempt"), spore_track_work_run, work, spore_track_work_free,
                                            kept_track, G_OBJECT(self));
}

/* Keeps an attempt that has ended, whether the panel is seen or not. */
static void keep_attempt(SporeExercisePanel *self) {
  SporeSession *session = session_of(self);
  SporeExerciseState state;
  g_autoptr(GError) error = NULL;
  if (!session || !spore_session_take_attempt(session, &state)) return;
  SporeAttempt attempt = spore_attempt_of(&state);
  const char *file = spore_editor_document_get_save_file(self->document);
  g_array_append_val(self->attempts, attempt);
  show_attempts(self);
  if (!file) return;
  if (spore_attempts_add(file, &attempt, &error)) keep_track(self, session, file, &attempt);
  else spore_report(GTK_WIDGET(self), error);
}

static gboolean tick(gpointer data) {
  SporeExercisePanel *self = data;
  if (self->document) keep_attempt(self);
  if (self->document && gtk_widget_get_mapped(GTK_WIDGET(self))) show_run(self);
  return G_SOURCE_CONTINUE;
}

static void player_changed(SporeExercisePanel *self) {
  gtk_button_set_label(GTK_BUTTON(self->play), spore_player_is_playing(self->player) ? _("Pause") : _("Begin"));
}

/* The document. */

static GtkWidget *find_row(GtkWidget *list, guint32 id) {
  g_autoptr(GList) rows = gtk_container_get_children(GTK_CONTAINER(list));
  for (GList *row = rows; row; row = row->next)
    if (spore_exercise_row_id(row->data) == id) return row->data;
  return NULL;
}

static GtkWidget *new_row(SporeExercisePanel *self, const SporeObject *part) {
  return spore_step_is(part) ? spore_step_row_new(part) : spore_metric_row_new(part, self->widths);
}

/* Puts the part's row at that place: the row that is there already, since something may be typed in it, or a new one.
 */
static void put_row(SporeExercisePanel *self, GtkWidget *list, const SporeObject *part, int place) {
  GtkWidget *row = find_row(list, spore_object_id(part));
  if (row && gtk_list_box_row_get_index(GTK_LIST_BOX_ROW(row)) == place) return;
  if (row) {
    g_object_ref(row);
    gtk_container_remove(GTK_CONTAINER(list), row);
    gtk_list_box_insert(GTK_LIST_BOX(list), row, place);
    g_object_unref(row);
  } else {
    gtk_list_box_insert(GTK_LIST_BOX(list), new_row(self, part), place);
  }
}

/* The list gets a row for each part of that sort, in their order. */
static void build_list(SporeExercisePanel *self, GtkWidget *list, gboolean (*sort)(const SporeObject *)) {
  const SporeObject *section = section_of(self);
  SporeDocument *document = spore_editor_document_get(self->document);
  g_autoptr(GList) rows = gtk_container_get_children(GTK_CONTAINER(list));
  for (GList *row = rows; row; row = row->next)
    if (!sort(spore_document_by_id(document, spore_exercise_row_id(row->data)))) gtk_widget_destroy(row->data);
  int place = 0;
  for (guint i = 0; i < spore_object_child_count(section); i++)
    if (sort(spore_object_child(section, i))) put_row(self, list, spore_object_child(section, i), place++);
}

static void remove_rows(GtkWidget *list) {
  gtk_container_foreach(GTK_CONTAINER(list), (GtkCallback)(void (*)(void))gtk_widget_destroy, NULL);
}

static void build(SporeExercisePanel *self) {
  build_list(self, self->steps, spore_step_is);
  build_list(self, self->metrics, spore_metric_is);
  gtk_widget_set_visible(self->heads, spore_object_child_count(section_of(self)) > 0);
}

static void refresh(SporeExercisePanel *self) {
  SporeDocument *document = spore_editor_document_get(self->document);
  g_autoptr(GList) steps = gtk_container_get_children(GTK_CONTAINER(self->steps));
  g_autoptr(GList) metrics = gtk_container_get_children(GTK_CONTAINER(self->metrics));
  g_autoptr(GList) settings = gtk_container_get_children(GTK_CONTAINER(self->settings));
  guint number = 1;
  for (GList *row = steps; row; row = row->next)
    spore_step_row_refresh(row->data, spore_document_by_id(document, spore_exercise_row_id(row->data)), number++);
  for (GList *row = metrics; row; row = row->next)
    spore_metric_row_refresh(row->data, spore_document_by_id(document, spore_exercise_row_id(row->data)));
  for (GList *row = settings; row; row = row->next) spore_property_row_refresh(SPORE_PROPERTY_ROW(row->data));
}

/* Selects the row of that object; 0 or an object that has no row: none. */
static void select_row(GtkWidget *list, guint32 id) {
  GtkWidget *row = find_row(list, id);
  gtk_list_box_select_row(GTK_LIST_BOX(list), row ? GTK_LIST_BOX_ROW(row) : NULL);
}

static void selection_changed(SporeExercisePanel *self) {
  guint32 id = spore_editor_document_get_selection(self->document);
  self->selecting = TRUE;
  select_row(self->steps, id);
  select_row(self->metrics, id);
  self->selecting = FALSE;
}

static void row_selected(GtkListBox *list, GtkListBoxRow *row, SporeExercisePanel *self) {
  if (row && !self->selecting) spore_editor_document_select(self->document, spore_exercise_row_id(GTK_WIDGET(row)));
}

static gboolean build_again(gpointer data) {
  SporeExercisePanel *self = data;
  self->rebuild = 0;
  build(self);
  refresh(self);
  selection_changed(self);
  show_run(self);
  return G_SOURCE_REMOVE;
}

/* Before the next picture, once for all that one edit changes. */
static void queue(SporeExercisePanel *self) {
  if (!self->rebuild) self->rebuild = g_idle_add_full(G_PRIORITY_HIGH_IDLE, build_again, self, NULL);
}

static void build_settings(SporeExercisePanel *self) {
  const SporeObjectType *type = spore_object_type(section_of(self));
  remove_rows(self->settings);
  for (guint i = 0; i < type->table->count; i++)
    gtk_container_add(GTK_CONTAINER(self->settings), spore_property_row_new(self->document, "exercise", type, i));
  gtk_widget_show(self->settings);
}

static void release_document(SporeExercisePanel *self) {
  g_clear_handle_id(&self->rebuild, g_source_remove);
  if (self->player) g_signal_handlers_disconnect_by_data(self->player, self);
  if (self->document) g_signal_handlers_disconnect_by_data(self->document, self);
  g_clear_object(&self->player);
  g_clear_object(&self->document);
}

void spore_exercise_panel_set_document(SporeExercisePanel *self, SporeEditorDocument *document, SporePlayer *player) {
  release_document(self);
  self->document = g_object_ref(document);
  self->player = g_object_ref(player);
  g_signal_connect_object(document, "changed", G_CALLBACK(queue), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(document, "selection-changed", G_CALLBACK(selection_changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(player, "state-changed", G_CALLBACK(player_changed), self, G_CONNECT_SWAPPED);
  g_clear_pointer(&self->attempts, g_array_unref);
  self->attempts = spore_attempts_read(spore_editor_document_get_save_file(document));
  show_attempts(self);
  remove_rows(self->steps); /* ids are of a document */
  remove_rows(self->metrics);
  build_settings(self);
  build_again(self);
}

/* What the user asks for. */

void spore_exercise_panel_skip(SporeExercisePanel *self, const SporeObject *step) {
  SporeSession *session = session_of(self);
  g_auto(SporeExerciseLook) look = {0};
  if (!step || !spore_exercise_look_take(session, &look)) return;
  const SporeStepState *found = spore_exercise_look_step(&look, spore_object_name(step));
  if (found) spore_session_skip_to(session, (gsize)(found - look.steps));
  show_run(self);
}

/* A report that is being written. */
typedef struct Report {
  const char *title, *file;
  char *text;
} Report;

static void write_report(const SporeExercise *exercise, gpointer data) {
  Report *report = data;
  g_autoptr(GPtrArray) none = g_ptr_array_new();
  const SporeReportPictures pictures = {none, _("the editor takes none; spore run draws them from the recorded input")};
  report->text = spore_exercise_report(exercise, report->title, report->file, &pictures);
}

gboolean spore_exercise_panel_save(SporeExercisePanel *self, const char *file, GError **error) {
  SporeSession *session = session_of(self);
  g_autofree char *title = spore_editor_document_get_title(self->document);
  Report report = {.title = title, .file = file};
  if (!spore_exercise_report_names(file, error)) return FALSE;
  if (!session || !spore_session_read_exercise(session, write_report, &report))
    return spore_error_raise(
        error, SPORE_ERROR_INPUT, file,
        _("no exercise was played; expected a run of a scene with steps or metrics; play it first"));
  gboolean saved = spore_write_file(file, report.text, strlen(report.text), error);
  g_free(report.text);
  return saved;
}

/* Life. */

static void fill_menu(GtkWidget *button, const char *action, const char *label, const char *element) {
  GMenu *menu = G_MENU(gtk_menu_button_get_menu_model(GTK_MENU_BUTTON(button)));
  g_autoptr(GMenuItem) item = g_menu_item_new(_(label), NULL);
  g_menu_item_set_action_and_target(item, action, "s", element);
  g_menu_append_item(menu, item);
}

GMenuModel *spore_exercise_panel_get_step_menu(SporeExercisePanel *self) {
  return gtk_menu_button_get_menu_model(GTK_MENU_BUTTON(self->add_step));
}

GMenuModel *spore_exercise_panel_get_metric_menu(SporeExercisePanel *self) {
  return gtk_menu_button_get_menu_model(GTK_MENU_BUTTON(self->add_metric));
}

static void fill_menus(SporeExercisePanel *self) {
  for (const SporeEventKind *const *kind = spore_event_kinds; *kind; kind++)
    fill_menu(self->add_step, "win.add-step", (*kind)->label, (*kind)->element);
  for (const SporeMetricKind *const *kind = spore_metric_kinds; *kind; kind++)
    fill_menu(self->add_metric, "win.add-metric", (*kind)->label, (*kind)->element);
}

static gboolean fit_columns(gpointer data) {
  g_autoptr(SporeExercisePanel) self = data;
  if (self->columns) spore_box_fit(GTK_BOX(self->columns), gtk_widget_get_allocated_width(self->content));
  return G_SOURCE_REMOVE;
}

static void content_sized(GtkWidget *widget, GdkRectangle *allocation, SporeExercisePanel *self) {
  g_idle_add(fit_columns, g_object_ref(self)); /* not during size allocation */
}

static void spore_exercise_panel_dispose(GObject *object) {
  SporeExercisePanel *self = SPORE_EXERCISE_PANEL(object);
  g_clear_handle_id(&self->timer, g_source_remove);
  release_document(self);
  g_clear_pointer(&self->attempts, g_array_unref);
  for (guint i = 0; i < SPORE_METRIC_COLUMNS; i++) g_clear_object(&self->widths[i]);
  G_OBJECT_CLASS(spore_exercise_panel_parent_class)->dispose(object);
}

static void spore_exercise_panel_class_init(SporeExercisePanelClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_exercise_panel_dispose;
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-exercise.ui");
  gtk_widget_class_bind_template_child(widget, SporeExercisePanel, state);
  gtk_widget_class_bind_template_child(widget, SporeExercisePanel, told);
  gtk_widget_class_bind_template_child(widget, SporeExercisePanel, play);
  gtk_widget_class_bind_template_child(widget, SporeExercisePanel, content);
  gtk_widget_class_bind_template_child(widget, SporeExercisePanel, columns);
  gtk_widget_class_bind_template_child(widget, SporeExercisePanel, steps);
  gtk_widget_class_bind_template_child(widget, SporeExercisePanel, metrics);
  gtk_widget_class_bind_template_child(widget, SporeExercisePanel, heads);
  gtk_widget_class_bind_template_child(widget, SporeExercisePanel, settings);
  gtk_widget_class_bind_template_child(widget, SporeExercisePanel, attempt_list);
  gtk_widget_class_bind_template_child(widget, SporeExercisePanel, add_step);
  gtk_widget_class_bind_template_child(widget, SporeExercisePanel, add_metric);
  gtk_widget_class_bind_template_callback(widget, row_selected);
  gtk_widget_class_bind_template_callback(widget, content_sized);
}

static void spore_exercise_panel_init(SporeExercisePanel *self) {
  gtk_widget_init_template(GTK_WIDGET(self));
  for (guint i = 0; i < SPORE_METRIC_COLUMNS; i++) self->widths[i] = gtk_size_group_new(GTK_SIZE_GROUP_HORIZONTAL);
  gtk_container_add(GTK_CONTAINER(self->heads), spore_metric_heads_new(self->widths));
  fill_menus(self);
  self->timer = g_timeout_add(REFRESH_MS, tick, self);
}
