/* The plots of a run: which columns go together, what is drawn of them, points to watch, and files. */
#include "ui/panels/spore-plots.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/io/scene_xml.h"
#include "core/scene/watch_place.h"
#include "ui/document/labels.h"
#include "ui/panels/report.h"
#include "ui/panels/spore-line-plot.h"

#define REFRESH_MS 100
/* Of a quantity's name. */
#define CHOICE_LEAST_CHARS 8
#define CHOICE_CHARS 30
#define MOST_LINES SPORE_PLOT_COLOURS /* more cannot be told apart */

/* Columns of a quantity that share a unit: one plot. */
typedef struct {
  char *id, *label; /* "contacts.depth"; "Contacts: depth [mm]" */
  guint quantity;
  const char *unit;
  GArray *columns; /* of gsize */
} Group;

struct _SporePlots {
  GtkBox parent;
  GtkWidget *choice, *point, *plot;
  SporeEditorDocument *document;
  SporePlayer *player;
  guint timer;
  GPtrArray *groups; /* of Group */
  GPtrArray *points; /* texts: BODY@X,Y,Z */
  char *chosen;      /* id of the group */
  gboolean filling;
  gboolean asked; /* for a point, which waits for the simulation */

  /* What is drawn. */
  SporePlotPanel panel;
  SporePlotLine lines[MOST_LINES];
  char *y_label;
  double *values[MOST_LINES], *time_s;
  GPtrArray *labels;
};

G_DEFINE_FINAL_TYPE(SporePlots, spore_plots, GTK_TYPE_BOX)

static SporeSession *session_of(SporePlots *self) {
  return self->player ? spore_player_get_session(self->player) : NULL;
}

/* Groups. */

static void free_group(gpointer data) {
  Group *group = data;
  g_free(group->id);
  g_free(group->label);
  g_array_unref(group->columns);
  g_free(group);
}

/* Name of a column without the quantity: "hinge.x". */
static const char *rest_of(const SporeColumn *column) {
  const char *name = column->name + strlen(spore_quantities[column->quantity].name);
  return *name == '.' ? name + 1 : name;
}

/* "x" of "hinge.x"; the whole of what has no parts. */
static const char *part_of(const SporeColumn *column) {
  const char *rest = rest_of(column), *dot = strrchr(rest, '.');
  gboolean parts = spore_quantities[column->quantity].part_count > 1;
  return parts && dot ? dot + 1 : rest;
}

/* Whether all columns are of one link, body or point, whose name need not be said with each. */
static gboolean is_of_one(const Group *group, const SporeColumn *columns) {
  const gsize *list = (const gsize *)(gconstpointer)group->columns->data;
  for (guint i = 1; i < group->columns->len; i++)
    if (columns[list[i]].item != columns[list[0]].item) return FALSE;
  return TRUE;
}

static Group *find_group(SporePlots *self, const char *id) {
  for (guint i = 0; id && i < self->groups->len; i++) {
    Group *group = g_ptr_array_index(self->groups, i);
    if (g_str_equal(group->id, id)) return group;
  }
  return NULL;
}

/* The group of a column, made where it is the first one. */
static Group *group_of(SporePlots *self, const SporeColumn *column) {
  const char *quantity = spore_quantities[column->quantity].name;
  for (guint i = 0; i < self->groups->len; i++) {
    Group *group = g_ptr_array_index(self->groups, i);
    if (group->quantity == column->quantity && g_str_equal(group->unit, column->unit)) return group;
  }
  Group *group = g_new0(Group, 1);
  group->quantity = (guint)column->quantity;
  group->unit = column->unit;
  group->columns = g_array_new(FALSE, FALSE, sizeof(gsize));
  group->id = find_group(self, quantity) ? g_strdup_printf("%s.%s", quantity, part_of(column)) : g_strdup(quantity);
  g_ptr_array_add(self->groups, group);
  return group;
}

