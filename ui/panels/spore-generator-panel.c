#include "ui/panels/spore-generator-panel.h"

#include <glib/gi18n.h>

#include "ui/jobs/quality.h"
#include "ui/jobs/spore-series.h"
#include "ui/panels/report.h"
#include "ui/panels/spore-count-plot.h"
#include "ui/panels/spore-histogram.h"

struct _SporeGeneratorPanel {
  GtkBox parent;
  GtkWidget *empty, *content, *title, *count_label, *count, *mode, *shown, *facts, *apply, *cancel, *histogram,
      *numbers, *measure, *plot;
  SporeGenerator *generator;
  SporeSeries *series;
  guint32 body; /* that the series is of */
  gboolean filling;
  int kind; /* that the lists are filled for, -1: none yet */
};

G_DEFINE_FINAL_TYPE(SporeGeneratorPanel, spore_generator_panel, GTK_TYPE_BOX)

enum { SHOWN_QUALITY_CHANGED, SIGNAL_COUNT };
static guint signals[SIGNAL_COUNT];

/* Options. */

static void preview(SporeGeneratorPanel *self, const SporeGenerateOptions *options) {
  g_autoptr(GError) error = NULL;
  SporeObject *body = spore_generator_get_body(self->generator);
  if (body && !spore_generator_preview(self->generator, body, options, &error)) spore_report(GTK_WIDGET(self), error);
}

static void options_changed(GtkWidget *widget, SporeGeneratorPanel *self) {
  if (self->filling || !spore_generator_is_active(self->generator)) return;
  SporeGenerateOptions options = *spore_generator_get_options(self->generator);
  size_t count = (size_t)gtk_spin_button_get_value_as_int(GTK_SPIN_BUTTON(self->count));
  if (options.kind == SPORE_GENERATE_SPHERES) {
    options.spheres.count = count;
    options.spheres.mode = (SporeSpheresMode)MAX(gtk_combo_box_get_active(GTK_COMBO_BOX(self->mode)), 0);
  } else {
    options.tetrahedra.cells = count;
  }
  preview(self, &options);
}

static void show_options(SporeGeneratorPanel *self, const SporeGenerateOptions *options) {
  gboolean spheres = options->kind == SPORE_GENERATE_SPHERES;
  double count = (double)(spheres ? options->spheres.count : options->tetrahedra.cells);
  gtk_spin_button_set_range(GTK_SPIN_BUTTON(self->count), 1, spheres ? SPORE_SPHERES_MAXIMUM : 1e6);
  if (gtk_spin_button_get_value(GTK_SPIN_BUTTON(self->count)) != count)
    gtk_spin_button_set_value(GTK_SPIN_BUTTON(self->count), count);
  gtk_label_set_text(GTK_LABEL(self->count_label), spheres ? _("Spheres") : _("Tetrahedra"));
  gtk_widget_set_visible(self->mode, spheres);
  gtk_widget_set_visible(self->numbers, spheres);
  spore_count_plot_set_current(SPORE_COUNT_PLOT(self->plot), options->spheres.count);
  gtk_combo_box_set_active(GTK_COMBO_BOX(self->mode), (int)options->spheres.mode);
}

/* Numbers. */

static void show_series(SporeGeneratorPanel *self) {
  size_t counts[SPORE_SERIES_POINTS];
  double errors[SPORE_SERIES_POINTS];
  gsize count = spore_series_get_points(self->series, counts, errors);
  spore_count_plot_set_points(SPORE_COUNT_PLOT(self->plot), counts, errors, count,
                              spore_series_get_enough(self->series));
  gtk_button_set_label(GTK_BUTTON(self->measure),
                       spore_series_is_running(self->series) ? _("Stop measuring") : _("Measure numbers"));
}

static void measure_clicked(GtkButton *button, SporeGeneratorPanel *self) {
  g_autoptr(GError) error = NULL;
  SporeObject *body = spore_generator_get_body(self->generator);
  if (spore_series_is_running(self->series)) spore_series_stop(self->series);
  else if (body && !spore_series_start(self->series, spore_generator_get_document(self->generator), body,
                                       spore_generator_get_options(self->generator), &error))
    spore_report(GTK_WIDGET(self), error);
}

static void count_chosen(SporeCountPlot *plot, guint count, SporeGeneratorPanel *self) {
  gtk_spin_button_set_value(GTK_SPIN_BUTTON(self->count), count);
}

/* Of another body, or of none, they say nothing. */
static void follow_body(SporeGeneratorPanel *self, SporeObject *body) {
  guint32 id = body ? spore_object_id(body) : 0;
  if (id != self->body) spore_series_clear(self->series);
  self->body = id;
}

/* Result. */

static void fill_qualities(SporeGeneratorPanel *self, SporeGenerateKind kind) {
  if (self->kind == (int)kind) return;
  self->kind = (int)kind;
  gtk_combo_box_text_remove_all(GTK_COMBO_BOX_TEXT(self->shown));
  for (gsize i = 0; i < spore_quality_count(kind); i++)
    gtk_combo_box_text_append_text(GTK_COMBO_BOX_TEXT(self->shown), spore_quality_label(kind, i));
  gtk_combo_box_set_active(GTK_COMBO_BOX(self->shown), 0);
}

