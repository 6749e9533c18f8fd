/* The panel of a generator at work: options, quality, Apply and Cancel. */
#include "ui/panels/spore-generator-panel.h"

#include <glib/gi18n.h>

#include "core/mesh/common.h"
#include "ui/jobs/generate-types.h"
#include "ui/jobs/spore-series.h"
#include "ui/panels/report.h"
#include "ui/panels/spore-count-plot.h"
#include "ui/panels/spore-generator-rows.h"
#include "ui/panels/spore-label-list.h"
#include "ui/panels/spore-histogram.h"

#define QUALITY_LEAST_CHARS 8
#define QUALITY_CHARS 24
#define APART 0.75 /* gap between cells, as a part of their size */

struct _SporeGeneratorPanel {
  GtkBox parent;
  GtkWidget *empty, *content, *columns, *title, *rows, *shown, *inside, *cut, *axis, *apart, *facts, *apply, *cancel,
      *histogram, *numbers, *measure, *plot, *places, *pick, *automatic, *make, *organs, *labels;
  SporeGenerator *generator;
  SporeSeries *series;
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
  if (!spore_generator_preview(self->generator, body, options, &error)) spore_report(GTK_WIDGET(self), error);
}

static void options_changed(GtkWidget *widget, SporeGeneratorPanel *self) {
  if (!spore_generator_is_active(self->generator)) return;
  SporeGenerateOptions options = *spore_generator_get_options(self->generator);
  spore_generator_rows_get_options(SPORE_GENERATOR_ROWS(self->rows), &options);
  if (options.labels) spore_label_list_get_options(SPORE_LABEL_LIST(self->labels), &options);
  options.listing = options.labels != NULL; /* made when they are all chosen */
  preview(self, &options);
}

static void show_places(SporeGeneratorPanel *self, const SporeGeneratorPlaces *places) {
  gtk_widget_set_visible(self->places, places != NULL);
  if (!places) return;
  gtk_button_set_label(GTK_BUTTON(self->pick), _(places->pick));
  gtk_widget_set_tooltip_text(self->pick, _(places->pick_doc));
  gtk_widget_set_tooltip_text(self->automatic, _(places->automatic_doc));
}

