/* The run as a line in time. */
#include "ui/panels/spore-timeline.h"

#include <glib/gi18n.h>
#include <math.h>

#define TICK_MS 100
#define SETTLE_MS 150 /* after the last move of the slider, before the run goes there */

struct _SporeTimeline {
  GtkBox parent;
  GtkWidget *scale, *label, *stay, *lost, *bookmarks;
  GtkAdjustment *time;
  SporePlayer *player;
  GArray *kept; /* double, s: times of the bookmarks, ascending */
  guint timer, settling;
};

G_DEFINE_FINAL_TYPE(SporeTimeline, spore_timeline, GTK_TYPE_BOX)

static SporeSession *session_of(SporeTimeline *self) {
  return self->player ? spore_player_get_session(self->player) : NULL;
}

/* Bookmarks. */

static void show_bookmarks(SporeTimeline *self) {
  gtk_container_foreach(GTK_CONTAINER(self->bookmarks), (GtkCallback)(void (*)(void))gtk_widget_destroy, NULL);
  gtk_scale_clear_marks(GTK_SCALE(self->scale));
  for (guint i = 0; i < self->kept->len; i++) {
    double time_s = g_array_index(self->kept, double, i);
    g_autofree char *text = g_strdup_printf(_("%.3f s"), time_s);
    GtkWidget *button = gtk_button_new_with_label(text);
    gtk_widget_set_tooltip_text(button, _("Go to this time of the run"));
    gtk_actionable_set_action_name(GTK_ACTIONABLE(button), "win.go-to");
    gtk_actionable_set_action_target_value(GTK_ACTIONABLE(button), g_variant_new_double(time_s));
    gtk_scale_add_mark(GTK_SCALE(self->scale), time_s, GTK_POS_BOTTOM, NULL);
    gtk_container_add(GTK_CONTAINER(self->bookmarks), button);
  }
  gtk_widget_show_all(self->bookmarks);
}

/* Those of times that the run does not reach any more go. */
static void drop_bookmarks(SporeTimeline *self, double reached_s) {
  guint had = self->kept->len;
  while (self->kept->len > 0 && g_array_index(self->kept, double, self->kept->len - 1) > reached_s * (1 + 1e-9))
    g_array_set_size(self->kept, self->kept->len - 1);
  if (self->kept->len < had) show_bookmarks(self);
}

gboolean spore_timeline_bookmark(SporeTimeline *self) {
  SporeSession *session = session_of(self);
  double time_s = session ? spore_session_snapshot(session)->time_s : 0;
  guint at = 0;
  while (at < self->kept->len && g_array_index(self->kept, double, at) < time_s) at++;
  if (time_s <= 0 || (at < self->kept->len && g_array_index(self->kept, double, at) == time_s)) return FALSE;
  g_array_insert_val(self->kept, at, time_s);
  show_bookmarks(self);
  return TRUE;
}

/* What is shown. */

static void show_times(SporeTimeline *self, double now_s, double reached_s, double step_s) {
  if (!self->settling) /* else the slider is being moved */
    gtk_adjustment_configure(self->time, fmin(now_s, reached_s), 0, fmax(reached_s, step_s), step_s, 10 * step_s, 0);
  g_autofree char *text = g_strdup_printf(_("%.3f of %.3f s"), now_s, reached_s);
  gtk_label_set_text(GTK_LABEL(self->label), text);
}

static void refresh(SporeTimeline *self) {
  SporeSession *session = session_of(self);
  gboolean knows = session && spore_player_knows_past(self->player);
  double now_s = session ? spore_session_snapshot(session)->time_s : 0;
  double step_s = session ? spore_session_step_s(session) : 1;
  double reached_s = knows ? fmax(now_s, (double)spore_session_reached(session) * step_s) : now_s;
  drop_bookmarks(self, knows ? reached_s : 0);
  gtk_widget_set_sensitive(self->scale, knows && reached_s > 0);
  gtk_widget_set_visible(self->stay, session && spore_player_is_going(self->player, NULL));
  gtk_widget_set_visible(self->lost, session && !knows && !spore_player_is_making(self->player));
  show_times(self, now_s, reached_s, step_s);
}

