/* Follows a job. */
#include "ui/panels/spore-job-bar.h"

#include <glib/gi18n.h>

struct _SporeJobBar {
  GtkBox parent;
  GtkWidget *bar;
  SporeJob *job;
};

G_DEFINE_FINAL_TYPE(SporeJobBar, spore_job_bar, GTK_TYPE_BOX)

static void show(SporeJobBar *self) {
  g_autofree char *stage = spore_job_get_stage(self->job);
  gtk_progress_bar_set_fraction(GTK_PROGRESS_BAR(self->bar), spore_job_get_fraction(self->job));
  gtk_progress_bar_set_text(GTK_PROGRESS_BAR(self->bar), *stage ? stage : spore_job_get_title(self->job));
}

static void cancel_clicked(SporeJobBar *self) {
  if (self->job) spore_job_cancel(self->job);
}

void spore_job_bar_set_job(SporeJobBar *self, SporeJob *job) {
  if (self->job) g_signal_handlers_disconnect_by_data(self->job, self);
  g_set_object(&self->job, job);
  gtk_widget_set_visible(GTK_WIDGET(self), job != NULL);
  if (!job) return;
  g_signal_connect_object(job, "progressed", G_CALLBACK(show), self, G_CONNECT_SWAPPED);
  show(self);
}

static void spore_job_bar_dispose(GObject *object) {
  SporeJobBar *self = SPORE_JOB_BAR(object);
  if (self->job) g_signal_handlers_disconnect_by_data(self->job, self);
  g_clear_object(&self->job);
  G_OBJECT_CLASS(spore_job_bar_parent_class)->dispose(object);
}

static void spore_job_bar_class_init(SporeJobBarClass *class) {
  G_OBJECT_CLASS(class)->dispose = spore_job_bar_dispose;
}

static void spore_job_bar_init(SporeJobBar *self) {
  GtkWidget *cancel = gtk_button_new_with_label(_("Cancel"));
  self->bar = gtk_progress_bar_new();
  gtk_progress_bar_set_show_text(GTK_PROGRESS_BAR(self->bar), TRUE);
  gtk_progress_bar_set_ellipsize(GTK_PROGRESS_BAR(self->bar), PANGO_ELLIPSIZE_END);
  gtk_widget_set_valign(self->bar, GTK_ALIGN_CENTER);
  gtk_style_context_add_class(gtk_widget_get_style_context(GTK_WIDGET(self)), "job-bar");
  gtk_box_set_spacing(GTK_BOX(self), 4);
  gtk_box_pack_start(GTK_BOX(self), self->bar, TRUE, TRUE, 0);
  gtk_box_pack_start(GTK_BOX(self), cancel, FALSE, FALSE, 0);
  gtk_widget_show(self->bar);
  gtk_widget_show(cancel);
  gtk_widget_set_no_show_all(GTK_WIDGET(self), TRUE);
  g_signal_connect_swapped(cancel, "clicked", G_CALLBACK(cancel_clicked), self);
}
