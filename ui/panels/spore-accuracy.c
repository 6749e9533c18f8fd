/* The panel of the accuracy study. */
#include "ui/panels/spore-accuracy.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/author/accuracy_methods.h"
#include "core/author/accuracy_page.h"
#include "core/io/scene_xml.h"
#include "ui/jobs/accuracy-work.h"
#include "ui/jobs/spore-job.h"
#include "ui/panels/report.h"
#include "ui/panels/spore-job-bar.h"
#include "ui/panels/spore-precision-plot.h"

struct _SporeAccuracyPanel {
  GtkBox parent;
  GtkWidget *job_bar, *sentence, *stale, *point, *plot, *details;
  GtkWidget *body, *time, *full, *levels, *spheres, *integrators, *nonlinear,
      *linear; /* options; the last three hold checks */
  SporeEditorDocument *document;
  guint update; /* idle */
  gboolean filling;
  SporeJob *job; /* NULL: none runs */
};

G_DEFINE_FINAL_TYPE(SporeAccuracyPanel, spore_accuracy, GTK_TYPE_BOX)

enum { STUDY_CHANGED, SIGNAL_COUNT };
static guint signals[SIGNAL_COUNT];

static SporeDocument *document_of(SporeAccuracyPanel *self) { return spore_editor_document_get(self->document); }

static const SporeAccuracyStudy *study_of(SporeAccuracyPanel *self) {
  return self->document ? spore_editor_document_get_study(self->document) : NULL;
}

static SporePrecisionPlot *plot_of(SporeAccuracyPanel *self) { return SPORE_PRECISION_PLOT(self->plot); }

/* Options. */

/* A check for each of the first names, in the order of the names. */
static void add_checks(GtkWidget *holder, const char *const *names, guint most) {
  for (guint i = 0; names[i] && i < most; i++) {
    g_autofree char *label = spore_choice_label(names[i]);
    GtkWidget *check = gtk_check_button_new_with_label(label);
    gtk_widget_show(check);
    gtk_container_add(GTK_CONTAINER(holder), check);
  }
}

/* Indices of the checks that are set. */
static GArray *checked(GtkWidget *holder) {
  GArray *indices = g_array_new(FALSE, FALSE, sizeof(int));
  g_autoptr(GList) checks = gtk_container_get_children(GTK_CONTAINER(holder));
  int index = 0;
  for (GList *check = checks; check; check = check->next, index++)
    if (gtk_toggle_button_get_active(check->data)) g_array_append_val(indices, index);
  return indices;
}

static void choose_methods(SporeAccuracyPanel *self, GArray *methods) {
  g_autoptr(GArray) integrators = checked(self->integrators), nonlinear = checked(self->nonlinear),
                    linear = checked(self->linear);
  for (guint i = 0; i < integrators->len; i++) {
    SporeIntegratorKind kind = (SporeIntegratorKind)g_array_index(integrators, int, i);
    spore_accuracy_methods_add(methods, (SporeAccuracyMethod){kind, -1, -1}, nonlinear, linear);
  }
  if (integrators->len == 0) spore_accuracy_methods_add_usual(methods, nonlinear, linear);
}

/* NULL: the whole scene. */
static const char *chosen_body(SporeAccuracyPanel *self) {
  const char *id = gtk_combo_box_get_active_id(GTK_COMBO_BOX(self->body));
  return id && *id ? id : NULL;
}

/* The bodies of the scene; what was chosen stays. */
static void fill_bodies(SporeAccuracyPanel *self) {
  GtkComboBoxText *combo = GTK_COMBO_BOX_TEXT(self->body);
  g_autofree char *chosen = g_strdup(chosen_body(self));
  SporeObject *bodies = spore_document_section(document_of(self), "bodies");
  self->filling = TRUE;
  gtk_combo_box_text_remove_all(combo);
  gtk_combo_box_text_append(combo, "", _("Whole scene"));
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    if ((int)spore_object_number(body, "role") != SPORE_PASSIVE) continue;
    gtk_combo_box_text_append(combo, spore_object_name(body), spore_object_name(body));
  }
  if (!chosen || !gtk_combo_box_set_active_id(GTK_COMBO_BOX(combo), chosen))
    gtk_combo_box_set_active(GTK_COMBO_BOX(combo), 0);
  self->filling = FALSE;
  gtk_widget_set_sensitive(self->levels, spore_accuracy_work_has_levels(document_of(self), chosen_body(self)));
}

static void body_chosen(GtkComboBox *combo, SporeAccuracyPanel *self) {
  if (self->filling || !self->document) return;
  gtk_widget_set_sensitive(self->levels, spore_accuracy_work_has_levels(document_of(self), chosen_body(self)));
}

