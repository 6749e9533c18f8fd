/* The list of attempts at an exercise. */
#include "ui/panels/attempt-list.h"

#include <glib/gi18n.h>

#include "ui/document/attempts.h"

#define MOST_ROWS 20

static void add_label(GtkBox *box, const char *text, const char *class) {
  GtkWidget *label = gtk_label_new(text);
  gtk_label_set_xalign(GTK_LABEL(label), 0);
  gtk_label_set_ellipsize(GTK_LABEL(label), PANGO_ELLIPSIZE_END);
  gtk_widget_set_tooltip_text(label, text);
  if (class) gtk_style_context_add_class(gtk_widget_get_style_context(label), class);
  gtk_container_add(GTK_CONTAINER(box), label);
}

static void add_attempt(GtkBox *box, const SporeAttempt *attempt) {
  g_autoptr(GDateTime) when = g_date_time_new_from_unix_local(attempt->when);
  g_autofree char *date = g_date_time_format(when, "%x %H:%M");
  g_autofree char *text =
      g_strdup_printf(_("%s: score %.1f, %.2f s, %llu of %llu steps, %s"), date, attempt->score, attempt->time_s,
                      (unsigned long long)attempt->steps_done, (unsigned long long)attempt->steps,
                      attempt->passed ? _("passed") : _("not passed"));
  add_label(box, text, NULL);
}

void spore_fill_attempt_list(GtkBox *box, const GArray *attempts) {
  gtk_container_foreach(GTK_CONTAINER(box), (GtkCallback)(void (*)(void))gtk_widget_destroy, NULL);
  if (attempts->len > 0) add_label(box, _("Attempts"), "heading");
  for (guint i = 0; i < MIN(attempts->len, MOST_ROWS); i++)
    add_attempt(box, &g_array_index(attempts, SporeAttempt, attempts->len - 1 - i));
  gtk_widget_set_tooltip_text(
      GTK_WIDGET(box), _("Runs that ended, newest first, scored by the exercise as it was then; try-outs are not "
                         "among them"));
  gtk_widget_show_all(GTK_WIDGET(box));
}
