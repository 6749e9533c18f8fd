/* The rows of a generator's options, made from its table. */
#include "ui/panels/spore-generator-rows.h"

#include <glib/gi18n.h>
#include <math.h>

#include "ui/jobs/generate-types.h"
#include "ui/panels/report.h"

#define MOST_SHOWN 1e9
#define CHOICE_LEAST_CHARS 5
#define CHOICE_CHARS 20
#define DIGITS 2          /* after the point */
#define ROUNDED 0.5001e-2 /* a smaller difference looks the same, and is no change */

typedef struct {
  const SporeParameter *parameter;
  GtkWidget *editor;
  double scale; /* shown / value: lengths are shown in mm, shares in % */
} Row;

struct _SporeGeneratorRows {
  GtkGrid parent;
  int kind; /* that the rows are for, -1: none yet */
  GArray *rows;
  gboolean filling;
};

G_DEFINE_FINAL_TYPE(SporeGeneratorRows, spore_generator_rows, GTK_TYPE_GRID)

enum { CHANGED, SIGNAL_COUNT };
static guint signals[SIGNAL_COUNT];

static void tell(SporeGeneratorRows *self) {
  if (!self->filling) g_signal_emit(self, signals[CHANGED], 0);
}

/* Making. */

static GtkWidget *new_number(const SporeParameter *parameter, double scale) {
  gboolean whole = parameter->type == SPORE_INTEGER;
  double least = MAX(parameter->minimum * scale, -MOST_SHOWN), most = MIN(parameter->maximum * scale, MOST_SHOWN);
  double step = whole ? 10 : scale > 1 ? 0.5 : 5;
  GtkWidget *spin = gtk_spin_button_new_with_range(least, most, step);
  gtk_spin_button_set_digits(GTK_SPIN_BUTTON(spin), whole ? 0 : DIGITS);
  gtk_spin_button_set_increments(GTK_SPIN_BUTTON(spin), step, 10 * step);
  if (least == 0) spore_spin_shows_none(spin);
  gtk_spin_button_set_numeric(GTK_SPIN_BUTTON(spin), TRUE);
  gtk_entry_set_width_chars(GTK_ENTRY(spin), 5);
  gtk_entry_set_max_width_chars(GTK_ENTRY(spin), 5);
  return spin;
}

static GtkWidget *new_choice(const SporeParameter *parameter) {
  GtkWidget *combo = gtk_combo_box_text_new();
  spore_combo_shrinks(combo, CHOICE_LEAST_CHARS, CHOICE_CHARS);
  for (const char *const *choice = parameter->choices; *choice; choice++) {
    g_autofree char *label = spore_choice_label(*choice);
    gtk_combo_box_text_append_text(GTK_COMBO_BOX_TEXT(combo), label);
  }
  return combo;
}

static GtkWidget *new_editor(SporeGeneratorRows *self, const SporeParameter *parameter, double scale) {
  GtkWidget *editor = NULL;
  const char *signal = "changed";
  if (parameter->type == SPORE_CHOICE) editor = new_choice(parameter);
  if (parameter->type == SPORE_BOOLEAN) editor = gtk_check_button_new(), signal = "toggled";
  if (parameter->type == SPORE_INTEGER || parameter->type == SPORE_REAL)
    editor = new_number(parameter, scale), signal = "value-changed";
  if (!editor) return NULL;
  g_signal_connect_swapped(editor, signal, G_CALLBACK(tell), self);
  spore_ignore_wheel(editor);
  return editor;
}

static void add_row(SporeGeneratorRows *self, const SporeParameter *parameter, const char *text) {
  gboolean share = parameter->type == SPORE_REAL && *parameter->unit == '\0';
  Row row = {.parameter = parameter, .scale = share ? 100 : spore_unit_scale(parameter->unit)};
  row.editor = new_editor(self, parameter, row.scale);
  if (!row.editor) return; /* places are picked in the view */
  g_autofree char *plain = text ? g_strdup(text) : spore_label_of(parameter->name);
  g_autofree char *unit = share ? g_strdup("%") : spore_unit_label(parameter->unit);
  g_autofree char *labelled = *unit ? g_strdup_printf("%s, %s", plain, unit) : g_strdup(plain);
  GtkWidget *label = gtk_label_new(labelled);
  gtk_label_set_xalign(GTK_LABEL(label), 0);
  gtk_label_set_ellipsize(GTK_LABEL(label), PANGO_ELLIPSIZE_END);
  gtk_widget_set_hexpand(label, TRUE);
  gtk_label_set_mnemonic_widget(GTK_LABEL(label), row.editor);
  gtk_widget_set_tooltip_text(label, _(parameter->doc));
  gtk_widget_set_tooltip_text(row.editor, _(parameter->doc));
  atk_object_set_name(gtk_widget_get_accessible(row.editor), labelled);
  int place = (int)self->rows->len;
  gtk_grid_attach(GTK_GRID(self), label, 0, place, 1, 1);
  gtk_grid_attach(GTK_GRID(self), row.editor, 1, place, 1, 1);
  g_array_append_val(self->rows, row);
}