static char *facts_of(const SporeGenerateWork *work) {
  const SporeSpheresReport *spheres = &work->spheres_report;
  const SporeTetrahedraReport *tetrahedra = &work->tetrahedra_report;
  if (work->options.kind == SPORE_GENERATE_SPHERES)
    return g_strdup_printf(_("%zu spheres in %.1f s\nCoverage %.1f %%, outside %.1f %%\n"
                             "Depth error %.1f %%, distance %.2f %%"),
                           work->spheres.count, spheres->seconds, 100 * spheres->coverage, 100 * spheres->outside,
                           100 * spheres->depth_error, 100 * spheres->distance_mean);
  return g_strdup_printf(_("%zu tetrahedra in %.1f s\nLeast angle %.1f°, mean %.1f°\nError %.2f %%"),
                         work->tetrahedra.tetrahedron_count, tetrahedra->seconds, tetrahedra->quality.min_dihedral_deg,
                         tetrahedra->quality.mean_dihedral_deg, 100 * tetrahedra->hausdorff);
}

static void show_result(SporeGeneratorPanel *self) {
  const SporeGenerateWork *work = spore_generator_get_result(self->generator);
  SporeQuality quality = {0};
  if (work) spore_quality_of(work, spore_generator_panel_get_quality(self), &quality);
  g_autofree char *facts = work ? facts_of(work) : g_strdup(_("Working…"));
  gtk_label_set_text(GTK_LABEL(self->facts), facts);
  spore_histogram_set_quality(SPORE_HISTOGRAM(self->histogram), &quality);
  spore_quality_clear(&quality);
}

static void quality_chosen(GtkComboBox *combo, SporeGeneratorPanel *self) {
  if (self->filling) return;
  show_result(self);
  g_signal_emit(self, signals[SHOWN_QUALITY_CHANGED], 0);
}

static void refresh(SporeGeneratorPanel *self) {
  SporeObject *body = spore_generator_get_body(self->generator);
  gtk_widget_set_visible(self->empty, !body);
  gtk_widget_set_visible(self->content, body != NULL);
  follow_body(self, body);
  if (!body) return;
  const SporeGenerateOptions *options = spore_generator_get_options(self->generator);
  g_autofree char *title = g_strdup_printf(
      options->kind == SPORE_GENERATE_SPHERES ? _("Spheres of %s") : _("Tetrahedra of %s"), spore_object_name(body));
  gtk_label_set_text(GTK_LABEL(self->title), title);
  self->filling = TRUE;
  fill_qualities(self, options->kind);
  show_options(self, options);
  self->filling = FALSE;
  show_result(self);
}

gsize spore_generator_panel_get_quality(SporeGeneratorPanel *self) {
  return (gsize)MAX(gtk_combo_box_get_active(GTK_COMBO_BOX(self->shown)), 0);
}

void spore_generator_panel_set_generator(SporeGeneratorPanel *self, SporeGenerator *generator) {
  if (self->generator) g_signal_handlers_disconnect_by_data(self->generator, self);
  g_set_object(&self->generator, generator);
  if (!generator) return;
  g_signal_connect_object(generator, "changed", G_CALLBACK(refresh), self, G_CONNECT_SWAPPED);
  refresh(self);
}

/* Life. */

/* Widgets named in the template cannot be filled there with what other tables say. */
static void fill_modes(SporeGeneratorPanel *self) {
  for (int i = 0; i < SPORE_SPHERES_MODE_COUNT; i++) {
    g_autofree char *label = spore_choice_label(spore_spheres_mode_names[i]);
    gtk_combo_box_text_append_text(GTK_COMBO_BOX_TEXT(self->mode), label);
  }
}

static void spore_generator_panel_dispose(GObject *object) {
  SporeGeneratorPanel *self = SPORE_GENERATOR_PANEL(object);
  spore_generator_panel_set_generator(self, NULL);
  if (self->series) g_signal_handlers_disconnect_by_data(self->series, self);
  if (self->series) spore_series_stop(self->series);
  g_clear_object(&self->series);
  G_OBJECT_CLASS(spore_generator_panel_parent_class)->dispose(object);
}

static void bind(GtkWidgetClass *widget) {
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, empty);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, content);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, title);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, count_label);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, count);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, mode);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, shown);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, facts);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, apply);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, cancel);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, histogram);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, numbers);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, measure);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, plot);
}

static void spore_generator_panel_class_init(SporeGeneratorPanelClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_generator_panel_dispose;
  g_type_ensure(SPORE_TYPE_HISTOGRAM);
  g_type_ensure(SPORE_TYPE_COUNT_PLOT);
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-generator-panel.ui");
  bind(widget);
  gtk_widget_class_bind_template_callback(widget, options_changed);
  gtk_widget_class_bind_template_callback(widget, quality_chosen);
  gtk_widget_class_bind_template_callback(widget, measure_clicked);
  gtk_widget_class_bind_template_callback(widget, count_chosen);
  signals[SHOWN_QUALITY_CHANGED] = g_signal_new("shown-quality-changed", G_TYPE_FROM_CLASS(class), G_SIGNAL_RUN_LAST, 0,
                                                NULL, NULL, NULL, G_TYPE_NONE, 0);
}

static void spore_generator_panel_init(SporeGeneratorPanel *self) {
  self->kind = -1;
  self->series = spore_series_new();
  g_signal_connect_object(self->series, "changed", G_CALLBACK(show_series), self, G_CONNECT_SWAPPED);
  gtk_widget_init_template(GTK_WIDGET(self));
  spore_ignore_wheel(self->count);
  spore_ignore_wheel(self->mode);
  spore_ignore_wheel(self->shown);
  fill_modes(self);
}
