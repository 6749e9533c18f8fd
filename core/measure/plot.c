/* Draws panels of lines through measured points as an SVG document. */
#include "core/measure/plot.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/number.h"
#include "core/base/text.h"
#include "core/measure/text_buffer.h"

/* Pixels. */
#define PANEL_WIDTH 480.
#define HEIGHT 440.
#define LEFT 74.
#define RIGHT 20.
#define TOP 78.
#define BOTTOM 108.
#define LINE_OF_TEXT 18.

#define POINTS_MOST 64 /* of a line on which they are seen */

const char *const spore_plot_colours[SPORE_PLOT_COLOURS] = {"#0072b2", "#d55e00", "#009e73",
                                                            "#cc79a7", "#e69f00", "#56b4e9"};

typedef SporeTextBuffer Text;

static void add_bytes(Text *text, const char *bytes, size_t size) { spore_text_add_bytes(text, bytes, size); }
static void add(Text *text, const char *string) { spore_text_add(text, string); }

static void add_escaped(Text *text, const char *string, size_t size) {
  for (const char *end = string + size; string < end; string++) {
    if (*string == '&') add(text, "&amp;");
    else if (*string == '<') add(text, "&lt;");
    else if (*string == '>') add(text, "&gt;");
    else add_bytes(text, string, 1);
  }
}

/* A length to a hundredth of a pixel. */
static void add_number(Text *text, double value) { spore_text_add_number(text, round(value * 100) / 100); }

/* name="value" */
static void add_attribute(Text *text, const char *name, double value) {
  add(text, " ");
  add(text, name);
  add(text, "=\"");
  add_number(text, value);
  add(text, "\"");
}

static void add_line(Text *text, double x1, double y1, double x2, double y2, const char *rest) {
  add(text, "<line");
  add_attribute(text, "x1", x1);
  add_attribute(text, "y1", y1);
  add_attribute(text, "x2", x2);
  add_attribute(text, "y2", y2);
  add(text, rest);
  add(text, "/>\n");
}

static void add_text(Text *text, double x, double y, const char *rest, const char *content) {
  add(text, "<text");
  add_attribute(text, "x", x);
  add_attribute(text, "y", y);
  add(text, rest);
  add(text, ">");
  add_escaped(text, content, strlen(content));
  add(text, "</text>\n");
}

/* One direction of a panel: values low .. high lie at pixels from .. to. */
typedef struct Axis {
  double low, high, from, to;
  bool logarithmic;
  double tick[SPORE_PLOT_TICKS];
  size_t ticks;
} Axis;

static bool shows(const Axis *axis, double value) { return isfinite(value) && (!axis->logarithmic || value > 0); }

static double place(const Axis *axis, double value) {
  double low = axis->low, high = axis->high;
  if (axis->logarithmic) value = log(value), low = log(low), high = log(high);
  return axis->from + (axis->to - axis->from) * (value - low) / (high - low);
}

static void add_tick(Axis *axis, double value) {
  double slack = 1e-9 * (axis->high - axis->low);
  if (axis->ticks < SPORE_PLOT_TICKS && value >= axis->low - slack && value <= axis->high + slack)
    axis->tick[axis->ticks++] = value;
}

/* 1, 2 and 5 of each decade, or 1 alone over many. */
static void tick_decades(Axis *axis) {
  static const double steps[] = {1, 2, 5};
  int first = (int)floor(log10(axis->low)), last = (int)ceil(log10(axis->high)), each = last - first > 3 ? 1 : 3;
  int stride = 1 + (last - first) / SPORE_PLOT_TICKS;
  for (int decade = first; decade <= last; decade += stride)
    for (int k = 0; k < each; k++) add_tick(axis, steps[k] * pow(10, decade));
}

static void tick_evenly(Axis *axis) {
  double rough = (axis->high - axis->low) / 6, unit = pow(10, floor(log10(rough))), step = unit;
  if (rough > 5 * unit) step = 10 * unit;
  else if (rough > 2 * unit) step = 5 * unit;
  else if (rough > unit) step = 2 * unit;
  double first = ceil(axis->low / step);
  for (double k = 0; k < SPORE_PLOT_TICKS && (first + k) * step <= axis->high + 1e-9 * fabs(axis->high); k++)
    add_tick(axis, (first + k) * step);
}

size_t spore_plot_ticks(double low, double high, double tick[SPORE_PLOT_TICKS]) {
  Axis axis = {.low = low, .high = high};
  tick_evenly(&axis);
  memcpy(tick, axis.tick, axis.ticks * sizeof *tick);
  return axis.ticks;
}