/* "Energy [J]"; of a group of one part, that too: "Contacts: depth [mm]". */
static void name_group(Group *group, const SporeColumn *columns) {
  const SporeQuantity *quantity = &spore_quantities[group->quantity];
  gsize parts = 0, first = g_array_index(group->columns, gsize, 0);
  for (gsize i = 0; i < quantity->part_count; i++) parts += g_str_equal(quantity->parts[i].unit, group->unit);
  g_autofree char *name = spore_label_of_name(quantity->name);
  const char *rest = rest_of(&columns[first]), *part = part_of(&columns[first]);
  GString *label = g_string_new(_(name));
  if (part > rest && is_of_one(group, columns)) g_string_append_printf(label, " %.*s", (int)(part - rest - 1), rest);
  if (parts == 1 && quantity->part_count > 1) g_string_append_printf(label, ": %s", part);
  g_autofree char *unit = spore_unit_label(group->unit);
  if (*unit) g_string_append_printf(label, " [%s]", unit);
  group->label = g_string_free(label, FALSE);
}

/* The groups of the session's columns, into the list of choices. What was chosen stays. */
static void fill_groups(SporePlots *self) {
  gsize count = 0;
  SporeSession *session = session_of(self);
  const SporeColumn *columns = session ? spore_session_columns(session, &count) : NULL;
  g_ptr_array_set_size(self->groups, 0);
  for (gsize c = 1; c < count; c++) g_array_append_val(group_of(self, &columns[c])->columns, c);
  self->filling = TRUE;
  gtk_combo_box_text_remove_all(GTK_COMBO_BOX_TEXT(self->choice));
  for (guint i = 0; i < self->groups->len; i++) {
    Group *group = g_ptr_array_index(self->groups, i);
    name_group(group, columns);
    gtk_combo_box_text_append(GTK_COMBO_BOX_TEXT(self->choice), group->id, group->label);
  }
  const char *id = find_group(self, self->chosen) ? self->chosen : "energy";
  gtk_combo_box_set_active_id(GTK_COMBO_BOX(self->choice), id);
  self->filling = FALSE;
}

/* Drawing. */

static void clear_lines(SporePlots *self) {
  for (guint l = 0; l < MOST_LINES; l++) g_clear_pointer(&self->values[l], g_free);
  g_clear_pointer(&self->time_s, g_free);
  g_ptr_array_set_size(self->labels, 0);
  self->panel.line_count = 0;
}

/* Mean size of the values that are known. */
static double size_of(const double *values, gsize count) {
  double sum = 0, known = 0;
  for (gsize i = 0; i < count; i++) {
    if (!isfinite(values[i])) continue;
    sum += fabs(values[i]);
    known++;
  }
  return known > 0 ? sum / known : -1;
}

/* Takes the column's values in place of the smallest of those so far, where there is no room and these are larger. */
static void take_values(SporePlots *self, double *values, gsize rows, gsize column, gsize *columns, double *sizes) {
  gsize smallest = 0, count = self->panel.line_count;
  double size = size_of(values, rows);
  for (gsize l = 1; l < count; l++)
    if (sizes[l] < sizes[smallest]) smallest = l;
  if (count == MOST_LINES && size <= sizes[smallest]) {
    g_free(values);
    return;
  }
  if (count == MOST_LINES) { /* those behind it move up, so that the order stays */
    g_free(self->values[smallest]);
    for (gsize l = smallest; l + 1 < count; l++) {
      self->values[l] = self->values[l + 1];
      columns[l] = columns[l + 1];
      sizes[l] = sizes[l + 1];
    }
    count--;
  }
  self->values[count] = values;
  columns[count] = column;
  sizes[count] = size;
  self->panel.line_count = count + 1;
}

/* Copies what is drawn: of many columns the largest. */
static gsize copy_values(SporePlots *self, SporeSession *session, const Group *group, gsize *columns) {
  gsize rows, least;
  double sizes[MOST_LINES];
  self->time_s = spore_session_numbers(session, 0, 1, &least);
  for (guint i = 0; i < group->columns->len; i++) {
    gsize column = g_array_index(group->columns, gsize, i);
    double *values = spore_session_numbers(session, column, 1, &rows);
    for (gsize r = 0; r < rows; r++) values[r] *= spore_unit_scale(group->unit); /* tables keep metres */
    least = MIN(least, rows); /* the run may have gone on, or begun anew, in between */
    take_values(self, values, rows, column, columns, sizes);
  }
  return least;
}

