/* Rows of the exercise's lists. */
#include "ui/panels/exercise-rows.h"

#include <glib/gi18n.h>
#include <math.h>

#include "ui/panels/report.h"

/* What a row is made of; widgets are borrowed from it. */
typedef struct Row {
  guint32 id;
  char *path;                       /* of a metric */
  GtkWidget *mark, *text, *time;    /* of a step */
  GtkWidget *name, *figure, *grade; /* of a metric */
  GtkWidget *good, *pass;
} Row;

static void free_row(gpointer data) {
  Row *row = data;
  g_free(row->path);
  g_free(row);
}

static Row *row_of(GtkWidget *widget) { return g_object_get_data(G_OBJECT(widget), "row"); }

guint32 spore_exercise_row_id(GtkWidget *row) { return row_of(row)->id; }

static GtkWidget *new_label(int width_chars) {
  GtkWidget *label = gtk_label_new("");
  gtk_label_set_xalign(GTK_LABEL(label), 0);
  gtk_label_set_ellipsize(GTK_LABEL(label), PANGO_ELLIPSIZE_END);
  gtk_label_set_width_chars(GTK_LABEL(label), width_chars);
  return label;
}

static void set_class(GtkWidget *widget, const char *class, gboolean on) {
  GtkStyleContext *style = gtk_widget_get_style_context(widget);
  (on ? gtk_style_context_add_class : gtk_style_context_remove_class)(style, class);
}

static GtkWidget *new_row(const SporeObject *object, GtkWidget **box) {
  GtkWidget *widget = gtk_list_box_row_new();
  Row *row = g_new0(Row, 1);
  row->id = spore_object_id(object);
  row->path = spore_object_path(object);
  g_object_set_data_full(G_OBJECT(widget), "row", row, free_row);
  *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6);
  gtk_container_add(GTK_CONTAINER(widget), *box);
  return widget;
}

/* Steps. */

GtkWidget *spore_step_row_new(const SporeObject *step) {
  GtkWidget *box, *widget = new_row(step, &box);
  Row *row = row_of(widget);
  row->mark = new_label(2);
  row->text = new_label(12);
  row->time = new_label(7);
  gtk_widget_set_hexpand(row->text, TRUE);
  gtk_label_set_xalign(GTK_LABEL(row->time), 1);
  gtk_container_add(GTK_CONTAINER(box), row->mark);
  gtk_container_add(GTK_CONTAINER(box), row->text);
  gtk_container_add(GTK_CONTAINER(box), row->time);
  gtk_widget_show_all(widget);
  return widget;
}

/* ", grasper" for a property that is set; "" else. */
static void add_set(GString *text, const SporeObject *object, const char *property, const char *format) {
  gboolean known = spore_parameter_find(spore_object_type(object)->table, property) >= 0;
  const char *value = known ? spore_object_text(object, property) : NULL;
  if (value && *value) g_string_append_printf(text, format, value);
}

void spore_step_row_refresh(GtkWidget *widget, const SporeObject *step, guint number) {
  Row *row = row_of(widget);
  g_autoptr(GString) text = g_string_new(NULL);
  g_string_append_printf(text, "%u. %s", number, _(spore_object_type(step)->label));
  add_set(text, step, "body", _(": %s"));
  add_set(text, step, "container", " → %s");
  add_set(text, step, "tool", _(", by %s"));
  add_set(text, step, "after", _(", after %s"));
  gtk_label_set_text(GTK_LABEL(row->text), text->str);
  g_string_append_printf(text, "\n%s", spore_object_name(step));
  add_set(text, step, "hint", "\n%s");
  gtk_widget_set_tooltip_text(widget, text->str);
}

void spore_step_row_show(GtkWidget *widget, const SporeStepState *state) {
  static const char *const marks[SPORE_STEP_PHASES] = {"·", "▸", "✓"};
  Row *row = row_of(widget);
  gboolean done = state && state->phase == SPORE_STEP_DONE;
  g_autofree char *time = done ? g_strdup_printf(_("%.2f s"), state->done_s) : g_strdup("");
  gtk_label_set_text(GTK_LABEL(row->mark), state ? marks[state->phase] : "");
  gtk_label_set_text(GTK_LABEL(row->time), time);
  set_class(row->mark, "tag-live", done);
  set_class(row->text, "open-step", state && state->phase == SPORE_STEP_OPEN);
}

/* Metrics. */

static void commit(GtkWidget *entry, Row *row) {
  const char *property = gtk_widget_get_name(entry), *shown = g_object_get_data(G_OBJECT(entry), "shown");
  const char *text = gtk_entry_get_text(GTK_ENTRY(entry));
  if (g_strcmp0(text, shown ? shown : "") != 0)
    spore_activate(entry, "set-threshold", g_variant_new("(sss)", row->path, property, text));
}

static gboolean commit_on_leave(GtkWidget *entry, GdkEvent *event, Row *row) {
  commit(entry, row);
  return GDK_EVENT_PROPAGATE;
}

