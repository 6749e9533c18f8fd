/* Draws panels of lines through measured points as an SVG document. */
#include "core/measure/plot_axis.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/number.h"
#include "core/base/text.h"
#include "core/measure/svg.h"

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
const SporePlotStyle spore_plot_styles[SPORE_PLOT_COLOURS] = {
    {0},
    {2, {7, 4}, 4, {{-.85, -.85}, {.85, -.85}, {.85, .85}, {-.85, .85}}},
    {2, {2, 3}, 3, {{0, -1.15}, {1.05, .7}, {-1.05, .7}}},
    {4, {10, 3, 2, 3}, 4, {{0, -1.25}, {1.25, 0}, {0, 1.25}, {-1.25, 0}}},
    {2, {4, 2}, 3, {{0, 1.15}, {1.05, -.7}, {-1.05, -.7}}},
    {2,
     {12, 5},
     12,
     {{-1.2, -.35},
      {-.35, -.35},
      {-.35, -1.2},
      {.35, -1.2},
      {.35, -.35},
      {1.2, -.35},
      {1.2, .35},
      {.35, .35},
      {.35, 1.2},
      {-.35, 1.2},
      {-.35, .35},
      {-1.2, .35}}}};

/* A length to a hundredth of a pixel. */
static void add_number(SporeTextBuffer *text, double value) { spore_text_add_number(text, round(value * 100) / 100); }

#define TICK_DIGITS 6

#define GRID " stroke=\"#dddddd\" stroke-width=\"1\""
#define FRAME " stroke=\"#444444\" stroke-width=\"1\""

static void draw_axes(SporeTextBuffer *text, const SporePlotAxis *x, const SporePlotAxis *y,
                      const SporePlotPanel *panel) {
  char number[SPORE_NUMBER_TEXT];
  double last = -HUGE_VAL;
  for (size_t i = 0; i < x->ticks; i++) {
    double at = spore_plot_axis_place(x, x->tick[i]);
    spore_svg_line(text, at, y->from, at, y->to, GRID);
    if (at - last < 26) continue; /* no room for its number */
    spore_number_format_rounded(x->tick[i], TICK_DIGITS, number);
    spore_svg_text(text, last = at, y->from + LINE_OF_TEXT, " text-anchor=\"middle\"", number);
  }
  for (size_t i = 0; i < y->ticks; i++) {
    double at = spore_plot_axis_place(y, y->tick[i]);
    spore_svg_line(text, x->from, at, x->to, at, GRID);
    spore_number_format_rounded(y->tick[i], TICK_DIGITS, number);
    spore_svg_text(text, x->from - 7, at + 4, " text-anchor=\"end\"", number);
  }
  spore_svg_line(text, x->from, y->from, x->to, y->from, FRAME);
  spore_svg_line(text, x->from, y->from, x->from, y->to, FRAME);
  spore_svg_text(text, (x->from + x->to) / 2, y->from + 2.3 * LINE_OF_TEXT, " text-anchor=\"middle\"", panel->x_label);
  double middle = (y->from + y->to) / 2, side = x->from - LEFT + 16;
  spore_text_add(text, "<g transform=\"rotate(-90 ");
  add_number(text, side);
  spore_text_add(text, " ");
  add_number(text, middle);
  spore_text_add(text, ")\">");
  spore_svg_text(text, side, middle, " text-anchor=\"middle\"", panel->y_label);
  spore_text_add(text, "</g>\n");
}

/* ` stroke-dasharray="..."`, of a line that is dashed. */
static void add_dashes(SporeTextBuffer *text, const SporePlotStyle *style) {
  for (size_t i = 0; i < style->dash_count; i++) {
    spore_text_add(text, i == 0 ? " stroke-dasharray=\"" : " ");
    spore_text_add_number(text, style->dash[i]);
  }
  if (style->dash_count > 0) spore_text_add(text, "\"");
}