static void destroy_child(GtkWidget *child, gpointer data) { gtk_widget_destroy(child); }

static void build(SporeGeneratorRows *self, const SporeParameterTable *table, SporeGenerateKind kind) {
  gtk_container_foreach(GTK_CONTAINER(self), destroy_child, NULL);
  g_array_set_size(self->rows, 0);
  self->kind = (int)kind;
  for (size_t i = 0; i < table->count; i++) {
    const SporeParameter *parameter = &table->parameters[i];
    if (spore_generator_takes(spore_generators[kind], parameter))
      add_row(self, parameter,
              g_strcmp0(parameter->name, spore_generators[kind]->count) == 0 ? _(spore_generators[kind]->count_label)
                                                                             : NULL);
  }
  if (spore_generators[kind]->purpose) add_row(self, spore_generators[kind]->purpose, NULL);
  gtk_widget_show_all(GTK_WIDGET(self));
}

/* Values. */

/* The structure that the parameter is a field of. */
static void *place_of(SporeGeneratorRows *self, const Row *row, SporeGenerateOptions *options) {
  gboolean purpose = row->parameter == spore_generators[(SporeGenerateKind)self->kind]->purpose;
  return purpose ? (void *)&options->purpose : (void *)&options->fields;
}

static void show_value(const Row *row, double value) {
  if (GTK_IS_COMBO_BOX(row->editor)) {
    gtk_combo_box_set_active(GTK_COMBO_BOX(row->editor), (int)value);
  } else if (GTK_IS_TOGGLE_BUTTON(row->editor)) {
    gtk_toggle_button_set_active(GTK_TOGGLE_BUTTON(row->editor), value != 0);
  } else if (gtk_spin_button_get_value(GTK_SPIN_BUTTON(row->editor)) != value * row->scale) {
    gtk_spin_button_set_value(GTK_SPIN_BUTTON(row->editor), value * row->scale);
  }
}

static double value_of(const Row *row) {
  if (GTK_IS_COMBO_BOX(row->editor)) return MAX(gtk_combo_box_get_active(GTK_COMBO_BOX(row->editor)), 0);
  if (GTK_IS_TOGGLE_BUTTON(row->editor)) return gtk_toggle_button_get_active(GTK_TOGGLE_BUTTON(row->editor));
  return gtk_spin_button_get_value(GTK_SPIN_BUTTON(row->editor)) / row->scale;
}

void spore_generator_rows_set_options(SporeGeneratorRows *self, const SporeParameterTable *table,
                                      const SporeGenerateOptions *options) {
  SporeGenerateOptions copy = *options;
  self->filling = TRUE;
  if (self->kind != (int)options->kind) build(self, table, options->kind);
  for (guint i = 0; i < self->rows->len; i++) {
    const Row *row = &g_array_index(self->rows, Row, i);
    show_value(row, spore_parameter_load(row->parameter, place_of(self, row, &copy)).number[0]);
  }
  self->filling = FALSE;
}

void spore_generator_rows_get_options(SporeGeneratorRows *self, SporeGenerateOptions *options) {
  for (guint i = 0; i < self->rows->len; i++) {
    const Row *row = &g_array_index(self->rows, Row, i);
    SporeValue before = spore_parameter_load(row->parameter, place_of(self, row, options));
    SporeValue value = {.type = row->parameter->type, .number = {value_of(row)}};
    if (fabs(value.number[0] - before.number[0]) * row->scale <= ROUNDED) continue;
    spore_parameter_store(row->parameter, &value, place_of(self, row, options));
  }
}

void spore_generator_rows_set_count(SporeGeneratorRows *self, guint count) {
  const char *name = spore_generators[(SporeGenerateKind)self->kind]->count;
  for (guint i = 0; i < self->rows->len; i++) {
    const Row *row = &g_array_index(self->rows, Row, i);
    if (g_strcmp0(row->parameter->name, name) == 0) gtk_spin_button_set_value(GTK_SPIN_BUTTON(row->editor), count);
  }
}

/* Life. */

static void spore_generator_rows_finalize(GObject *object) {
  g_array_unref(SPORE_GENERATOR_ROWS(object)->rows);
  G_OBJECT_CLASS(spore_generator_rows_parent_class)->finalize(object);
}

static void spore_generator_rows_class_init(SporeGeneratorRowsClass *class) {
  G_OBJECT_CLASS(class)->finalize = spore_generator_rows_finalize;
  signals[CHANGED] =
      g_signal_new("changed", G_TYPE_FROM_CLASS(class), G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
}

static void spore_generator_rows_init(SporeGeneratorRows *self) {
  self->kind = -1;
  self->rows = g_array_new(FALSE, FALSE, sizeof(Row));
  gtk_grid_set_row_spacing(GTK_GRID(self), 4);
  gtk_grid_set_column_spacing(GTK_GRID(self), 6);
}