/* Fits the values with a little room; a linear axis of values that are not negative begins at 0. */
static bool fit_axis(Axis *axis, const SporePlotPanel *panel, bool vertical) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (size_t l = 0; l < panel->line_count; l++)
    for (size_t i = 0; i < panel->lines[l].count; i++) {
      double value = (vertical ? panel->lines[l].y : panel->lines[l].x)[i];
      if (shows(axis, value)) low = fmin(low, value), high = fmax(high, value);
    }
  if (!(low <= high)) return false;
  if (axis->logarithmic) {
    axis->low = low / 1.2, axis->high = high * 1.2;
    tick_decades(axis);
  } else {
    axis->low = low >= 0 ? 0 : low - 0.05 * (high - low);
    axis->high = high + (high > axis->low ? 0.05 * (high - axis->low) : 1);
    tick_evenly(axis);
  }
  return true;
}

static void format_tick(double value, char text[SPORE_NUMBER_TEXT]) {
  double unit = value != 0 ? pow(10, floor(log10(fabs(value))) - 5) : 1;
  text[spore_number_format(unit < 1 ? round(value / unit) / round(1 / unit) : round(value / unit) * unit, text)] = '\0';
}

#define GRID " stroke=\"#dddddd\" stroke-width=\"1\""
#define FRAME " stroke=\"#444444\" stroke-width=\"1\""

static void draw_axes(Text *text, const Axis *x, const Axis *y, const SporePlotPanel *panel) {
  char number[SPORE_NUMBER_TEXT];
  double last = -HUGE_VAL;
  for (size_t i = 0; i < x->ticks; i++) {
    double at = place(x, x->tick[i]);
    add_line(text, at, y->from, at, y->to, GRID);
    if (at - last < 26) continue; /* no room for its number */
    format_tick(x->tick[i], number);
    add_text(text, last = at, y->from + LINE_OF_TEXT, " text-anchor=\"middle\"", number);
  }
  for (size_t i = 0; i < y->ticks; i++) {
    double at = place(y, y->tick[i]);
    add_line(text, x->from, at, x->to, at, GRID);
    format_tick(y->tick[i], number);
    add_text(text, x->from - 7, at + 4, " text-anchor=\"end\"", number);
  }
  add_line(text, x->from, y->from, x->to, y->from, FRAME);
  add_line(text, x->from, y->from, x->from, y->to, FRAME);
  add_text(text, (x->from + x->to) / 2, y->from + 2.3 * LINE_OF_TEXT, " text-anchor=\"middle\"", panel->x_label);
  double middle = (y->from + y->to) / 2, side = x->from - LEFT + 16;
  add(text, "<g transform=\"rotate(-90 ");
  add_number(text, side);
  add(text, " ");
  add_number(text, middle);
  add(text, ")\">");
  add_text(text, side, middle, " text-anchor=\"middle\"", panel->y_label);
  add(text, "</g>\n");
}

static void draw_line(Text *text, const Axis *x, const Axis *y, const SporePlotLine *line, size_t number) {
  const char *colour = spore_plot_colours[number % SPORE_PLOT_COLOURS];
  bool first = true;
  if (!line->scattered) {
    add(text, "<polyline fill=\"none\" stroke-width=\"2\" stroke-linejoin=\"round\" stroke=\"");
    add(text, colour);
    add(text, "\" points=\"");
    for (size_t i = 0; i < line->count; i++) {
      if (!shows(x, line->x[i]) || !shows(y, line->y[i])) continue;
      if (!first) add(text, " ");
      first = false;
      add_number(text, place(x, line->x[i]));
      add(text, ",");
      add_number(text, place(y, line->y[i]));
    }
    add(text, "\"/>\n");
  }
  for (size_t i = 0; (line->scattered || line->count <= POINTS_MOST) && i < line->count; i++) {
    if (!shows(x, line->x[i]) || !shows(y, line->y[i])) continue;
    add(text, "<circle r=\"3.5\" fill=\"");
    add(text, colour);
    add(text, "\"");
    add_attribute(text, "cx", place(x, line->x[i]));
    add_attribute(text, "cy", place(y, line->y[i]));
    add(text, "/>\n");
  }
}

