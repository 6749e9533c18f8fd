/* Draws the map of a stability study: verdicts by step and stiffness, told apart by hatching and marks, so that black
 * and white is enough. */
#include <math.h>
#include <stdio.h>

#include "core/base/memory.h"
#include "core/base/number.h"
#include "core/base/text.h"
#include "core/measure/stability.h"
#include "core/measure/svg.h"

/* Pixels. */
#define CELL_WIDTH 76.
#define CELL_HEIGHT 46.
#define LEFT 112.
#define TOP 64.
#define RIGHT 250. /* of the cells: the legend */
#define BELOW 92.
#define LINE_OF_TEXT 18.

#define LIMIT_STROKE " stroke=\"#000000\" stroke-width=\"2.5\" stroke-dasharray=\"9 4\""
#define DARK " stroke=\"#222222\" stroke-width=\"2\""

static const char patterns[] =
    "<defs>\n"
    "<pattern id=\"hatched\" width=\"7\" height=\"7\" patternUnits=\"userSpaceOnUse\" patternTransform=\"rotate(45)\">"
    "<rect width=\"7\" height=\"7\" fill=\"#ffffff\"/>"
    "<line x1=\"0\" y1=\"0\" x2=\"0\" y2=\"7\" stroke=\"#666666\" stroke-width=\"2\"/></pattern>\n"
    "<pattern id=\"dotted\" width=\"8\" height=\"8\" patternUnits=\"userSpaceOnUse\">"
    "<rect width=\"8\" height=\"8\" fill=\"#ffffff\"/><circle cx=\"4\" cy=\"4\" r=\"1.5\" "
    "fill=\"#222222\"/></pattern>\n"
    "</defs>\n";

/* A cell of the map, or of the legend, with its mark. */
static void draw_cell(SporeTextBuffer *svg, double x, double y, double width, double height,
                      SporeStabilityVerdict verdict, bool known) {
  static const char *const fills[] = {
      " fill=\"#ffffff\" stroke=\"#888888\"", " fill=\"url(#hatched)\" stroke=\"#888888\"",
      " fill=\"url(#dotted)\" stroke=\"#888888\"", " fill=\"#333333\" stroke=\"#888888\""};
  double middle_x = x + width / 2, middle_y = y + height / 2, r = 6;
  spore_svg_rectangle(svg, x, y, width, height, known ? fills[verdict] : fills[SPORE_STABILITY_STABLE]);
  if (!known) {
    spore_svg_text(svg, middle_x, middle_y + 4, " text-anchor=\"middle\"", "?");
  } else if (verdict == SPORE_STABILITY_STABLE) {
    spore_text_add(svg, "<circle r=\"6\" fill=\"none\"" DARK);
    spore_svg_attribute(svg, "cx", middle_x);
    spore_svg_attribute(svg, "cy", middle_y);
    spore_text_add(svg, "/>\n");
  } else if (verdict == SPORE_STABILITY_FAILED) {
    static const char light[] = " stroke=\"#ffffff\" stroke-width=\"2.5\"";
    spore_svg_line(svg, middle_x - r, middle_y - r, middle_x + r, middle_y + r, light);
    spore_svg_line(svg, middle_x - r, middle_y + r, middle_x + r, middle_y - r, light);
  }
}

static double top_of_row(const SporeStabilityMap *map, size_t row) {
  return TOP + CELL_HEIGHT * (double)(map->rows - 1 - row);
}

static void draw_axes(SporeTextBuffer *svg, const SporeStabilityMap *map) {
  char text[64];
  double bottom = TOP + CELL_HEIGHT * (double)map->rows, right = LEFT + CELL_WIDTH * (double)map->columns;
  for (size_t c = 0; c < map->columns; c++) {
    char digits[SPORE_NUMBER_TEXT];
    spore_number_format_rounded(1e3 * map->time_step_s[c], 3, digits);
    spore_svg_text(svg, LEFT + CELL_WIDTH * ((double)c + 0.5), bottom + LINE_OF_TEXT, " text-anchor=\"middle\"",
                   digits);
  }
  for (size_t r = 0; r < map->rows; r++) {
    snprintf(text, sizeof text, map->stiffness[r] < 1 ? "/ %.0f" : "x %.0f",
             map->stiffness[r] < 1 ? 1 / map->stiffness[r] : map->stiffness[r]);
    spore_svg_text(svg, LEFT - 10, top_of_row(map, r) + CELL_HEIGHT / 2 + 4, " text-anchor=\"end\"", text);
  }
  spore_svg_text(svg, (LEFT + right) / 2, bottom + 2.2 * LINE_OF_TEXT, " text-anchor=\"middle\"", _("time step, ms"));
  double middle = (TOP + bottom) / 2;
  spore_text_add(svg, "<g transform=\"rotate(-90 28 ");
  char digits[SPORE_NUMBER_TEXT];
  digits[spore_number_format(round(middle), digits)] = '\0';
  spore_text_add(svg, digits);
  spore_text_add(svg, ")\">");
  spore_svg_text(svg, 28, middle, " text-anchor=\"middle\"", _("stiffness of all bodies"));
  spore_text_add(svg, "</g>\n");
}

