/* The plan of a step as a table. It is made on a worker while the panel is seen; Measure times the scene there, too. */
#include "ui/panels/spore-plan.h"

#include <glib/gi18n.h>

#include <string.h>

#include "core/io/scene_xml.h"
#include "ui/jobs/plan-work.h"
#include "ui/jobs/spore-job.h"
#include "ui/panels/spore-advice.h"
#include "ui/panels/spore-budget.h"
#include "ui/panels/spore-finding.h"
#include "ui/panels/spore-job-bar.h"

#define DELAY_MS 400 /* after the last change */

struct _SporePlanPanel {
  GtkBox parent;
  GtkListStore *store;
  GtkWidget *tree, *summary, *measure, *copy, *save, *job_bar, *budget, *advice_place, *advice;
  SporeEditorDocument *document;
  guint timer;
  gboolean stale; /* the table is not of the scene as it is */
  SporeJob *job;  /* NULL: none runs */
  char *csv;      /* the table that is shown; NULL: none */
};

G_DEFINE_FINAL_TYPE(SporePlanPanel, spore_plan, GTK_TYPE_BOX)

enum { COLUMN_STAGE, COLUMN_IN, COLUMN_ITEMS, COLUMN_ESTIMATE, COLUMN_MEASURED, COLUMN_WHY, COLUMN_SENSITIVE };

static char *time_text(double us) { return us >= 0 ? g_strdup_printf(_("%.2f µs"), us) : g_strdup("–"); }

/* saves_us: NAN where nothing was measured. */
static void add_row(SporePlanPanel *self, const char *name, gboolean included, const char *items, double estimate_us,
                    double measured_us, const char *why) {
  g_autofree char *estimate = time_text(estimate_us), *measured = time_text(measured_us);
  gtk_list_store_insert_with_values(self->store, NULL, -1, COLUMN_STAGE, name, COLUMN_IN, included ? _("yes") : _("no"),
                                    COLUMN_ITEMS, items, COLUMN_ESTIMATE, estimate, COLUMN_MEASURED, measured,
                                    COLUMN_WHY, why, COLUMN_SENSITIVE, included, -1);
}

static void add_stage(SporePlanPanel *self, const SporePlanStage *stage, const SporePlanWork *work) {
  g_autofree char *items = g_strdup_printf("%zu", stage->items);
  add_row(self, stage->name, stage->included, stage->included ? items : "", stage->included ? stage->estimate_us : -1,
          spore_plan_work_measured_us(work, stage), stage->reason);
}

/* What is left out saves something where it was measured. */
static void add_left_out(SporePlanPanel *self, const SporePlanLeftOut *left_out, const SporePlanWork *work) {
  g_autofree char *why = NULL;
  double us = spore_plan_work_saved_us(work, left_out);
  if (us >= 0.01) why = g_strdup_printf(_("%s: saves %.2f µs a step"), left_out->reason, us);
  add_row(self, left_out->what, FALSE, "", -1, -1, why ? why : left_out->reason);
}

static char *summary_of(const SporePlanWork *work, double estimate_us, double dt_s) {
  const SporePruning *pruning = &work->pruning;
  if (!work->unpruned)
    return g_strdup_printf(_("A step: about %.0f µs of %g µs that it simulates"), estimate_us, 1e6 * dt_s);
  const char *same = pruning->equal             ? _("the same to the bit")
                     : pruning->most_asleep > 0 ? _("the same but for bodies that sleep")
                                                : _("not the same: a fault of ours");
  return g_strdup_printf(
      _("A step: %.1f µs of %g µs that it simulates; with nothing left out %.1f µs (%.2f times), %s"), pruning->us,
      1e6 * dt_s, pruning->unpruned_us, pruning->ratio, same);
}

/* Takes the table; NULL: none. */
static void set_csv(SporePlanPanel *self, char *csv) {
  g_free(self->csv);
  self->csv = csv;
  gtk_widget_set_sensitive(self->copy, csv != NULL);
  gtk_widget_set_sensitive(self->save, csv != NULL);
}

static void clear(SporePlanPanel *self) {
  gtk_list_store_clear(self->store);
  set_csv(self, NULL);
}

static void show(SporePlanPanel *self, const SporePlanWork *work) {
  const SporePlan *plan = spore_world_plan(work->simulation->world);
  clear(self);
  set_csv(self, spore_plan_work_csv(work));
  for (gsize i = 0; i < plan->stage_count; i++) add_stage(self, &plan->stages[i], work);
  for (gsize i = 0; i < plan->left_out_count; i++) add_left_out(self, &plan->left_out[i], work);
  double dt_s = spore_object_number(spore_document_section(work->document, "solver"), "time_step");
  g_autofree char *summary = summary_of(work, plan->estimate_us, dt_s);
  gtk_label_set_text(GTK_LABEL(self->summary), summary);
}

static void start(SporePlanPanel *self, gboolean measured);

static void planned(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporePlanPanel *self = owner;
  const SporePlanWork *work = data;
  if (self->job != job) return; /* of another scene */
  g_clear_object(&self->job);
  spore_job_bar_set_job(SPORE_JOB_BAR(self->job_bar), NULL);
  gtk_widget_set_sensitive(self->measure, TRUE);
  if (self->timer) return; /* the scene has changed since, and is planned again */
  if (error) {
    clear(self);
    gtk_label_set_text(GTK_LABEL(self->summary), g_error_matches(error, SPORE_ERROR, SPORE_ERROR_CANCELLED)
                                                     ? _("Cancelled: nothing was planned")
                                                     : error->message);
    return;
  }
  if (spore_document_revision(spore_editor_document_get(self->document)) == work->revision) show(self, work);
  else start(self, FALSE);
}

