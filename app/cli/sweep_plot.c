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

/* The axes of a plot. */
typedef struct View {
  const SporeSweepTable *table;
  guint quantity;
  int axis[2];      /* -1: none */
  char **values[2]; /* that the axis takes, in order of cases */
} View;

static void view_clear(View *view) {
  g_strfreev(view->values[0]);
  g_strfreev(view->values[1]);
}

/* Values of an axis, each once. */
static char **values_of(const SporeManifest *sweep, int axis) {
  g_autoptr(GPtrArray) values = g_ptr_array_new();
  for (guint i = 0; i < sweep->cases->len; i++) {
    const SporeSweepCase *one = g_ptr_array_index(sweep->cases, i);
    if (!g_ptr_array_find_with_equal_func(values, one->values[axis], g_str_equal, NULL))
      g_ptr_array_add(values, g_strdup(one->values[axis]));
  }
  g_ptr_array_add(values, NULL);
  return (char **)g_ptr_array_steal(values, NULL);
}

static gboolean choose_axis(View *view, int slot, int axis) {
  view->axis[slot] = axis;
  view->values[slot] = values_of(view->table->sweep, axis);
  return TRUE;
}

static gboolean choose_named(View *view, const char *over, GError **error) {
  char **axes = view->table->sweep->axes;
  g_auto(GStrv) names = g_strsplit(over, ",", 0);
  guint count = g_strv_length(names);
  for (guint i = 0; i < MIN(2, count); i++) {
    int axis = spore_sweep_index(axes, g_strstrip(names[i]));
    if (axis >= 0 && axis != view->axis[0] && choose_axis(view, (int)i, axis)) continue;
    g_autofree char *all = g_strjoinv(", ", axes);
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--over",
                             _("\"%s\" is no axis of this sweep, or stands there twice; expected one or two of %s; "
                               "correct it"),
                             names[i], all);
  }
  if (count <= 2) return TRUE;
  return spore_error_raise(error, SPORE_ERROR_INPUT, "--over", _("%u axes; expected one or two; leave some out"),
                           count);
}

/* The first two axes that differ, repeats apart; the first axis where none does. */
static gboolean choose_axes(View *view, const char *over, GError **error) {
  view->axis[0] = view->axis[1] = -1;
  if (over) return choose_named(view, over, error);
  char **axes = view->table->sweep->axes;
  int slot = 0;
  for (int a = 0; axes[a] && slot < 2; a++) {
    g_auto(GStrv) values = values_of(view->table->sweep, a);
    if (g_strv_length(values) > 1 && !g_str_equal(axes[a], "repeat") && choose_axis(view, slot, a)) slot++;
  }
  return slot > 0 || choose_axis(view, 0, 0);
}

static gboolean numbers_of(char **texts, double *numbers) {
  for (guint i = 0; texts[i]; i++) {
    gsize length = strlen(texts[i]);
    if (spore_number_read(texts[i], length, &numbers[i]) != length) return FALSE;
  }
  return TRUE;
}

/* Of the cases at one place of the axes. */
typedef struct Spread {
  guint count;
  double mean, deviation, least, most;
} Spread;