static void draw_point(SporeTextBuffer *text, double x, double y, double radius, size_t number, bool hollow) {
  const char *colour = spore_plot_colours[number % SPORE_PLOT_COLOURS];
  const SporePlotStyle *style = &spore_plot_styles[number % SPORE_PLOT_COLOURS];
  if (style->corner_count > 0) {
    for (size_t i = 0; i < style->corner_count; i++) {
      spore_text_add(text, i == 0 ? "<path d=\"M" : "L");
      spore_text_add_number(text, style->corner[i][0]);
      spore_text_add(text, " ");
      spore_text_add_number(text, style->corner[i][1]);
    }
    spore_text_add(text, "Z\" transform=\"translate(");
    add_number(text, x);
    spore_text_add(text, " ");
    add_number(text, y);
    spore_text_add(text, ") scale(");
    add_number(text, radius);
    spore_text_add(text, ")\"");
  } else {
    spore_text_add(text, "<circle");
    spore_svg_attribute(text, "r", radius);
    spore_svg_attribute(text, "cx", x);
    spore_svg_attribute(text, "cy", y);
  }
  spore_text_add(text, " fill=\"");
  spore_text_add(text, hollow ? "white" : colour);
  spore_text_add(text, "\" stroke=\"");
  spore_text_add(text, colour);
  spore_text_add(text, style->corner_count > 0 ? "\" stroke-width=\"0.35\"/>\n" : "\" stroke-width=\"1.3\"/>\n");
}

static void draw_ring(SporeTextBuffer *text, double x, double y) {
  spore_text_add(
      text, "<ellipse rx=\"8\" ry=\"8\" fill=\"none\" stroke=\"#222222\" stroke-width=\"1.3\" transform=\"translate(");
  add_number(text, x);
  spore_text_add(text, " ");
  add_number(text, y);
  spore_text_add(text, ")\"/>\n");
}

/* A bar with a dash at each end. What lies below a logarithmic axis is cut off. */
static void draw_bar(SporeTextBuffer *text, const SporePlotAxis *x, const SporePlotAxis *y, const SporePlotLine *line,
                     size_t i) {
  if (!line->low || !line->high || !(line->high[i] > line->low[i]) || !spore_plot_axis_shows(y, line->high[i])) return;
  bool cut = !spore_plot_axis_shows(y, line->low[i]);
  double at = spore_plot_axis_place(x, line->x[i]), top = spore_plot_axis_place(y, line->high[i]);
  double bottom = cut ? y->from : spore_plot_axis_place(y, line->low[i]);
  spore_svg_line(text, at, bottom, at, top, FRAME);
  spore_svg_line(text, at - 4, top, at + 4, top, FRAME);
  if (!cut) spore_svg_line(text, at - 4, bottom, at + 4, bottom, FRAME);
}

static void draw_line(SporeTextBuffer *text, const SporePlotAxis *x, const SporePlotAxis *y, const SporePlotLine *line,
                      size_t number) {
  bool first = true;
  if (!line->scattered) {
    spore_text_add(text, "<polyline fill=\"none\" stroke-width=\"2\" stroke-linejoin=\"round\" stroke=\"");
    spore_text_add(text, spore_plot_colours[number % SPORE_PLOT_COLOURS]);
    spore_text_add(text, "\"");
    add_dashes(text, &spore_plot_styles[number % SPORE_PLOT_COLOURS]);
    spore_text_add(text, " points=\"");
    for (size_t i = 0; i < line->count; i++) {
      if (!spore_plot_axis_shows(x, line->x[i]) || !spore_plot_axis_shows(y, line->y[i])) continue;
      if (!first) spore_text_add(text, " ");
      first = false;
      add_number(text, spore_plot_axis_place(x, line->x[i]));
      spore_text_add(text, ",");
      add_number(text, spore_plot_axis_place(y, line->y[i]));
    }
    spore_text_add(text, "\"/>\n");
  }
  for (size_t i = 0; (line->scattered || line->count <= POINTS_MOST) && i < line->count; i++) {
    if (!spore_plot_axis_shows(x, line->x[i]) || !spore_plot_axis_shows(y, line->y[i])) continue;
    draw_bar(text, x, y, line, i);
    double at_x = spore_plot_axis_place(x, line->x[i]), at_y = spore_plot_axis_place(y, line->y[i]);
    draw_point(text, at_x, at_y, 3.5, number, line->hollow && line->hollow[i]);
    if (line->ringed && line->ringed[i]) draw_ring(text, at_x, at_y);
  }
}