/* The label stands on the side that has room. */
static void draw_mark(Text *text, const Axis *x, const Axis *y, const SporePlotPanel *panel) {
  if (!panel->mark_label || !shows(x, panel->mark_x)) return;
  double at = place(x, panel->mark_x);
  bool right = at < (x->from + x->to) / 2;
  add_line(text, at, y->from, at, y->to, " stroke=\"#444444\" stroke-width=\"1.5\" stroke-dasharray=\"5 4\"");
  /* Drawn twice, first white and thick, so that the label is legible over lines. */
  const char *ways[2][2] = {{" stroke=\"white\" stroke-width=\"5\" text-anchor=\"start\"", " text-anchor=\"start\""},
                            {" stroke=\"white\" stroke-width=\"5\" text-anchor=\"end\"", " text-anchor=\"end\""}};
  for (int k = 0; k < 2; k++) add_text(text, at + (right ? 6 : -6), y->to + 14, ways[!right][k], panel->mark_label);
}

static bool draw_panel(Text *text, const SporePlotPanel *panel, double left) {
  Axis x = {.from = left + LEFT, .to = left + PANEL_WIDTH - RIGHT, .logarithmic = panel->log_x};
  Axis y = {.from = HEIGHT - BOTTOM, .to = TOP, .logarithmic = panel->log_y};
  if (!fit_axis(&x, panel, false) || !fit_axis(&y, panel, true)) return false;
  draw_axes(text, &x, &y, panel);
  for (size_t l = 0; l < panel->line_count; l++) draw_line(text, &x, &y, &panel->lines[l], l);
  draw_mark(text, &x, &y, panel);
  return true;
}

/* Approximate width of a label, by its number of characters. */
static double width_of(const char *text) {
  double count = 0;
  for (; *text; text++) count += (*text & 0xc0) != 0x80;
  return 7 * count;
}

static void draw_legend(Text *text, const SporePlotPanel *panel) {
  double x = LEFT;
  for (size_t l = 0; l < panel->line_count; l++) {
    add(text, "<circle r=\"4.5\" fill=\"");
    add(text, spore_plot_colours[l % SPORE_PLOT_COLOURS]);
    add(text, "\"");
    add_attribute(text, "cx", x + 5);
    add_attribute(text, "cy", TOP - 27);
    add(text, "/>\n");
    add_text(text, x + 15, TOP - 23, "", panel->lines[l].label);
    x += 34 + width_of(panel->lines[l].label);
  }
}

/* Lines of the note, the last one at the bottom. */
static void draw_note(Text *text, const char *note) {
  double y = HEIGHT - 10;
  for (const char *c = note; *c; c++) y -= *c == '\n' ? LINE_OF_TEXT : 0;
  for (const char *end; note; note = *end ? end + 1 : NULL, y += LINE_OF_TEXT) {
    end = strchr(note, '\n');
    if (!end) end = note + strlen(note);
    add(text, "<text fill=\"#444444\"");
    add_attribute(text, "x", LEFT);
    add_attribute(text, "y", y);
    add(text, ">");
    add_escaped(text, note, (size_t)(end - note));
    add(text, "</text>\n");
  }
}

static void open_document(Text *text, const char *title, double width) {
  add(text, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\"");
  add_attribute(text, "width", width);
  add_attribute(text, "height", HEIGHT);
  add(text, " viewBox=\"0 0 ");
  add_number(text, width);
  add(text, " ");
  add_number(text, HEIGHT);
  add(text, "\" font-family=\"DejaVu Sans, Verdana, sans-serif\" font-size=\"12\" fill=\"#222222\">\n"
            "<title>");
  add_escaped(text, title, strlen(title));
  add(text, "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n");
  add_text(text, LEFT, 28, " font-size=\"16\" font-weight=\"bold\"", title);
}

char *spore_plot_svg(const char *title, const char *note, const SporePlotPanel *panels, size_t panel_count,
                     SporeError *error) {
  Text text = {0};
  bool any = false;
  open_document(&text, title, PANEL_WIDTH * (double)(panel_count ? panel_count : 1));
  for (size_t p = 0; p < panel_count; p++) any |= draw_panel(&text, &panels[p], PANEL_WIDTH * (double)p);
  if (panel_count) draw_legend(&text, &panels[0]);
  if (note) draw_note(&text, note);
  add(&text, "</svg>\n");
  if (any && !text.failed) return text.bytes;
  spore_free(text.bytes);
  if (text.failed)
    spore_error_set(error, SPORE_ERROR_MEMORY, NULL,
                    _("there is not enough memory for a plot; close other programs and try again"));
  else
    spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                    _("there is no point that a plot could show; expected numbers; measure something first"));
  return NULL;
}