static void start(SporePlanPanel *self, gboolean measured) {
  self->stale = FALSE;
  gtk_widget_set_sensitive(self->measure, FALSE);
  gtk_label_set_text(GTK_LABEL(self->summary), measured ? _("Measuring …") : _("Planning …"));
  self->job = spore_job_start(_("Planning the step"), spore_plan_work_run,
                              spore_plan_work_new(spore_editor_document_get(self->document), measured),
                              spore_plan_work_free, planned, G_OBJECT(self));
  spore_job_bar_set_job(SPORE_JOB_BAR(self->job_bar), self->job);
}

static gboolean plan_again(gpointer data) {
  SporePlanPanel *self = data;
  self->timer = 0;
  if (!self->job && gtk_widget_get_mapped(GTK_WIDGET(self))) start(self, FALSE);
  return G_SOURCE_REMOVE;
}

static void queue(SporePlanPanel *self) {
  self->stale = TRUE;
  g_clear_handle_id(&self->timer, g_source_remove);
  if (gtk_widget_get_mapped(GTK_WIDGET(self))) self->timer = g_timeout_add(DELAY_MS, plan_again, self);
}

static void mapped(SporePlanPanel *self) {
  if (self->stale && self->document && !self->job) start(self, FALSE);
}

static void measure_clicked(GtkButton *button, SporePlanPanel *self) {
  if (self->document && !self->job) start(self, TRUE);
}

static void copy_clicked(GtkButton *button, SporePlanPanel *self) {
  GtkClipboard *clipboard = gtk_widget_get_clipboard(GTK_WIDGET(button), GDK_SELECTION_CLIPBOARD);
  if (self->csv) gtk_clipboard_set_text(clipboard, self->csv, -1);
}

gboolean spore_plan_save(SporePlanPanel *self, const char *file, GError **error) {
  if (!self->csv)
    return spore_error_raise(error, SPORE_ERROR_INPUT, file, _("there is no plan yet; open the tab Plan first"));
  return spore_write_file(file, self->csv, strlen(self->csv), error);
}

static void release_document(SporePlanPanel *self) {
  g_clear_handle_id(&self->timer, g_source_remove);
  if (self->job) spore_job_cancel(self->job);
  g_clear_object(&self->job);
  if (self->document) g_signal_handlers_disconnect_by_data(self->document, self);
  g_clear_object(&self->document);
}

void spore_plan_set_document(SporePlanPanel *self, SporeEditorDocument *document) {
  release_document(self);
  self->document = g_object_ref(document);
  g_signal_connect_object(document, "changed", G_CALLBACK(queue), self, G_CONNECT_SWAPPED);
  clear(self);
  spore_budget_set_document(SPORE_BUDGET(self->budget), document);
  spore_finding_set_document(SPORE_FINDING(self->advice), document);
  spore_job_bar_set_job(SPORE_JOB_BAR(self->job_bar), NULL);
  gtk_widget_set_sensitive(self->measure, TRUE);
  queue(self);
}

static void spore_plan_dispose(GObject *object) {
  release_document(SPORE_PLAN(object));
  G_OBJECT_CLASS(spore_plan_parent_class)->dispose(object);
}

static void spore_plan_finalize(GObject *object) {
  g_free(SPORE_PLAN(object)->csv);
  G_OBJECT_CLASS(spore_plan_parent_class)->finalize(object);
}

static void spore_plan_class_init(SporePlanPanelClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_plan_dispose;
  G_OBJECT_CLASS(class)->finalize = spore_plan_finalize;
  g_type_ensure(SPORE_TYPE_JOB_BAR);
  g_type_ensure(SPORE_TYPE_BUDGET);
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-plan.ui");
  gtk_widget_class_bind_template_child(widget, SporePlanPanel, store);
  gtk_widget_class_bind_template_child(widget, SporePlanPanel, tree);
  gtk_widget_class_bind_template_child(widget, SporePlanPanel, summary);
  gtk_widget_class_bind_template_child(widget, SporePlanPanel, measure);
  gtk_widget_class_bind_template_child(widget, SporePlanPanel, copy);
  gtk_widget_class_bind_template_child(widget, SporePlanPanel, save);
  gtk_widget_class_bind_template_child(widget, SporePlanPanel, job_bar);
  gtk_widget_class_bind_template_child(widget, SporePlanPanel, budget);
  gtk_widget_class_bind_template_child(widget, SporePlanPanel, advice_place);
  gtk_widget_class_bind_template_callback(widget, measure_clicked);
  gtk_widget_class_bind_template_callback(widget, copy_clicked);
}

static void spore_plan_init(SporePlanPanel *self) {
  gtk_widget_init_template(GTK_WIDGET(self));
  self->advice = spore_advice_box_new();
  gtk_box_pack_start(GTK_BOX(self->advice_place), self->advice, TRUE, TRUE, 0);
  g_signal_connect(self, "map", G_CALLBACK(mapped), NULL);
}