/* A label at the end of a line that lies farthest to the right. */
typedef struct EndLabel {
  double x, y;
  const char *text;
} EndLabel;

static bool find_end(const SporePlotAxis *x, const SporePlotAxis *y, const SporePlotLine *line, EndLabel *end) {
  *end = (EndLabel){-HUGE_VAL, 0, line->label};
  for (size_t i = 0; i < line->count; i++)
    if (spore_plot_axis_shows(x, line->x[i]) && spore_plot_axis_shows(y, line->y[i]) &&
        spore_plot_axis_place(x, line->x[i]) > end->x)
      end->x = spore_plot_axis_place(x, line->x[i]), end->y = spore_plot_axis_place(y, line->y[i]);
  return isfinite(end->x);
}

/* Labels from the top down, none on another one. */
static void draw_end_labels(SporeTextBuffer *text, const SporePlotAxis *x, const SporePlotAxis *y,
                            const SporePlotPanel *panel) {
  double last = -HUGE_VAL, last_y = -HUGE_VAL;
  size_t last_line = 0;
  for (size_t drawn = 0; drawn < panel->line_count; drawn++) {
    EndLabel best = {0, HUGE_VAL, NULL};
    size_t best_line = 0;
    for (size_t l = 0; l < panel->line_count; l++) {
      EndLabel end;
      bool before = !find_end(x, y, &panel->lines[l], &end) || end.y < last_y || (end.y == last_y && l <= last_line);
      if (before && drawn > 0) continue;
      if (end.text && isfinite(end.x) && end.y < best.y) best = end, best_line = l;
    }
    if (!best.text) return;
    last_y = best.y, last_line = best_line;
    last = fmax(best.y + 4, last + 14);
    spore_svg_text(text, x->to + 12, last, " font-size=\"11\"", best.text);
    spore_svg_line(text, best.x + 6, best.y, x->to + 9, last - 4, " stroke=\"#999999\" stroke-width=\"0.7\"");
  }
}

static void draw_shade(SporeTextBuffer *text, const SporePlotAxis *x, const SporePlotAxis *y,
                       const SporePlotPanel *panel) {
  if (!(panel->shade_below > y->low)) return;
  double top = panel->shade_below < y->high ? spore_plot_axis_place(y, panel->shade_below) : y->to;
  spore_text_add(text, "<rect fill=\"#e8e8e8\"");
  spore_svg_attribute(text, "x", x->from);
  spore_svg_attribute(text, "y", top);
  spore_svg_attribute(text, "width", x->to - x->from);
  spore_svg_attribute(text, "height", y->from - top);
  spore_text_add(text, "/>\n");
  if (panel->shade_label)
    spore_svg_text(text, x->from + 6, y->from - 7, " fill=\"#555555\" font-size=\"11\"", panel->shade_label);
}

/* The label stands on the side that has room. */
static void draw_mark(SporeTextBuffer *text, const SporePlotAxis *x, const SporePlotAxis *y,
                      const SporePlotPanel *panel) {
  if (!panel->mark_label || !spore_plot_axis_shows(x, panel->mark_x)) return;
  double at = spore_plot_axis_place(x, panel->mark_x);
  if (at < x->from || at > x->to) return; /* no line comes near */
  bool right = at < (x->from + x->to) / 2;
  spore_svg_line(text, at, y->from, at, y->to, " stroke=\"#444444\" stroke-width=\"1.5\" stroke-dasharray=\"5 4\"");
  /* Drawn twice, first white and thick, so that the label is legible over lines. */
  const char *ways[2][2] = {{" stroke=\"white\" stroke-width=\"5\" text-anchor=\"start\"", " text-anchor=\"start\""},
                            {" stroke=\"white\" stroke-width=\"5\" text-anchor=\"end\"", " text-anchor=\"end\""}};
  for (int k = 0; k < 2; k++)
    spore_svg_text(text, at + (right ? 6 : -6), y->to + 14, ways[!right][k], panel->mark_label);
}