static GtkWidget *new_threshold(const SporeObject *metric, const char *property, const char *name, Row *row) {
  const SporeObjectType *type = spore_object_type(metric);
  const SporeMetricKind *kind = spore_metric_kind_find(type->element);
  GtkWidget *entry = gtk_entry_new();
  gtk_widget_set_name(entry, property);
  gtk_entry_set_width_chars(GTK_ENTRY(entry), 5);
  gtk_entry_set_placeholder_text(GTK_ENTRY(entry), kind->units[0].name);
  gtk_widget_set_tooltip_text(entry, _(type->table->parameters[spore_parameter_find(type->table, property)].doc));
  g_autofree char *label = g_strdup_printf("%s: %s", name, spore_object_name(metric));
  atk_object_set_name(gtk_widget_get_accessible(entry), label);
  g_signal_connect(entry, "activate", G_CALLBACK(commit), row);
  g_signal_connect(entry, "focus-out-event", G_CALLBACK(commit_on_leave), row);
  return entry;
}

static void put_cell(GtkWidget *box, GtkSizeGroup *const columns[], SporeMetricColumn column, GtkWidget *cell) {
  gtk_size_group_add_widget(columns[column], cell);
  gtk_container_add(GTK_CONTAINER(box), cell);
}

GtkWidget *spore_metric_row_new(const SporeObject *metric, GtkSizeGroup *const columns[SPORE_METRIC_COLUMNS]) {
  GtkWidget *box, *widget = new_row(metric, &box);
  Row *row = row_of(widget);
  row->name = new_label(8);
  row->figure = new_label(8);
  row->good = new_threshold(metric, "good", _("Good"), row);
  row->pass = new_threshold(metric, "pass", _("Pass"), row);
  row->grade = new_label(4);
  gtk_widget_set_hexpand(row->name, TRUE);
  put_cell(box, columns, SPORE_METRIC_NAME, row->name);
  put_cell(box, columns, SPORE_METRIC_FIGURE, row->figure);
  put_cell(box, columns, SPORE_METRIC_GOOD_FROM, row->good);
  put_cell(box, columns, SPORE_METRIC_PASS_FROM, row->pass);
  put_cell(box, columns, SPORE_METRIC_MARK, row->grade);
  gtk_widget_show_all(widget);
  return widget;
}

GtkWidget *spore_metric_heads_new(GtkSizeGroup *const columns[SPORE_METRIC_COLUMNS]) {
  const char *const titles[SPORE_METRIC_COLUMNS] = {_("Metric"), _("Figure"), _("Good"), _("Pass"), _("Mark")};
  GtkWidget *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6);
  for (guint column = 0; column < SPORE_METRIC_COLUMNS; column++) {
    GtkWidget *label = new_label(0);
    gtk_label_set_text(GTK_LABEL(label), titles[column]);
    set_class(label, "dim-label", TRUE);
    gtk_widget_set_hexpand(label, column == SPORE_METRIC_NAME);
    put_cell(box, columns, column, label);
  }
  gtk_widget_show_all(box);
  return box;
}

/* What is being typed stays until the document says something else. */
static void refresh_threshold(GtkWidget *entry, const SporeObject *metric, const char *property) {
  const char *text = spore_object_text(metric, property);
  if (g_strcmp0(text, g_object_get_data(G_OBJECT(entry), "shown")) == 0) return;
  g_object_set_data_full(G_OBJECT(entry), "shown", g_strdup(text), g_free);
  gtk_entry_set_text(GTK_ENTRY(entry), text ? text : "");
}

void spore_metric_row_refresh(GtkWidget *widget, const SporeObject *metric) {
  Row *row = row_of(widget);
  const SporeObjectType *type = spore_object_type(metric);
  g_autoptr(GString) text = g_string_new(_(type->label));
  add_set(text, metric, "body", _(": %s"));
  add_set(text, metric, "tool", _(": %s"));
  add_set(text, metric, "camera", ", %s");
  gtk_label_set_text(GTK_LABEL(row->name), text->str);
  g_string_append_printf(text, "\n%s\n%s", spore_object_name(metric), _(type->doc));
  gtk_widget_set_tooltip_text(row->name, text->str);
  g_free(row->path);
  row->path = spore_object_path(metric);
  refresh_threshold(row->good, metric, "good");
  refresh_threshold(row->pass, metric, "pass");
}

void spore_metric_row_show(GtkWidget *widget, const SporeMetricState *state) {
  Row *row = row_of(widget);
  gboolean known = state && isfinite(state->value), judged = state && state->verdict != SPORE_METRIC_NONE;
  g_autofree char *figure = known ? g_strdup_printf("%.4g %s", state->value, state->unit) : g_strdup(state ? "–" : "");
  gboolean unfinished = judged && state->verdict == SPORE_METRIC_UNFINISHED;
  g_autofree char *grade = unfinished ? g_strdup("…") : judged ? g_strdup_printf("%.2f", state->mark) : g_strdup("");
  gtk_label_set_text(GTK_LABEL(row->figure), g_strchomp(figure));
  gtk_label_set_text(GTK_LABEL(row->grade), grade);
  gtk_widget_set_tooltip_text(row->grade, unfinished ? _("Not finished: judged when all steps are done.") : NULL);
  set_class(row->grade, "tag-live", judged && state->verdict == SPORE_METRIC_GOOD);
  set_class(row->grade, "tag-restart", judged && state->verdict == SPORE_METRIC_PASS);
  set_class(row->grade, "complaint", judged && state->verdict == SPORE_METRIC_FAIL);
}
