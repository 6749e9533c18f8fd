/* The box of the budget: the slider, the search as a job, what was found, and a button that applies that. */
#include "ui/panels/spore-budget.h"

#include <glib/gi18n.h>
#include <math.h>

#include "ui/jobs/budget-work.h"
#include "ui/jobs/spore-job.h"
#include "ui/panels/report.h"
#include "ui/panels/spore-job-bar.h"

/* Powers of ten of a time in us. */
#define LEAST 0.
#define MOST 5.
#define FIRST 3.

struct _SporeBudgetBox {
  GtkBox parent;
  GtkWidget *slider, *choose, *apply, *job_bar, *result;
  SporeEditorDocument *document;
  SporeJob *job;      /* NULL: none runs */
  SporeBudget *found; /* NULL: nothing was */
  guint64 revision;   /* of the scene that it was found for */
};

G_DEFINE_FINAL_TYPE(SporeBudgetBox, spore_budget, GTK_TYPE_BOX)

static double budget_us(SporeBudgetBox *self) {
  double value = pow(10, gtk_range_get_value(GTK_RANGE(self->slider)));
  double unit = pow(10, floor(log10(value)) - 1);
  return unit * round(value / unit);
}

static char *format_value(GtkScale *scale, double value, gpointer self) {
  return g_strdup_printf(_("%g µs a step"), budget_us(self));
}

static void set_result(SporeBudgetBox *self, const char *text) {
  gtk_label_set_text(GTK_LABEL(self->result), text);
  gtk_widget_set_visible(self->result, *text != '\0');
}

/* What was found can be applied to the scene that it was found for alone. */
static void update(SporeBudgetBox *self) {
  gboolean fresh = self->found && spore_document_revision(spore_editor_document_get(self->document)) == self->revision;
  gtk_widget_set_sensitive(self->choose, self->document && !self->job);
  gtk_widget_set_sensitive(self->apply, fresh && self->found->met && spore_budget_changes(self->found));
}

static void describe(SporeBudgetBox *self) {
  const SporeBudget *found = self->found;
  g_autofree char *before = spore_budget_error_text(&found->before), *chosen = spore_budget_error_text(&found->chosen);
  g_autoptr(GString) text = g_string_new(NULL);
  if (found->chosen.median_us > 0)
    g_string_append_printf(text, _("As it is: error %s, %.4g µs. Chosen: error %s, %.4g µs, timed again %.4g µs (%s)"),
                           before, found->before.us, chosen, found->chosen.us, found->chosen.median_us,
                           found->kept_promise ? _("the promise held") : _("the promise did not hold"));
  else
    g_string_append_printf(text, _("It cannot be met: the nearest that was found takes %.4g µs, error %s"),
                           found->chosen.us, chosen);
  g_autoptr(GArray) changes = spore_budget_list_changes(found);
  for (guint i = 0; i < changes->len; i++) {
    const SporeBudgetChange *change = &g_array_index(changes, SporeBudgetChange, i);
    g_string_append_printf(text, "\n%s: %s", change->id, change->text);
  }
  if (found->happens) g_string_append_printf(text, _("\nIn one of the two alone %s"), found->happens);
  set_result(self, text->str);
}

static void searched(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeBudgetBox *self = owner;
  SporeBudgetWork *work = data;
  if (self->job != job) return; /* of another scene */
  g_clear_object(&self->job);
  spore_job_bar_set_job(SPORE_JOB_BAR(self->job_bar), NULL);
  if (error) {
    set_result(self, g_error_matches(error, SPORE_ERROR, SPORE_ERROR_CANCELLED) ? _("Cancelled: nothing was chosen")
                                                                                : error->message);
  } else {
    self->found = g_steal_pointer(&work->budget);
    self->revision = work->revision;
    describe(self);
  }
  update(self);
}

static void choose_clicked(GtkButton *button, SporeBudgetBox *self) {
  if (!self->document || self->job) return;
  g_clear_pointer(&self->found, spore_budget_free);
  set_result(self, _("Running the scene by other settings …"));
  self->job = spore_job_start(_("Budget"), spore_budget_work_run,
                              spore_budget_work_new(spore_editor_document_get(self->document), budget_us(self)),
                              spore_budget_work_free, searched, G_OBJECT(self));
  spore_job_bar_set_job(SPORE_JOB_BAR(self->job_bar), self->job);
  update(self);
}

static void apply_clicked(GtkButton *button, SporeBudgetBox *self) {
  g_autoptr(GError) error = NULL;
  if (!self->found) return;
  if (!spore_budget_apply(self->found, spore_editor_document_get(self->document), &error))
    spore_report(GTK_WIDGET(self), error);
}

static void release_document(SporeBudgetBox *self) {
  if (self->job) spore_job_cancel(self->job);
  g_clear_object(&self->job);
  g_clear_pointer(&self->found, spore_budget_free);
  if (self->document) g_signal_handlers_disconnect_by_data(self->document, self);
  g_clear_object(&self->document);
}

void spore_budget_set_document(SporeBudgetBox *self, SporeEditorDocument *document) {
  release_document(self);
  self->document = g_object_ref(document);
  g_signal_connect_object(document, "changed", G_CALLBACK(update), self, G_CONNECT_SWAPPED);
  spore_job_bar_set_job(SPORE_JOB_BAR(self->job_bar), NULL);
  set_result(self, "");
  update(self);
}

static void spore_budget_dispose(GObject *object) {
  release_document(SPORE_BUDGET(object));
  G_OBJECT_CLASS(spore_budget_parent_class)->dispose(object);
}

static void spore_budget_class_init(SporeBudgetBoxClass *class) {
  G_OBJECT_CLASS(class)->dispose = spore_budget_dispose;
}

static GtkWidget *add_button(GtkWidget *row, const char *label, const char *hint) {
  GtkWidget *button = gtk_button_new_with_label(label);
  gtk_widget_set_tooltip_text(button, hint);
  gtk_widget_set_sensitive(button, FALSE);
  gtk_container_add(GTK_CONTAINER(row), button);
  return button;
}

static void spore_budget_init(SporeBudgetBox *self) {
  GtkWidget *row = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 4);
  gtk_orientable_set_orientation(GTK_ORIENTABLE(self), GTK_ORIENTATION_VERTICAL);
  self->slider = gtk_scale_new_with_range(GTK_ORIENTATION_HORIZONTAL, LEAST, MOST, 0.05);
  gtk_scale_set_value_pos(GTK_SCALE(self->slider), GTK_POS_RIGHT);
  gtk_widget_set_tooltip_text(self->slider, _("What may be spent on the time that a step of the scene simulates now"));
  atk_object_set_name(gtk_widget_get_accessible(self->slider), _("Budget"));
  g_signal_connect(self->slider, "format-value", G_CALLBACK(format_value), self);
  gtk_range_set_value(GTK_RANGE(self->slider), FIRST);
  spore_ignore_wheel(self->slider);
  gtk_widget_show(self->slider);
  gtk_container_add(GTK_CONTAINER(self), self->slider);
  self->choose = add_button(row, _("Fit budget"),
                            _("Choose level, integrator, step and solvers that cost no more, with the least error"));
  self->apply = add_button(row, _("Apply budget"), _("Give the scene what was chosen, as one step that can be undone"));
  g_signal_connect(self->choose, "clicked", G_CALLBACK(choose_clicked), self);
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
}