/* row < 0: there is but one axis. */
static Spread spread_at(const View *view, guint column, int row) {
  const SporeSweepTable *table = view->table;
  guint columns = g_strv_length(table->quantities);
  Spread spread = {.least = HUGE_VAL, .most = -HUGE_VAL};
  double squares = 0;
  for (guint i = 0; i < table->sweep->cases->len; i++) {
    const SporeSweepCase *one = g_ptr_array_index(table->sweep->cases, i);
    double value = table->values[i * columns + view->quantity];
    if (!isfinite(value) || !g_str_equal(one->values[view->axis[0]], view->values[0][column]) ||
        (row >= 0 && !g_str_equal(one->values[view->axis[1]], view->values[1][row])))
      continue;
    spread.count++;
    double off = value - spread.mean; /* Welford */
    spread.mean += off / spread.count;
    squares += off * (value - spread.mean);
    spread.least = fmin(spread.least, value), spread.most = fmax(spread.most, value);
  }
  spread.deviation = spread.count > 1 ? sqrt(squares / (spread.count - 1)) : 0;
  if (spread.count == 0) spread = (Spread){0, NAN, NAN, NAN, NAN};
  return spread;
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
  guint count = g_strv_length(view->values[0]);
  g_autofree double *x = g_new(double, count), *mean = g_new(double, count), *low = g_new(double, count),
                    *high = g_new(double, count);
  gboolean numeric = numbers_of(view->values[0], x), wide = TRUE;
  GString *note = g_string_new(_("Means of all cases there; bars: one standard deviation."));
  for (guint i = 0; i < count; i++) {
    Spread spread = spread_at(view, i, -1);
    if (!numeric) x[i] = i + 1;
    if (!numeric && i < 8) g_string_append_printf(note, "%s%u: %s", i == 0 ? "\n" : ", ", i + 1, view->values[0][i]);
    mean[i] = spread.mean, low[i] = spread.mean - spread.deviation, high[i] = spread.mean + spread.deviation;
    wide = wide && x[i] > 0;
  }
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (guint i = 0; i < count; i++) least = fmin(least, x[i]), most = fmax(most, x[i]);
  SporeError fault = SPORE_ERROR_INIT;
  const SporePlotLine line = {.label = _("mean"), .count = count, .x = x, .y = mean, .low = low, .high = high};
  const SporePlotPanel panel = {.x_label = view->table->sweep->axes[view->axis[0]],
                                .y_label = view->table->quantities[view->quantity],
                                .log_x = numeric && wide && most > 50 * least,
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

static void format_short(double value, char text[SPORE_NUMBER_TEXT]) {
  double unit = value != 0 ? pow(10, floor(log10(fabs(value))) - 3) : 1;
  text[spore_number_format(unit < 1 ? round(value / unit) / round(1 / unit) : round(value / unit) * unit, text)] = '\0';
}

/* Dark is much; the number stands in the cell, so that shades are not all there is to go by. */
static void draw_cell(SporeTextBuffer *svg, double x, double y, Spread spread, double least, double most) {
  double part = most > least ? (spread.mean - least) / (most - least) : 0;
  int shade = (int)(110 * part);
  g_autofree char *fill =
      g_strdup_printf(" fill=\"#%02x%02x%02x\" stroke=\"#888888\"", 250 - shade * 3 / 2, 250 - shade, 255 - shade / 4);
  char digits[SPORE_NUMBER_TEXT] = "?";
  if (spread.count > 0) format_short(spread.mean, digits);
  spore_svg_rectangle(svg, x, y, CELL_WIDTH, CELL_HEIGHT, fill);
  spore_svg_text(svg, x + CELL_WIDTH / 2, y + CELL_HEIGHT / 2 + 4, " text-anchor=\"middle\"", digits);
}

static void draw_labels(SporeTextBuffer *svg, const View *view, guint columns, guint rows) {
  double bottom = TOP + CELL_HEIGHT * rows;
  for (guint c = 0; c < columns; c++)
    spore_svg_text(svg, LEFT + CELL_WIDTH * (c + 0.5), bottom + 18, " text-anchor=\"middle\" font-size=\"11\"",
                   view->values[0][c]);
  for (guint r = 0; r < rows; r++)
    spore_svg_text(svg, LEFT - 8, bottom - CELL_HEIGHT * (r + 0.5) + 4, " text-anchor=\"end\" font-size=\"11\"",
                   view->values[1][r]);
  spore_svg_text(svg, LEFT + CELL_WIDTH * columns / 2, bottom + 42, " text-anchor=\"middle\"",
                 view->table->sweep->axes[view->axis[0]]);
  spore_svg_text(svg, 8, TOP - 10, "", view->table->sweep->axes[view->axis[1]]);
  spore_svg_text(svg, LEFT, bottom + 68, " fill=\"#444444\"", _("Means of all cases there; ?: no result."));
}

static char *draw_map(const View *view, const char *title, GError **error) {
  guint columns = MIN(CELLS_MAXIMUM, g_strv_length(view->values[0])),
        rows = MIN(CELLS_MAXIMUM, g_strv_length(view->values[1]));
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (guint c = 0; c < columns; c++)
    for (guint r = 0; r < rows; r++) {
      Spread spread = spread_at(view, c, (int)r);
      if (spread.count > 0) least = fmin(least, spread.mean), most = fmax(most, spread.mean);
    }
  SporeTextBuffer svg = {0};
  spore_svg_open(&svg, title, LEFT + CELL_WIDTH * columns + RIGHT, TOP + CELL_HEIGHT * rows + BELOW);
  for (guint c = 0; c < columns; c++)
    for (guint r = 0; r < rows; r++)
      draw_cell(&svg, LEFT + CELL_WIDTH * c, TOP + CELL_HEIGHT * (rows - 1 - r), spread_at(view, c, (int)r), least,
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
    svg = view.axis[1] >= 0 ? draw_map(&view, title, error) : draw_curve(&view, title, error);
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