/* Where a step lies along the columns; steps grow by one factor from column to column. */
static double place_step(const SporeStabilityMap *map, double step_s) {
  double ratio = map->columns > 1 ? log(map->time_step_s[1] / map->time_step_s[0]) : 1;
  return LEFT + CELL_WIDTH * (0.5 + log(step_s / map->time_step_s[0]) / ratio);
}

/* The largest step by theory, row by row, on white, so that it is seen on dark cells. */
static void draw_limit(SporeTextBuffer *svg, const SporeStabilityMap *map) {
  static const char *const strokes[] = {" stroke=\"#ffffff\" stroke-width=\"6\"", LIMIT_STROKE};
  spore_text_add(svg, "<g clip-path=\"url(#cells)\">\n");
  for (int k = 0; k < 2; k++)
    for (size_t r = 1; r < map->rows; r++) {
      double before = map->limit_s[r - 1], here = map->limit_s[r];
      if (!(before > 0) || !(here > 0) || isinf(before) || isinf(here)) continue;
      spore_svg_line(svg, place_step(map, before), top_of_row(map, r - 1) + CELL_HEIGHT / 2, place_step(map, here),
                     top_of_row(map, r) + CELL_HEIGHT / 2, strokes[k]);
    }
  spore_text_add(svg, "</g>\n");
}

static void draw_legend(SporeTextBuffer *svg, const SporeStabilityReport *report) {
  static const char *const words[] = {N_("stable"), N_("recovered, and said so"), N_("refused, with the limit"),
                                      N_("failed")};
  const SporeStabilityMap *map = &report->map;
  double x = LEFT + CELL_WIDTH * (double)map->columns + 24, y = TOP;
  for (int k = 0; k < 4; k++, y += 30) {
    draw_cell(svg, x, y, 34, 22, (SporeStabilityVerdict)k, true);
    spore_svg_text(svg, x + 44, y + 15, "", _(words[k]));
  }
  spore_svg_rectangle(svg, x, y, 34, 22, " fill=\"none\" stroke=\"#000000\" stroke-width=\"3\"");
  spore_svg_text(svg, x + 44, y + 15, "", _("the scene as written"));
  const SporeStabilityLimit *limit = map->narrowest;
  if (!limit) return;
  char text[200];
  spore_svg_line(svg, x, y + 41, x + 34, y + 41, LIMIT_STROKE);
  spore_svg_text(svg, x + 44, y + 45, "", _("largest step by theory:"));
  snprintf(text, sizeof text, "%s, %s", limit->body, spore_integrator_names[limit->method]);
  spore_svg_text(svg, x + 44, y + 45 + LINE_OF_TEXT, "", text);
}

char *spore_stability_map_svg(const SporeStabilityReport *report, const char *title, SporeError *error) {
  const SporeStabilityMap *map = &report->map;
  if (map->columns == 0) {
    spore_error_set(error, SPORE_ERROR_INPUT, NULL, _("there is no map; ask for it before the study"));
    return NULL;
  }
  char note[200];
  double height = TOP + CELL_HEIGHT * (double)map->rows + BELOW;
  SporeTextBuffer svg = {0};
  spore_svg_open(&svg, title, LEFT + CELL_WIDTH * (double)map->columns + RIGHT, fmax(height, 300));
  spore_text_add(&svg, patterns);
  spore_text_add(&svg, "<clipPath id=\"cells\">");
  spore_svg_rectangle(&svg, LEFT, TOP, CELL_WIDTH * (double)map->columns, CELL_HEIGHT * (double)map->rows, "");
  spore_text_add(&svg, "</clipPath>\n");
  for (size_t r = 0; r < map->rows; r++)
    for (size_t c = 0; c < map->columns; c++)
      draw_cell(&svg, LEFT + CELL_WIDTH * (double)c, top_of_row(map, r), CELL_WIDTH, CELL_HEIGHT, map->cells[r][c],
                map->known[r][c]);
  for (size_t c = 0; c < map->columns; c++)
    if (map->time_step_s[c] == report->time_step_s)
      spore_svg_rectangle(&svg, LEFT + CELL_WIDTH * (double)c, top_of_row(map, map->rows / 2), CELL_WIDTH, CELL_HEIGHT,
                          " fill=\"none\" stroke=\"#000000\" stroke-width=\"3\"");
  if (map->narrowest) draw_limit(&svg, map);
  draw_axes(&svg, map);
  draw_legend(&svg, report);
  snprintf(note, sizeof note, _("%zu steps in each cell"), map->steps);
  spore_svg_text(&svg, LEFT, TOP + CELL_HEIGHT * (double)map->rows + 3.6 * LINE_OF_TEXT, " fill=\"#444444\"", note);
  spore_text_add(&svg, "</svg>\n");
  if (!svg.failed) return svg.bytes;
  spore_free(svg.bytes);
  spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the map"));
  return NULL;
}