/* Approximate width of a label, by its number of characters. */
static double width_of(const char *text) {
  double count = 0;
  for (; *text; text++) count += (*text & 0xc0) != 0x80;
  return 7 * count;
}

/* Pixels that labels at the ends of lines need. */
static double room_for_labels(const SporePlotPanel *panel) {
  double most = 0;
  for (size_t l = 0; panel->label_lines && l < panel->line_count; l++)
    most = fmax(most, width_of(panel->lines[l].label));
  return most;
}

static bool draw_panel(SporeTextBuffer *text, const SporePlotPanel *panel, double left) {
  SporePlotAxis x = {
      .from = left + LEFT, .to = left + PANEL_WIDTH - RIGHT - room_for_labels(panel), .logarithmic = panel->log_x};
  SporePlotAxis y = {.from = HEIGHT - BOTTOM, .to = TOP, .logarithmic = panel->log_y};
  if (!spore_plot_axis_fit(&x, panel, false) || !spore_plot_axis_fit(&y, panel, true)) return false;
  draw_shade(text, &x, &y, panel);
  draw_axes(text, &x, &y, panel);
  for (size_t l = 0; l < panel->line_count; l++) draw_line(text, &x, &y, &panel->lines[l], l);
  draw_mark(text, &x, &y, panel);
  if (panel->label_lines) draw_end_labels(text, &x, &y, panel);
  return true;
}

static void draw_legend(SporeTextBuffer *text, const SporePlotPanel *panel) {
  double x = LEFT;
  for (size_t l = 0; l < panel->line_count; l++) {
    spore_text_add(text, "<path fill=\"none\" stroke-width=\"2\" stroke=\"");
    spore_text_add(text, spore_plot_colours[l % SPORE_PLOT_COLOURS]);
    spore_text_add(text, "\"");
    add_dashes(text, &spore_plot_styles[l % SPORE_PLOT_COLOURS]);
    spore_text_add(text, " d=\"M");
    add_number(text, x - 6);
    spore_text_add(text, " ");
    add_number(text, TOP - 27);
    spore_text_add(text, "h22\"/>\n");
    draw_point(text, x + 5, TOP - 27, 4.5, l, false);
    spore_svg_text(text, x + 21, TOP - 23, "", panel->lines[l].label);
    x += 44 + width_of(panel->lines[l].label);
  }
}

/* Lines of the note, the last one at the bottom. */
static void draw_note(SporeTextBuffer *text, const char *note) {
  double y = HEIGHT - 10;
  for (const char *c = note; *c; c++) y -= *c == '\n' ? LINE_OF_TEXT : 0;
  for (const char *end; note; note = *end ? end + 1 : NULL, y += LINE_OF_TEXT) {
    end = strchr(note, '\n');
    if (!end) end = note + strlen(note);
    spore_text_add(text, "<text fill=\"#444444\"");
    spore_svg_attribute(text, "x", LEFT);
    spore_svg_attribute(text, "y", y);
    spore_text_add(text, ">");
    spore_svg_escaped(text, note, (size_t)(end - note));
    spore_text_add(text, "</text>\n");
  }
}

char *spore_plot_svg(const char *title, const char *note, const SporePlotPanel *panels, size_t panel_count,
                     SporeError *error) {
  SporeTextBuffer text = {0};
  bool any = false;
  spore_svg_open(&text, title, PANEL_WIDTH * (double)(panel_count ? panel_count : 1), HEIGHT);
  for (size_t p = 0; p < panel_count; p++) any |= draw_panel(&text, &panels[p], PANEL_WIDTH * (double)p);
  if (panel_count) draw_legend(&text, &panels[0]);
  if (note) draw_note(&text, note);
  spore_text_add(&text, "</svg>\n");
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
