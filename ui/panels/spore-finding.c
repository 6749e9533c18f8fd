/* Finds something for the scene in a job, says what was found, and applies it. */
#include "ui/panels/spore-finding.h"

#include <glib/gi18n.h>

#include "ui/panels/report.h"
#include "ui/panels/spore-job-bar.h"

struct _SporeFindingBox {
  GtkBox parent;
  const SporeFindingKind *kind;
  gpointer data;
  GtkWidget *find, *apply, *job_bar, *result;
  SporeEditorDocument *document;
  SporeJob *job;    /* NULL: none runs */
  guint64 asked;    /* revision of the scene that it runs for */
  gpointer found;   /* NULL: nothing was */
  guint64 revision; /* of the scene that it was found for */
};

G_DEFINE_FINAL_TYPE(SporeFindingBox, spore_finding, GTK_TYPE_BOX)

static void set_result(SporeFindingBox *self, const char *text) {
  gtk_label_set_text(GTK_LABEL(self->result), text);
  gtk_widget_set_visible(self->result, *text != '\0');
}

static void update(SporeFindingBox *self) {
  SporeDocument *document = spore_editor_document_get(self->document);
  gboolean fresh = self->found && spore_document_revision(document) == self->revision;
  gtk_widget_set_sensitive(self->find, !self->job);
  gtk_widget_set_sensitive(self->apply, fresh && self->kind->applies(self->found, document));
}

static void ended(SporeJob *job, gpointer work, const GError *error, gpointer owner) {
  SporeFindingBox *self = owner;
  if (self->job != job) return; /* of another scene */
  g_clear_object(&self->job);
  spore_job_bar_set_job(SPORE_JOB_BAR(self->job_bar), NULL);
  if (error) {
    gboolean cancelled = g_error_matches(error, SPORE_ERROR, SPORE_ERROR_CANCELLED);
    set_result(self, cancelled ? _(self->kind->cancelled) : error->message);
  } else {
    self->found = self->kind->take(work);
    self->revision = self->asked;
    g_autofree char *text = self->kind->describe(self->found);
    set_result(self, text);
  }
  update(self);
}

static void forget(SporeFindingBox *self) {
  if (self->found) self->kind->found_free(self->found);
  self->found = NULL;
}

static void find_clicked(GtkButton *button, SporeFindingBox *self) {
  if (!self->document || self->job) return;
  const SporeDocument *document = spore_editor_document_get(self->document);
  forget(self);
  set_result(self, _(self->kind->under_way));
  self->asked = spore_document_revision(document);
  self->job = spore_job_start(_(self->kind->job), self->kind->work_run, self->kind->work_new(document, self->data),
                              self->kind->work_free, ended, G_OBJECT(self));
  spore_job_bar_set_job(SPORE_JOB_BAR(self->job_bar), self->job);
  update(self);
}

static void apply_clicked(GtkButton *button, SporeFindingBox *self) {
  g_autoptr(GError) error = NULL;
  if (!self->found) return;
  if (!self->kind->apply_to(self->found, spore_editor_document_get(self->document), &error))
    spore_report(GTK_WIDGET(self), error);
}

static void release_document(SporeFindingBox *self) {
  if (self->job) spore_job_cancel(self->job);
  g_clear_object(&self->job);
  forget(self);
  if (self->document) g_signal_handlers_disconnect_by_data(self->document, self);
  g_clear_object(&self->document);
}

void spore_finding_set_document(SporeFindingBox *self, SporeEditorDocument *document) {
  release_document(self);
  self->document = g_object_ref(document);
  g_signal_connect_object(document, "changed", G_CALLBACK(update), self, G_CONNECT_SWAPPED);
  spore_job_bar_set_job(SPORE_JOB_BAR(self->job_bar), NULL);
  set_result(self, "");
  update(self);
}

static void spore_finding_dispose(GObject *object) {
  release_document(SPORE_FINDING(object));
  G_OBJECT_CLASS(spore_finding_parent_class)->dispose(object);
}

static void spore_finding_class_init(SporeFindingBoxClass *class) {
  G_OBJECT_CLASS(class)->dispose = spore_finding_dispose;
}

static void spore_finding_init(SporeFindingBox *self) {
  gtk_orientable_set_orientation(GTK_ORIENTABLE(self), GTK_ORIENTATION_VERTICAL);
}

static GtkWidget *add_button(GtkWidget *row, const char *label, const char *hint) {
  GtkWidget *button = gtk_button_new_with_label(_(label));
  gtk_widget_set_tooltip_text(button, _(hint));
  gtk_widget_set_sensitive(button, FALSE);
  gtk_container_add(GTK_CONTAINER(row), button);
  return button;
}

GtkWidget *spore_finding_new(const SporeFindingKind *kind, gpointer data) {
  SporeFindingBox *self = g_object_new(SPORE_TYPE_FINDING, "visible", TRUE, NULL);
  GtkWidget *row = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 4);
  self->kind = kind;
  self->data = data;
  self->find = add_button(row, kind->find, kind->find_hint);
  self->apply = add_button(row, kind->apply, kind->apply_hint);
  g_signal_connect(self->find, "clicked", G_CALLBACK(find_clicked), self);
  g_signal_connect(self->apply, "clicked", G_CALLBACK(apply_clicked), self);
  self->job_bar = g_object_new(SPORE_TYPE_JOB_BAR, NULL);
  gtk_box_pack_start(GTK_BOX(row), self->job_bar, TRUE, TRUE, 0);
  self->result = gtk_label_new(NULL);
  gtk_label_set_xalign(GTK_LABEL(self->result), 0);
  gtk_label_set_line_wrap(GTK_LABEL(self->result), TRUE);
  gtk_label_set_selectable(GTK_LABEL(self->result), TRUE);
  gtk_widget_show_all(row);
  gtk_widget_set_no_show_all(self->job_bar, TRUE);
  gtk_widget_hide(self->job_bar);
  gtk_container_add(GTK_CONTAINER(self), row);
  gtk_container_add(GTK_CONTAINER(self), self->result);
  return GTK_WIDGET(self);
}