static void show_options(SporeGeneratorPanel *self, const SporeGenerateOptions *options) {
  const SporeGenerateType *type = spore_generate_type(options->kind);
  const SporeParameterTable table = spore_generator_table(spore_generators[options->kind]);
  spore_generator_rows_set_options(SPORE_GENERATOR_ROWS(self->rows), &table, options);
  gtk_widget_set_visible(self->numbers, type->counts != NULL);
  show_places(self, spore_generators[options->kind]->places);
  gtk_widget_set_visible(self->make, options->labels != NULL);
  gtk_widget_set_visible(self->organs, options->chosen); /* known once the map was read */
  if (gtk_widget_get_visible(self->organs)) spore_label_list_set_options(SPORE_LABEL_LIST(self->labels), options);
  if (!type->counts) return;
  gsize last = 0;
  while (type->counts[last + 1]) last++;
  spore_count_plot_set_axes(SPORE_COUNT_PLOT(self->plot), type->counts[0], type->counts[last], _(type->error_label),
                            _(spore_generators[options->kind]->count_label));
  spore_count_plot_set_current(SPORE_COUNT_PLOT(self->plot), spore_generate_get_count(options));
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
  spore_generator_rows_set_count(SPORE_GENERATOR_ROWS(self->rows), count);
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

static void show_result(SporeGeneratorPanel *self) {
  const SporeGenerateWork *work = spore_generator_get_result(self->generator);
  SporeQuality quality = {0};
  if (work) spore_quality_of(work, spore_generator_panel_get_quality(self), &quality);
  const char *refusal = spore_generator_get_refusal(self->generator);
  g_autofree char *facts =
      work ? spore_generators[work->options.kind]->facts(work) : g_strdup(refusal ? refusal : _("Working…"));
  gtk_label_set_text(GTK_LABEL(self->facts), facts);
  gtk_widget_set_visible(self->histogram, !quality.names && !(work && work->options.listing));
  spore_histogram_set_quality(SPORE_HISTOGRAM(self->histogram), &quality);
  spore_quality_clear(&quality);
}

static void quality_chosen(GtkComboBox *combo, SporeGeneratorPanel *self) {
  if (self->filling) return;
  show_result(self);
  g_signal_emit(self, signals[SHOWN_QUALITY_CHANGED], 0);
}

/* The source of the generator: the body, or the file. */
static char *title_of(SporeGeneratorPanel *self, SporeObject *body, const SporeGenerateOptions *options) {
  g_autofree char *base = options->labels ? g_path_get_basename(spore_label_source_file(options->labels)) : NULL;
  return g_strdup_printf(_(spore_generators[options->kind]->title), base ? base : spore_object_name(body));
}

static void refresh(SporeGeneratorPanel *self) {
  SporeObject *body = spore_generator_get_body(self->generator);
  const SporeGenerateOptions *options = spore_generator_get_options(self->generator);
  gboolean active = spore_generator_is_active(self->generator) && (body || options->labels);
  gtk_widget_set_visible(self->empty, !active);
  gtk_widget_set_visible(self->content, active);
  if (!spore_series_is_of(self->series, spore_generator_get_document(self->generator), body, options))
    spore_series_clear(self->series); /* points of another body or other options do not apply */
  if (!active) return;
  g_autofree char *title = title_of(self, body, options);
  gtk_label_set_text(GTK_LABEL(self->title), title);
  gtk_widget_set_tooltip_text(self->title, title);
  gtk_widget_set_visible(self->inside, spore_generate_type(options->kind)->cells);
  self->filling = TRUE;
  fill_qualities(self, options->kind);
  show_result(self); /* hidden before the options, so that the tab of the histogram comes to the front */
  show_options(self, options);
  self->filling = FALSE;
}

static gboolean fit_columns(gpointer data) {
  g_autoptr(SporeGeneratorPanel) self = data;
  spore_box_fit(GTK_BOX(self->columns), gtk_widget_get_allocated_width(self->content));
  return G_SOURCE_REMOVE;
}

static void content_sized(GtkWidget *widget, GdkRectangle *allocation, SporeGeneratorPanel *self) {
  g_idle_add(fit_columns, g_object_ref(self)); /* not during size allocation */
}

static void view_changed(GtkWidget *widget, SporeGeneratorPanel *self) {
  if (!self->filling) g_signal_emit(self, signals[SHOWN_QUALITY_CHANGED], 0);
}

SporeCellView spore_generator_panel_get_view(SporeGeneratorPanel *self, const SporeTetrahedralMesh *mesh) {
  double share = gtk_range_get_value(GTK_RANGE(self->cut)) / 100, lower[3], upper[3], direction[3] = {0, 0, 0};
  int axis = MAX(gtk_combo_box_get_active(GTK_COMBO_BOX(self->axis)), 0);
  SporeCellView view = {.shrink = gtk_toggle_button_get_active(GTK_TOGGLE_BUTTON(self->apart)) ? APART : 1};
  if (!(share > 0) || !mesh->vertex_count) return view;
  spore_mesh_bounds(mesh->vertices, mesh->vertex_count, 3, lower, upper);
  direction[axis] = 1;
  view.direction = spore_vec3_load(direction);
  view.beyond = upper[axis] - share * (upper[axis] - lower[axis]);
  return view;
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
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, columns);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, title);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, rows);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, shown);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, inside);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, cut);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, axis);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, apart);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, facts);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, apply);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, cancel);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, histogram);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, numbers);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, measure);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, plot);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, places);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, pick);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, automatic);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, make);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, organs);
  gtk_widget_class_bind_template_child(widget, SporeGeneratorPanel, labels);
}

static void spore_generator_panel_class_init(SporeGeneratorPanelClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_generator_panel_dispose;
  g_type_ensure(SPORE_TYPE_HISTOGRAM);
  g_type_ensure(SPORE_TYPE_COUNT_PLOT);
  g_type_ensure(SPORE_TYPE_GENERATOR_ROWS);
  g_type_ensure(SPORE_TYPE_LABEL_LIST);
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-generator-panel.ui");
  bind(widget);
  gtk_widget_class_bind_template_callback(widget, content_sized);
  gtk_widget_class_bind_template_callback(widget, options_changed);
  gtk_widget_class_bind_template_callback(widget, quality_chosen);
  gtk_widget_class_bind_template_callback(widget, view_changed);
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
  spore_combo_shrinks(self->shown, QUALITY_LEAST_CHARS, QUALITY_CHARS);
  spore_ignore_wheel(self->shown);
  spore_ignore_wheel(self->cut);
  spore_ignore_wheel(self->axis);
}
