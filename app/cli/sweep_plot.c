/* Plots of a sweep: a curve with its spread, or a map, and a page with both and the table. */
#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "app/cli/sweep_table.h"
#include "core/base/memory.h"
#include "core/base/number.h"
#include "core/measure/plot.h"
#include "core/measure/svg.h"

#define PLOTS_MAXIMUM 24 /* on a page */

/* An axis of a plot: the values that it takes, in order of cases, and which of them each case has. */
typedef struct PlotAxis {
  const char *name; /* NULL: there is none */
  char **values;
  guint count;
  guint *of_case;
} PlotAxis;

/* Of the cases at one place of the axes. */
typedef struct Spread {
  guint count;
  double mean, squares; /* squares: of the differences from the mean, summed */
} Spread;

typedef struct View {
  const SporeSweepTable *table;
  guint quantity;
  PlotAxis axes[2];
} View;

static void view_clear(View *view) {
  for (int slot = 0; slot < 2; slot++) {
    g_strfreev(view->axes[slot].values);
    g_free(view->axes[slot].of_case);
  }
}

static PlotAxis axis_of(const SporeManifest *sweep, int number) {
  g_autoptr(GHashTable) known = g_hash_table_new(g_str_hash, g_str_equal);
  g_autoptr(GStrvBuilder) values = g_strv_builder_new();
  PlotAxis axis = {.name = sweep->axes[number], .of_case = g_new(guint, sweep->cases->len)};
  for (guint i = 0; i < sweep->cases->len; i++) {
    char *value = ((const SporeSweepCase *)g_ptr_array_index(sweep->cases, i))->values[number];
    gpointer found;
    if (!g_hash_table_lookup_extended(known, value, NULL, &found)) {
      found = GUINT_TO_POINTER(axis.count++);
      g_hash_table_insert(known, value, found);
      g_strv_builder_add(values, value);
    }
    axis.of_case[i] = GPOINTER_TO_UINT(found);
  }
  axis.values = g_strv_builder_end(values);
  return axis;
}

static gboolean choose_named(View *view, const char *over, GError **error) {
  const SporeManifest *sweep = view->table->sweep;
  g_auto(GStrv) names = g_strsplit(over, ",", 0);
  guint count = g_strv_length(names);
  if (count > 2)
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--over", _("%u axes; expected one or two; leave some out"),
                             count);
  for (guint i = 0; i < count; i++) {
    int number = spore_sweep_index(sweep->axes, g_strstrip(names[i]));
    if (number >= 0 && (i == 0 || !g_str_equal(view->axes[0].name, names[i]))) {
      view->axes[i] = axis_of(sweep, number);
      continue;
    }
    g_autofree char *all = g_strjoinv(", ", sweep->axes);
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--over",
                             _("\"%s\" is no axis of this sweep, or stands there twice; expected one or two of %s; "
                               "correct it"),
                             names[i], all);
  }
  return TRUE;
}

/* Whether the values of an axis differ between cases. */
static gboolean differs(const SporeManifest *sweep, int number) {
  const SporeSweepCase *first = g_ptr_array_index(sweep->cases, 0);
  for (guint i = 1; i < sweep->cases->len; i++)
    if (!g_str_equal(((const SporeSweepCase *)g_ptr_array_index(sweep->cases, i))->values[number],
                     first->values[number]))
      return TRUE;
  return FALSE;
}

/* The first two axes that differ, repeats apart; the first axis where none does. */
static gboolean choose_axes(View *view, const char *over, GError **error) {
  const SporeManifest *sweep = view->table->sweep;
  if (over) return choose_named(view, over, error);
  int slot = 0;
  for (int a = 0; sweep->axes[a] && slot < 2; a++)
    if (!g_str_equal(sweep->axes[a], "repeat") && differs(sweep, a)) view->axes[slot++] = axis_of(sweep, a);
  if (slot == 0) view->axes[0] = axis_of(sweep, 0);
  return TRUE;
}

static gboolean numbers_of(char **texts, double *numbers) {
  for (guint i = 0; texts[i]; i++) {
    gsize length = strlen(texts[i]);
    if (spore_number_read(texts[i], length, &numbers[i]) != length) return FALSE;
  }
  return TRUE;
}

/* Of all places, row by row along the first axis; g_free. After Welford. */
static Spread *spreads_of(const View *view) {
  const SporeSweepTable *table = view->table;
  const PlotAxis *along = &view->axes[0], *up = &view->axes[1];
  guint columns = g_strv_length(table->quantities);
  Spread *spreads = g_new0(Spread, along->count * MAX(1, up->count));
  for (guint i = 0; i < table->sweep->cases->len; i++) {
    double value = table->values[i * columns + view->quantity];
    if (!isfinite(value)) continue;
    Spread *spread = &spreads[along->of_case[i] + (up->name ? up->of_case[i] * along->count : 0)];
    double off = value - spread->mean;
    spread->mean += off / ++spread->count;
    spread->squares += off * (value - spread->mean);
  }
  return spreads;
}