static void make_panel(SporePlots *self, SporeSession *session, const Group *group) {
  gsize count, shown[MOST_LINES];
  const SporeColumn *columns = spore_session_columns(session, &count);
  gboolean one = is_of_one(group, columns);
  clear_lines(self);
  gsize rows = copy_values(self, session, group, shown);
  for (gsize l = 0; l < self->panel.line_count; l++) {
    const SporeColumn *column = &columns[shown[l]];
    g_ptr_array_add(self->labels, g_strdup(one ? part_of(column) : rest_of(column)));
    self->lines[l] = (SporePlotLine){
        .label = g_ptr_array_index(self->labels, l), .count = rows, .x = self->time_s, .y = self->values[l]};
  }
  g_free(self->y_label);
  self->y_label = group->columns->len > MOST_LINES
                      ? g_strdup_printf(_("%s, the %d largest of %u"), group->label, MOST_LINES, group->columns->len)
                      : g_strdup(group->label);
  self->panel.x_label = _("time [s]");
  self->panel.y_label = self->y_label;
  self->panel.lines = self->lines;
}

static void refresh(SporePlots *self) {
  SporeSession *session = session_of(self);
  const Group *group = session ? find_group(self, gtk_combo_box_get_active_id(GTK_COMBO_BOX(self->choice))) : NULL;
  if (group) make_panel(self, session, group);
  else clear_lines(self);
  spore_line_plot_set_panel(SPORE_LINE_PLOT(self->plot), group ? &self->panel : NULL,
                            _("Play the scene to see its energy, contacts, forces and times"));
}

static gboolean tick(gpointer data) {
  SporePlots *self = data;
  if (gtk_widget_get_mapped(GTK_WIDGET(self))) refresh(self);
  return G_SOURCE_CONTINUE;
}

static void choose(SporePlots *self, const char *id) {
  g_free(self->chosen);
  self->chosen = g_strdup(id);
}

static void choice_changed(GtkComboBox *choice, SporePlots *self) {
  if (self->filling) return;
  choose(self, gtk_combo_box_get_active_id(choice));
  refresh(self);
}

/* Without a simulation the choice is made as soon as one is prepared. */
gboolean spore_plots_show(SporePlots *self, const char *quantity) {
  if (session_of(self)) return gtk_combo_box_set_active_id(GTK_COMBO_BOX(self->choice), quantity);
  choose(self, quantity);
  if (self->player) spore_player_prepare(self->player);
  return TRUE;
}

/* Points. */

/* Maps the points into the session, which is at time 0. Those that the scene does not carry (any more) are dropped.
 * FALSE with the error of the first of them. */
static gboolean watch_points(SporePlots *self, GError **error) {
  SporeSession *session = session_of(self);
  SporeDocument *document = spore_editor_document_get(self->document);
  g_autoptr(GArray) requests = g_array_new(FALSE, FALSE, sizeof(SporeWatchRequest));
  gboolean all = TRUE;
  for (guint i = 0; i < self->points->len;) {
    SporeWatchRequest request = {.name = g_ptr_array_index(self->points, i)};
    if (spore_watch_place_parse(spore_session_simulation(session), document, request.name, &request.body, &request.at,
                                all ? error : NULL)) {
      g_array_append_val(requests, request);
      i++;
    } else {
      all = FALSE;
      g_ptr_array_remove_index(self->points, i);
    }
  }
  gboolean watched = spore_session_watch(session, (const SporeWatchRequest *)(gconstpointer)requests->data,
                                         requests->len, all ? error : NULL);
  fill_groups(self);
  return all && watched;
}

/* Goes back to time 0 and stands still; TRUE: it was playing. */
static gboolean stand_at_start(SporePlots *self) {
  gboolean playing = spore_player_is_playing(self->player);
  if (playing) spore_player_pause(self->player);
  if (spore_session_snapshot(session_of(self))->step > 0) spore_player_reset(self->player);
  return playing;
}

gboolean spore_plots_watch(SporePlots *self, const char *point, GError **error) {
  g_ptr_array_add(self->points, g_strdup(point));
  if (!session_of(self)) {
    choose(self, "watch");
    self->asked = TRUE;
    spore_player_prepare(self->player);
    return TRUE;
  }
  gboolean playing = stand_at_start(self);
  gboolean watched = watch_points(self, error);
  if (watched) gtk_combo_box_set_active_id(GTK_COMBO_BOX(self->choice), "watch");
  if (playing) spore_player_play(self->player);
  return watched;
}

void spore_plots_forget_points(SporePlots *self) {
  g_ptr_array_set_size(self->points, 0);
  if (!session_of(self)) return;
  gboolean playing = stand_at_start(self);
  watch_points(self, NULL);
  if (playing) spore_player_play(self->player);
}