static SporeAccuracyWork *new_work(SporeAccuracyPanel *self) {
  SporeAccuracyWork *work = spore_accuracy_work_new(document_of(self));
  work->body = g_strdup(chosen_body(self));
  work->levels =
      gtk_widget_get_sensitive(self->levels) && gtk_toggle_button_get_active(GTK_TOGGLE_BUTTON(self->levels));
  work->spheres = gtk_toggle_button_get_active(GTK_TOGGLE_BUTTON(self->spheres));
  work->time_s = gtk_spin_button_get_value(GTK_SPIN_BUTTON(self->time));
  work->full = gtk_toggle_button_get_active(GTK_TOGGLE_BUTTON(self->full));
  choose_methods(self, work->methods);
  return work;
}

/* Showing. */

static void set_text(GtkWidget *label, const char *text) {
  gtk_label_set_text(GTK_LABEL(label), text);
  gtk_widget_set_visible(label, *text != '\0');
}

/* The plot's own signal comes after the document's, so both lead here. */
static void show_point(SporeAccuracyPanel *self) {
  gssize selected = spore_precision_plot_get_selected(plot_of(self));
  const SporeAccuracyStudy *study = study_of(self);
  g_autofree char *text = study && selected >= 0 ? spore_precision_plot_describe(study->report, selected) : NULL;
  set_text(self->point, text ? text : study ? _("Click on a point to see what it is and to apply it") : "");
  g_signal_emit(self, signals[STUDY_CHANGED], 0);
}

/* What depends on the scene as it is now. */
static gboolean compare(gpointer data) {
  SporeAccuracyPanel *self = data;
  self->update = 0;
  fill_bodies(self);
  gboolean holds = spore_editor_document_study_holds(self->document);
  gtk_widget_set_visible(self->stale, study_of(self) && !holds);
  spore_precision_plot_set_current(plot_of(self), holds ? spore_editor_document_get_point(self->document) : -1);
  return G_SOURCE_REMOVE;
}

static void queue(SporeAccuracyPanel *self) {
  if (!self->update) self->update = g_idle_add(compare, self);
}

static void show_study(SporeAccuracyPanel *self) {
  const SporeAccuracyStudy *study = study_of(self);
  spore_precision_plot_set_report(plot_of(self), study ? study->report : NULL);
  gtk_widget_set_visible(self->plot, study != NULL);
  g_autofree char *head = study ? spore_accuracy_describe(study->report) : g_strdup("");
  g_autofree char *tail = study ? spore_accuracy_describe_methods(study->report) : g_strdup("");
  g_autofree char *spheres = study ? spore_accuracy_describe_spheres(study->report) : g_strdup("");
  g_autofree char *details = g_strconcat(head, tail, spheres, NULL);
  set_text(self->details, g_strchomp(details));
  set_text(self->sentence, study ? study->report->sentence
                                 : _("Measure what each method and step costs in this scene, and how wrong it is"));
  show_point(self);
  queue(self);
}

/* The study. */

static void studied(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeAccuracyPanel *self = owner;
  SporeAccuracyWork *work = data;
  if (self->job != job) return; /* of another scene */
  g_clear_object(&self->job);
  spore_job_bar_set_job(SPORE_JOB_BAR(self->job_bar), NULL);
  if (!error) spore_editor_document_take_study(self->document, g_steal_pointer(&work->study));
  else
    set_text(self->sentence, g_error_matches(error, SPORE_ERROR, SPORE_ERROR_CANCELLED)
                                 ? _("Cancelled: nothing was measured")
                                 : error->message);
  g_signal_emit(self, signals[STUDY_CHANGED], 0);
}

void spore_accuracy_measure(SporeAccuracyPanel *self) {
  if (!self->document || self->job) return;
  set_text(self->sentence, _("Running the scene by several methods and steps …"));
  self->job = spore_job_start(_("Accuracy"), spore_accuracy_work_run, new_work(self), spore_accuracy_work_free, studied,
                              G_OBJECT(self));
  spore_job_bar_set_job(SPORE_JOB_BAR(self->job_bar), self->job);
  g_signal_emit(self, signals[STUDY_CHANGED], 0);
}

gboolean spore_accuracy_is_measuring(SporeAccuracyPanel *self) { return self->job != NULL; }

/* What is done with it. */

void spore_accuracy_choose(SporeAccuracyPanel *self, gsize point) {
  spore_precision_plot_select(plot_of(self), (gssize)point);
}

gboolean spore_accuracy_can_apply(SporeAccuracyPanel *self) {
  gssize selected = spore_precision_plot_get_selected(plot_of(self));
  return study_of(self) && selected >= 0 && study_of(self)->report->points[selected].stable;
}