static char *failure(SporeError *fault, GError **error) {
  spore_error_propagate(fault, error);
  return NULL;
}

static char *taken(char *svg) {
  char *copy = g_strdup(svg);
  spore_free(svg);
  return copy;
}

/* A curve. */

static char *draw_curve(const View *view, const char *title, GError **error) {
  const PlotAxis *axis = &view->axes[0];
  g_autofree Spread *spreads = spreads_of(view);
  g_autofree double *x = g_new(double, axis->count), *mean = g_new(double, axis->count),
                    *low = g_new(double, axis->count), *high = g_new(double, axis->count);
  gboolean numeric = numbers_of(axis->values, x);
  double least = HUGE_VAL, most = -HUGE_VAL;
  GString *note = g_string_new(_("Means of all cases there; bars: one standard deviation."));
  for (guint i = 0; i < axis->count; i++) {
    const Spread *spread = &spreads[i];
    double deviation = spread->count > 1 ? sqrt(spread->squares / (spread->count - 1)) : 0;
    if (!numeric) x[i] = i + 1;
    if (!numeric && i < 8) g_string_append_printf(note, "%s%u: %s", i == 0 ? "\n" : ", ", i + 1, axis->values[i]);
    mean[i] = spread->count > 0 ? spread->mean : NAN;
    low[i] = mean[i] - deviation, high[i] = mean[i] + deviation;
    least = fmin(least, x[i]), most = fmax(most, x[i]);
  }
  SporeError fault = SPORE_ERROR_INIT;
  const SporePlotLine line = {.label = _("mean"), .count = axis->count, .x = x, .y = mean, .low = low, .high = high};
  const SporePlotPanel panel = {.x_label = axis->name,
                                .y_label = view->table->quantities[view->quantity],
                                .log_x = numeric && least > 0 && most > 50 * least,
                                .lines = &line,
                                .line_count = 1};
  char *svg = spore_plot_svg(title, note->str, &panel, 1, &fault);
  g_string_free(note, TRUE);
  return svg ? taken(svg) : failure(&fault, error);
}

/* A map. */

/* Pixels. */
#define CELL_WIDTH 84.
#define CELL_HEIGHT 40.
#define LEFT 170.
#define TOP 64.
#define RIGHT 30.
#define BELOW 86.
#define CELLS_MAXIMUM 40 /* along an axis */

/* Dark is much; the number stands in the cell, so that shades are not all there is to go by. */
static void draw_cell(SporeTextBuffer *svg, double x, double y, const Spread *spread, double least, double most) {
  double part = spread->count > 0 && most > least ? (spread->mean - least) / (most - least) : 0;
  int shade = (int)(110 * part);
  g_autofree char *fill =
      g_strdup_printf(" fill=\"#%02x%02x%02x\" stroke=\"#888888\"", 250 - shade * 3 / 2, 250 - shade, 255 - shade / 4);
  char digits[SPORE_NUMBER_TEXT] = "?";
  if (spread->count > 0) spore_number_format_rounded(spread->mean, 4, digits);
  spore_svg_rectangle(svg, x, y, CELL_WIDTH, CELL_HEIGHT, fill);
  spore_svg_text(svg, x + CELL_WIDTH / 2, y + CELL_HEIGHT / 2 + 4, " text-anchor=\"middle\"", digits);
}

static void draw_labels(SporeTextBuffer *svg, const View *view, guint columns, guint rows) {
  double bottom = TOP + CELL_HEIGHT * rows;
  for (guint c = 0; c < columns; c++)
    spore_svg_text(svg, LEFT + CELL_WIDTH * (c + 0.5), bottom + 18, " text-anchor=\"middle\" font-size=\"11\"",
                   view->axes[0].values[c]);
  for (guint r = 0; r < rows; r++)
    spore_svg_text(svg, LEFT - 8, bottom - CELL_HEIGHT * (r + 0.5) + 4, " text-anchor=\"end\" font-size=\"11\"",
                   view->axes[1].values[r]);
  spore_svg_text(svg, LEFT + CELL_WIDTH * columns / 2, bottom + 42, " text-anchor=\"middle\"", view->axes[0].name);
  spore_svg_text(svg, 8, TOP - 10, "", view->axes[1].name);
  spore_svg_text(svg, LEFT, bottom + 68, " fill=\"#444444\"", _("Means of all cases there; ?: no result."));
}