static void point_entered(GtkEntry *entry, SporePlots *self) {
  spore_activate(GTK_WIDGET(self), "watch", g_variant_new_string(gtk_entry_get_text(entry)));
}

/* Files. */

gboolean spore_plots_save(SporePlots *self, const char *file, GError **error) {
  SporeSession *session = session_of(self);
  SporeError fault = SPORE_ERROR_INIT;
  size_t size = 0;
  if (!session)
    return spore_error_raise(error, SPORE_ERROR_INPUT, file, _("there are no numbers yet; play the scene first"));
  char *text = NULL;
  if (g_str_has_suffix(file, ".csv")) {
    text = spore_session_csv(session, &size);
  } else {
    g_autofree char *title = spore_editor_document_get_title(self->document);
    refresh(self);
    text = spore_plot_svg(title, NULL, &self->panel, 1, &fault);
    size = text ? strlen(text) : 0;
    if (!text) return spore_error_propagate(&fault, error);
  }
  gboolean saved = text ? spore_write_file(file, text, size, error)
                        : spore_error_raise(error, SPORE_ERROR_MEMORY, file, _("not enough memory"));
  spore_free(text);
  return saved;
}

/* Life. */

/* Another world: its columns, and its points. A point that an edit has made impossible goes without a word, one that
 * was asked for in vain does not. */
static void player_replaced(SporePlots *self) {
  g_autoptr(GError) error = NULL;
  if (session_of(self) && self->points->len > 0) watch_points(self, self->asked ? &error : NULL);
  else fill_groups(self);
  self->asked = self->asked && !session_of(self);
  if (error) spore_activate(GTK_WIDGET(self), "report", g_variant_new_string(error->message));
  refresh(self);
}

static void release_document(SporePlots *self) {
  spore_line_plot_set_panel(SPORE_LINE_PLOT(self->plot), NULL, NULL);
  if (self->player) g_signal_handlers_disconnect_by_data(self->player, self);
  g_clear_object(&self->player);
  g_clear_object(&self->document);
}

void spore_plots_set_document(SporePlots *self, SporeEditorDocument *document, SporePlayer *player) {
  release_document(self);
  g_ptr_array_set_size(self->points, 0);
  self->document = g_object_ref(document);
  self->player = g_object_ref(player);
  g_signal_connect_object(player, "replaced", G_CALLBACK(player_replaced), self, G_CONNECT_SWAPPED);
  player_replaced(self);
}

static void spore_plots_dispose(GObject *object) {
  SporePlots *self = SPORE_PLOTS(object);
  g_clear_handle_id(&self->timer, g_source_remove);
  if (self->plot) release_document(self);
  G_OBJECT_CLASS(spore_plots_parent_class)->dispose(object);
}

static void spore_plots_finalize(GObject *object) {
  SporePlots *self = SPORE_PLOTS(object);
  clear_lines(self);
  g_ptr_array_unref(self->labels);
  g_ptr_array_unref(self->groups);
  g_ptr_array_unref(self->points);
  g_free(self->chosen);
  g_free(self->y_label);
  G_OBJECT_CLASS(spore_plots_parent_class)->finalize(object);
}

static void spore_plots_class_init(SporePlotsClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_plots_dispose;
  G_OBJECT_CLASS(class)->finalize = spore_plots_finalize;
  g_type_ensure(SPORE_TYPE_LINE_PLOT);
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-plots.ui");
  gtk_widget_class_bind_template_child(widget, SporePlots, choice);
  gtk_widget_class_bind_template_child(widget, SporePlots, point);
  gtk_widget_class_bind_template_child(widget, SporePlots, plot);
  gtk_widget_class_bind_template_callback(widget, choice_changed);
  gtk_widget_class_bind_template_callback(widget, point_entered);
}

static void spore_plots_init(SporePlots *self) {
  self->groups = g_ptr_array_new_with_free_func(free_group);
  self->points = g_ptr_array_new_with_free_func(g_free);
  self->labels = g_ptr_array_new_with_free_func(g_free);
  gtk_widget_init_template(GTK_WIDGET(self));
  spore_combo_shrinks(self->choice, CHOICE_LEAST_CHARS, CHOICE_CHARS);
  self->timer = g_timeout_add(REFRESH_MS, tick, self);
}