gboolean spore_accuracy_apply(SporeAccuracyPanel *self, GError **error) {
  gssize selected = spore_precision_plot_get_selected(plot_of(self));
  return selected < 0 || spore_accuracy_study_apply(study_of(self), (gsize)selected, document_of(self), error);
}

static void point_activated(SporePrecisionPlot *plot, SporeAccuracyPanel *self) {
  spore_activate(GTK_WIDGET(self), "apply-point", NULL);
}

gboolean spore_accuracy_save(SporeAccuracyPanel *self, const char *file, GError **error) {
  const SporeAccuracyStudy *study = study_of(self);
  g_autofree char *title = self->document ? spore_editor_document_get_title(self->document) : NULL, *text = NULL;
  if (!study)
    return spore_error_raise(error, SPORE_ERROR_INPUT, file, _("nothing was measured yet; measure the scene first"));
  if (g_str_has_suffix(file, ".csv")) text = spore_accuracy_csv(study->report);
  else if (g_str_has_suffix(file, ".svg")) text = spore_accuracy_plot(title, study->report, error);
  else text = spore_accuracy_html(title, study->report, error);
  return text && spore_write_file(file, text, strlen(text), error);
}

/* Life. */

static void release_document(SporeAccuracyPanel *self) {
  g_clear_handle_id(&self->update, g_source_remove);
  if (self->job) spore_job_cancel(self->job);
  g_clear_object(&self->job);
  if (self->document) g_signal_handlers_disconnect_by_data(self->document, self);
  g_clear_object(&self->document);
}

void spore_accuracy_set_document(SporeAccuracyPanel *self, SporeEditorDocument *document) {
  spore_precision_plot_set_report(plot_of(self), NULL); /* the study goes with its document */
  release_document(self);
  spore_job_bar_set_job(SPORE_JOB_BAR(self->job_bar), NULL);
  self->document = g_object_ref(document);
  g_signal_connect_object(document, "changed", G_CALLBACK(queue), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(document, "studied", G_CALLBACK(show_study), self, G_CONNECT_SWAPPED);
  show_study(self);
}

static void spore_accuracy_dispose(GObject *object) {
  SporeAccuracyPanel *self = SPORE_ACCURACY(object);
  if (self->plot) spore_precision_plot_set_report(plot_of(self), NULL);
  release_document(self);
  G_OBJECT_CLASS(spore_accuracy_parent_class)->dispose(object);
}

static void spore_accuracy_class_init(SporeAccuracyPanelClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  GType type = G_TYPE_FROM_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_accuracy_dispose;
  signals[STUDY_CHANGED] = g_signal_new("study-changed", type, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
  g_type_ensure(SPORE_TYPE_JOB_BAR);
  g_type_ensure(SPORE_TYPE_PRECISION_PLOT);
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-accuracy.ui");
  gtk_widget_class_bind_template_child(widget, SporeAccuracyPanel, job_bar);
  gtk_widget_class_bind_template_child(widget, SporeAccuracyPanel, sentence);
  gtk_widget_class_bind_template_child(widget, SporeAccuracyPanel, stale);
  gtk_widget_class_bind_template_child(widget, SporeAccuracyPanel, point);
  gtk_widget_class_bind_template_child(widget, SporeAccuracyPanel, plot);
  gtk_widget_class_bind_template_child(widget, SporeAccuracyPanel, details);
  gtk_widget_class_bind_template_child(widget, SporeAccuracyPanel, body);
  gtk_widget_class_bind_template_child(widget, SporeAccuracyPanel, time);
  gtk_widget_class_bind_template_child(widget, SporeAccuracyPanel, full);
  gtk_widget_class_bind_template_child(widget, SporeAccuracyPanel, levels);
  gtk_widget_class_bind_template_child(widget, SporeAccuracyPanel, spheres);
  gtk_widget_class_bind_template_child(widget, SporeAccuracyPanel, integrators);
  gtk_widget_class_bind_template_child(widget, SporeAccuracyPanel, nonlinear);
  gtk_widget_class_bind_template_child(widget, SporeAccuracyPanel, linear);
  gtk_widget_class_bind_template_callback(widget, body_chosen);
  gtk_widget_class_bind_template_callback(widget, show_point);
  gtk_widget_class_bind_template_callback(widget, point_activated);
}

static void spore_accuracy_init(SporeAccuracyPanel *self) {
  gtk_widget_init_template(GTK_WIDGET(self));
  add_checks(self->integrators, spore_integrator_names, SPORE_INTEGRATOR_STATIC); /* static has no motion to compare */
  add_checks(self->nonlinear, spore_nonlinear_names, G_MAXUINT);
  add_checks(self->linear, spore_linear_names, G_MAXUINT);
  spore_spin_shows_none(self->time);
}
