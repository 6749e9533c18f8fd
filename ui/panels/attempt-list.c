/* The list of attempts at an exercise. */
#include "ui/panels/attempt-list.h"

#include <glib/gi18n.h>

#include "ui/document/attempts.h"

/* The buttons that tick attempts, and those that do something with them. */
typedef struct Choice {
  GtkWidget *repeat, *film;
  GPtrArray *ticks; /* of GtkToggleButton, borrowed */
  GArray *whens;    /* of gint64, by ticks */
} Choice;

static void free_choice(gpointer data) {
  Choice *choice = data;
  g_ptr_array_unref(choice->ticks);
  g_array_unref(choice->whens);
  g_free(choice);
}

/* action: NULL: the button can do nothing. Sinks the target. */
static void set_action(GtkWidget *button, const char *action, GVariant *target) {
  g_autoptr(GVariant) sunk = g_variant_ref_sink(target);
  gtk_actionable_set_action_name(GTK_ACTIONABLE(button), NULL);
  gtk_actionable_set_action_target_value(GTK_ACTIONABLE(button), sunk);
  if (action) gtk_actionable_set_action_name(GTK_ACTIONABLE(button), action);
  else gtk_widget_set_sensitive(button, FALSE);
}

/* One attempt is filmed, or two side by side, the older at the left; one is repeated. */
static void update_buttons(Choice *choice) {
  GVariantBuilder whens;
  g_variant_builder_init(&whens, G_VARIANT_TYPE("ax"));
  guint count = 0;
  gint64 newest = 0;
  for (guint i = choice->ticks->len; i > 0; i--) {
    if (!gtk_toggle_button_get_active(choice->ticks->pdata[i - 1])) continue;
    newest = g_array_index(choice->whens, gint64, i - 1);
    g_variant_builder_add(&whens, "x", newest);
    count++;
  }
  set_action(choice->film, count == 1 || count == 2 ? "win.film-attempts-dialog" : NULL, g_variant_builder_end(&whens));
  set_action(choice->repeat, count == 1 ? "win.repeat-attempt" : NULL, g_variant_new_int64(newest));
}

static void add_label(GtkBox *box, const char *text, const char *class) {
  GtkWidget *label = gtk_label_new(text);
  gtk_label_set_xalign(GTK_LABEL(label), 0);
  gtk_label_set_ellipsize(GTK_LABEL(label), PANGO_ELLIPSIZE_END);
  gtk_widget_set_tooltip_text(label, text);
  if (class) gtk_style_context_add_class(gtk_widget_get_style_context(label), class);
  gtk_container_add(GTK_CONTAINER(box), label);
}

/* g_free. */
static char *describe(const SporeAttempt *attempt) {
  g_autoptr(GDateTime) when = g_date_time_new_from_unix_local(attempt->when);
  g_autofree char *date = g_date_time_format(when, "%x %H:%M");
  return g_strdup_printf(_("%s: score %.1f, %.2f s, %llu of %llu steps, %s"), date, attempt->score, attempt->time_s,
                         (unsigned long long)attempt->steps_done, (unsigned long long)attempt->steps,
                         attempt->passed ? _("passed") : _("not passed"));
}

static gboolean has_track(const char *scene, const SporeAttempt *attempt) {
  g_autofree char *file = scene ? spore_attempts_track_file(scene, attempt) : NULL;
  return file && g_file_test(file, G_FILE_TEST_IS_REGULAR);
}

static void add_tick(GtkBox *row, Choice *choice, const SporeAttempt *attempt, const char *text) {
  GtkWidget *tick = gtk_check_button_new();
  g_autofree char *name = g_strdup_printf(_("Choose %s"), text);
  atk_object_set_name(gtk_widget_get_accessible(tick), name);
  gtk_widget_set_tooltip_text(tick, _("To repeat this attempt, or to film one or two"));
  g_signal_connect_swapped(tick, "toggled", G_CALLBACK(update_buttons), choice);
  g_ptr_array_add(choice->ticks, tick);
  g_array_append_val(choice->whens, attempt->when);
  gtk_container_add(GTK_CONTAINER(row), tick);
}

static void add_attempt(GtkBox *box, const char *scene, const SporeAttempt *attempt, Choice *choice) {
  g_autofree char *text = describe(attempt);
  GtkBox *row = GTK_BOX(gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6));
  if (has_track(scene, attempt)) add_tick(row, choice, attempt, text);
  add_label(row, text, NULL);
  gtk_container_add(GTK_CONTAINER(box), GTK_WIDGET(row));
}

static Choice *new_choice(void) {
  Choice *choice = g_new0(Choice, 1);
  choice->ticks = g_ptr_array_new();
  choice->whens = g_array_new(FALSE, FALSE, sizeof(gint64));
  choice->repeat = gtk_button_new_with_label(_("Repeat"));
  gtk_widget_set_tooltip_text(choice->repeat, _("Tick one attempt, to see it again in the scene as it is now; Shift+F5 "
                                                "ends it"));
  choice->film = gtk_button_new_with_label(_("Film…"));
  gtk_widget_set_tooltip_text(choice->film,
                              _("Tick one attempt, or two to see them side by side: they are repeated in the scene as "
                                "it is now, and filmed as fast as runs are played"));
  return choice;
}

void spore_fill_attempt_list(GtkBox *box, const char *scene, const GArray *attempts) {
  gtk_container_foreach(GTK_CONTAINER(box), (GtkCallback)(void (*)(void))gtk_widget_destroy, NULL);
  Choice *choice = new_choice();
  if (attempts->len > 0) add_label(box, _("Attempts"), "heading");
  for (guint i = 0; i < MIN(attempts->len, SPORE_ATTEMPTS_WITH_TRACKS); i++)
    add_attempt(box, scene, &g_array_index(attempts, SporeAttempt, attempts->len - 1 - i), choice);
  GtkWidget *buttons = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6);
  gtk_container_add(GTK_CONTAINER(buttons), choice->repeat);
  gtk_container_add(GTK_CONTAINER(buttons), choice->film);
  gtk_container_add(GTK_CONTAINER(box), buttons);
  gtk_widget_set_tooltip_text(
      GTK_WIDGET(box), _("Runs that ended, newest first, scored by the exercise as it was then; try-outs are not "
                         "among them"));
  gtk_widget_show_all(GTK_WIDGET(box));
  gtk_widget_set_visible(buttons, choice->ticks->len > 0);
  update_buttons(choice);
  g_object_set_data_full(G_OBJECT(choice->film), "choice", choice, free_choice);
}