static char *draw_map(const View *view, const char *title, GError **error) {
  const PlotAxis *along = &view->axes[0], *up = &view->axes[1];
  guint columns = MIN(CELLS_MAXIMUM, along->count), rows = MIN(CELLS_MAXIMUM, up->count);
  g_autofree Spread *spreads = spreads_of(view);
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (guint r = 0; r < rows; r++)
    for (guint c = 0; c < columns; c++) {
      const Spread *spread = &spreads[r * along->count + c];
      if (spread->count > 0) least = fmin(least, spread->mean), most = fmax(most, spread->mean);
    }
  SporeTextBuffer svg = {0};
  spore_svg_open(&svg, title, LEFT + CELL_WIDTH * columns + RIGHT, TOP + CELL_HEIGHT * rows + BELOW);
  for (guint r = 0; r < rows; r++)
    for (guint c = 0; c < columns; c++)
      draw_cell(&svg, LEFT + CELL_WIDTH * c, TOP + CELL_HEIGHT * (rows - 1 - r), &spreads[r * along->count + c], least,
                most);
  draw_labels(&svg, view, columns, rows);
  spore_text_add(&svg, "</svg>\n");
  if (!svg.failed) return taken(svg.bytes);
  spore_free(svg.bytes);
  spore_error_raise(error, SPORE_ERROR_MEMORY, NULL,
                    _("there is not enough memory for a plot; close other programs and try again"));
  return NULL;
}

char *spore_sweep_svg(const SporeSweepTable *table, guint quantity, const char *over, GError **error) {
  View view = {.table = table, .quantity = quantity};
  g_autofree char *name = g_path_get_basename(table->sweep->file),
                  *title = g_strdup_printf("%s: %s", name, table->quantities[quantity]), *svg = NULL;
  if (choose_axes(&view, over, error))
    svg = view.axes[1].name ? draw_map(&view, title, error) : draw_curve(&view, title, error);
  view_clear(&view);
  return g_steal_pointer(&svg);
}

/* The page. */

static const char head[] =
    "<!DOCTYPE html>\n<html><head><meta charset=\"utf-8\"><meta http-equiv=\"Content-Security-Policy\" "
    "content=\"default-src 'none'; style-src 'unsafe-inline'; img-src data:\">\n<title>%s</title>\n<style>body "
    "{ font-family: sans-serif; margin: 2em; } table { border-collapse: collapse; } td, th { border: 1px solid #bbb; "
    "padding: .2em .6em; text-align: right; } div { overflow-x: auto; }</style></head><body>\n<h1>%s</h1>\n";

static void add_row(GString *page, const char *line, const char *cell) {
  g_auto(GStrv) fields = g_strsplit(line, ",", 0);
  g_string_append(page, "<tr>");
  for (char **field = fields; *field; field++) {
    g_autofree char *text = g_markup_escape_text(*field, -1);
    g_string_append_printf(page, "<%s>%s</%s>", cell, text, cell);
  }
  g_string_append(page, "</tr>\n");
}

static void add_missing(GString *page, const SporeSweepTable *table) {
  for (guint i = 0; i < table->sweep->cases->len; i++) {
    const SporeSweepResult *result = table->results[i];
    if (result && !spore_sweep_result_failed(result)) continue;
    g_autofree char *said = g_markup_escape_text(result && result->said ? result->said : "", -1);
    if (result)
      g_string_append_printf(page, _("<p>case %u failed with status %d: %s</p>\n"), i, (int)result->status, said);
    else g_string_append_printf(page, _("<p>case %u has no result yet</p>\n"), i);
  }
}

char *spore_sweep_html(const SporeSweepTable *table, const char *over, GError **error) {
  g_autofree char *name = g_path_get_basename(table->sweep->file), *title = g_markup_escape_text(name, -1),
                  *csv = spore_sweep_csv(table);
  GString *page = g_string_new(NULL);
  g_string_append_printf(page, head, title, title);
  add_missing(page, table);
  for (guint k = 0; table->quantities[k] && k < PLOTS_MAXIMUM; k++) {
    g_autoptr(GError) fault = NULL;
    g_autofree char *svg = spore_sweep_svg(table, k, over, &fault);
    if (!svg && g_error_matches(fault, SPORE_ERROR, SPORE_ERROR_MEMORY)) {
      g_propagate_error(error, g_steal_pointer(&fault));
      g_string_free(page, TRUE);
      return NULL;
    }
    const char *from = svg ? strstr(svg, "<svg") : NULL;
    if (from) g_string_append(page, from);
  }
  g_auto(GStrv) lines = g_strsplit(csv, "\n", 0);
  g_string_append(page, "<div><table>\n");
  for (guint i = 0; lines[i] && *lines[i]; i++) add_row(page, lines[i], i == 0 ? "th" : "td");
  g_string_append(page, "</table></div>\n</body></html>\n");
  return g_string_free(page, FALSE);
}