static gboolean tick(gpointer data) {
  SporeTimeline *self = data;
  if (gtk_widget_get_mapped(GTK_WIDGET(self))) refresh(self);
  return G_SOURCE_CONTINUE;
}

/* Going. */

static gboolean may_go(SporeTimeline *self, GError **error) {
  if (session_of(self) && spore_player_knows_past(self->player)) return TRUE;
  return spore_error_raise(error, SPORE_ERROR_INPUT, "",
                           _("the scene was changed while it ran, so that the run cannot be computed anew; go back to "
                             "the start first (Shift+F5)"));
}

gboolean spore_timeline_go_to(SporeTimeline *self, double time_s, GError **error) {
  if (!may_go(self, error)) return FALSE;
  SporeSession *session = session_of(self);
  double reached = (double)spore_session_reached(session);
  spore_player_go_to(self->player, (guint64)fmin(fmax(round(time_s / spore_session_step_s(session)), 0), reached));
  refresh(self);
  return TRUE;
}

gboolean spore_timeline_step_back(SporeTimeline *self, GError **error) {
  if (!may_go(self, error)) return FALSE;
  guint64 step = spore_session_snapshot(session_of(self))->step;
  if (step > 0) spore_player_go_to(self->player, step - 1);
  refresh(self);
  return TRUE;
}

gboolean spore_timeline_replay(SporeTimeline *self, GError **error) {
  if (!may_go(self, error)) return FALSE;
  spore_player_replay(self->player);
  refresh(self);
  return TRUE;
}

static gboolean settle(gpointer data) {
  SporeTimeline *self = data;
  self->settling = 0;
  if (session_of(self)) spore_timeline_go_to(self, gtk_adjustment_get_value(self->time), NULL);
  return G_SOURCE_REMOVE;
}

static gboolean scale_moved(GtkRange *range, GtkScrollType scroll, double value, SporeTimeline *self) {
  g_clear_handle_id(&self->settling, g_source_remove);
  self->settling = g_timeout_add(SETTLE_MS, settle, self);
  return FALSE;
}

/* Life. */

static void release_player(SporeTimeline *self) {
  g_clear_handle_id(&self->settling, g_source_remove);
  if (self->player) g_signal_handlers_disconnect_by_data(self->player, self);
  g_clear_object(&self->player);
}

void spore_timeline_set_player(SporeTimeline *self, SporePlayer *player) {
  release_player(self);
  self->player = g_object_ref(player);
  g_signal_connect_object(player, "state-changed", G_CALLBACK(refresh), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(player, "replaced", G_CALLBACK(refresh), self, G_CONNECT_SWAPPED);
  refresh(self);
}

static void spore_timeline_dispose(GObject *object) {
  SporeTimeline *self = SPORE_TIMELINE(object);
  g_clear_handle_id(&self->timer, g_source_remove);
  release_player(self);
  G_OBJECT_CLASS(spore_timeline_parent_class)->dispose(object);
}

static void spore_timeline_finalize(GObject *object) {
  g_array_unref(SPORE_TIMELINE(object)->kept);
  G_OBJECT_CLASS(spore_timeline_parent_class)->finalize(object);
}

static void spore_timeline_class_init(SporeTimelineClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_timeline_dispose;
  G_OBJECT_CLASS(class)->finalize = spore_timeline_finalize;
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-timeline.ui");
  gtk_widget_class_bind_template_child(widget, SporeTimeline, time);
  gtk_widget_class_bind_template_child(widget, SporeTimeline, scale);
  gtk_widget_class_bind_template_child(widget, SporeTimeline, label);
  gtk_widget_class_bind_template_child(widget, SporeTimeline, stay);
  gtk_widget_class_bind_template_child(widget, SporeTimeline, lost);
  gtk_widget_class_bind_template_child(widget, SporeTimeline, bookmarks);
  gtk_widget_class_bind_template_callback(widget, scale_moved);
}

static void spore_timeline_init(SporeTimeline *self) {
  self->kept = g_array_new(FALSE, FALSE, sizeof(double));
  gtk_widget_init_template(GTK_WIDGET(self));
  self->timer = g_timeout_add(TICK_MS, tick, self);
}
