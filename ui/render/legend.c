/* Legends as drawings in SVG. How wide letters are is known to whoever draws them alone: boxes have room for wide ones.
 */
#include "ui/render/legend.h"

#include <math.h>

#include "ui/render/colour_scale.h"
#include "ui/render/free_place.h"
#include "ui/render/svg.h"

#define HEIGHT_OF_PICTURE 720.0 /* for which sizes are given, pixels */
#define LETTERS 13.0            /* size of letters */
#define LEAST_LETTERS 9.0
#define MOST_LETTERS 60.0
#define SMALL_SHARE 0.8  /* of the size of letters, where there is no room for larger ones */
#define LINE_SHARE 1.35  /* height of a line, in sizes of letters */
#define WIDTH_SHARE 0.62 /* width of a letter: of a wide font */
#define BAR_SHARE 1.0    /* height of a bar, and what is left free below */
#define KEY_SHARE 0.6    /* side of a patch of colour */
#define LEAST_WIDTH 13   /* of a legend, in sizes of letters */
#define MARGIN_SHARE 0.7 /* around a legend, and inside */
#define STOPS 16         /* of the scale of colours */

const double spore_legend_ground[2][4] = {{0.04, 0.05, 0.055, 0.62}, {0.99, 0.99, 1, 0.8}};
const double spore_legend_letters[2][3] = {{0.91, 0.92, 0.93}, {0.11, 0.12, 0.13}};

guint spore_legend_rows(const SporeStageLegend *legend, gboolean brief, SporeLegendRow rows[SPORE_LEGEND_ROWS]) {
  guint count = 0;
  gboolean remarks = !brief || !legend->high;
  rows[count++] = (SporeLegendRow){.text = legend->label};
  if (legend->tint) rows[count++] = (SporeLegendRow){.kind = SPORE_LEGEND_TINT, .colour = spore_tint_colour};
  if (legend->high) {
    rows[count++] = (SporeLegendRow){.kind = SPORE_LEGEND_BAR};
    rows[count++] = (SporeLegendRow){.kind = SPORE_LEGEND_ENDS, .text = legend->low, .end_text = legend->high};
  }
  for (guint i = 0; i < legend->key_count; i++)
    rows[count++] =
        (SporeLegendRow){.kind = SPORE_LEGEND_KEY, .text = legend->keys[i].text, .colour = legend->keys[i].colour};
  if (remarks && legend->range) rows[count++] = (SporeLegendRow){.text = legend->range};
  if (remarks && legend->without) rows[count++] = (SporeLegendRow){.text = legend->without};
  return count;
}

/* Sizes. */

typedef struct Sheet {
  guint row_count;
  SporeLegendRow rows[SPORE_LEGEND_ROWS];
  double letters; /* size, pixels */
  SporePlace at;
} Sheet;

static double height_of_row(const Sheet *sheet, const SporeLegendRow *row) {
  gboolean bar = row->kind == SPORE_LEGEND_BAR || row->kind == SPORE_LEGEND_TINT;
  return (bar ? BAR_SHARE : LINE_SHARE) * sheet->letters;
}

static double width_of_row(const Sheet *sheet, const SporeLegendRow *row) {
  glong count = (row->text ? g_utf8_strlen(row->text, -1) : 0) + (row->end_text ? g_utf8_strlen(row->end_text, -1) : 0);
  if (row->kind == SPORE_LEGEND_ENDS || row->kind == SPORE_LEGEND_KEY) count += 2;
  return WIDTH_SHARE * sheet->letters * (double)count;
}

static Sheet write_sheet(const SporeStageLegend *legend, gboolean brief, double letters) {
  Sheet sheet = {.letters = letters};
  double width = LEAST_WIDTH * letters, height = 0;
  sheet.row_count = spore_legend_rows(legend, brief, sheet.rows);
  for (guint i = 0; i < sheet.row_count; i++) {
    width = fmax(width, width_of_row(&sheet, &sheet.rows[i]));
    height += height_of_row(&sheet, &sheet.rows[i]);
  }
  sheet.at.width = (int)ceil(width + 2 * MARGIN_SHARE * letters);
  sheet.at.height = (int)ceil(height + 2 * MARGIN_SHARE * letters);
  return sheet;
}

/* Returns how many found a place, which come first then. */
static guint lay(const SporeStageLegend *legends, guint count, gboolean brief, double letters, int width, int height,
                 Sheet *sheets) {
  guint laid = 0;
  SporePlace taken[SPORE_STAGE_LEGENDS];
  for (guint i = 0; i < count; i++) {
    Sheet sheet = write_sheet(&legends[i], brief, letters);
    int margin = (int)(MARGIN_SHARE * letters);
    const SporeAround around = {width, height, margin, margin, laid, taken};
    if (!spore_free_place_find(&around, &sheet.at)) continue;
    taken[laid] = sheet.at;
    sheets[laid++] = sheet;
  }
  return laid;
}

/* Drawings. Lengths are in whole pixels, which every locale writes alike. */

static void append_colour(GString *svg, const double colour[3]) {
  g_string_append_printf(svg, "rgb(%d,%d,%d)", (int)lround(255 * colour[0]), (int)lround(255 * colour[1]),
                         (int)lround(255 * colour[2]));
}

static void append_box(GString *svg, double x, double y, double width, double height, const double *colour,
                       const char *more) {
  g_string_append_printf(svg, "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" %s fill=\"", (int)lround(x),
                         (int)lround(y), (int)lround(width), (int)lround(height), more);
  if (colour) append_colour(svg, colour);
  else g_string_append(svg, "url(#scale)");
  g_string_append(svg, "\"/>");
}

static void append_text(GString *svg, const char *text, double x, double y, const char *anchor) {
  g_autofree char *escaped = g_markup_escape_text(text, -1);
  g_string_append_printf(svg, "<text x=\"%d\" y=\"%d\" text-anchor=\"%s\">%s</text>", (int)lround(x), (int)lround(y),
                         anchor, escaped);
}

static void append_scale(GString *svg) {
  g_string_append(svg, "<defs><linearGradient id=\"scale\">");
  for (int i = 0; i <= STOPS; i++) {
    double colour[3];
    spore_colour_scale((double)i / STOPS, colour);
    g_string_append_printf(svg, "<stop offset=\"%d%%\" stop-color=\"", 100 * i / STOPS);
    append_colour(svg, colour);
    g_string_append(svg, "\"/>");
  }
  g_string_append(svg, "</linearGradient></defs>");
}

/* y: its upper side. */
static void append_row(GString *svg, const Sheet *sheet, const SporeLegendRow *row, double x, double y, double width) {
  double letters = sheet->letters, base = y + letters, side = KEY_SHARE * letters;
  switch (row->kind) {
  case SPORE_LEGEND_BAR:
  case SPORE_LEGEND_TINT:
    append_box(svg, x, y + 0.15 * letters, width, 0.7 * letters, row->colour, "");
    return;
  case SPORE_LEGEND_ENDS:
    append_text(svg, row->end_text, x + width, base, "end");
    break;
  case SPORE_LEGEND_KEY:
    append_box(svg, x, base - side, side, side, row->colour, "stroke=\"black\" stroke-opacity=\"0.5\"");
    x += 2 * side;
    break;
  case SPORE_LEGEND_LINE:
    break;
  }
  append_text(svg, row->text, x, base, "start");
}

static char *draw_sheet(const Sheet *sheet, gboolean light) {
  double margin = MARGIN_SHARE * sheet->letters, width = sheet->at.width - 2 * margin, y = margin;
  GString *svg = g_string_new(NULL);
  g_string_append_printf(svg, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\">", sheet->at.width,
                         sheet->at.height);
  append_scale(svg);
  g_autofree char *opacity = g_strdup_printf("fill-opacity=\"%d%%\"", (int)lround(100 * spore_legend_ground[light][3]));
  append_box(svg, 0, 0, sheet->at.width, sheet->at.height, spore_legend_ground[light], opacity);
  g_string_append_printf(svg, "<g font-family=\"sans-serif\" font-size=\"%d\" fill=\"", (int)lround(sheet->letters));
  append_colour(svg, spore_legend_letters[light]);
  g_string_append(svg, "\">");
  for (guint i = 0; i < sheet->row_count; i++) {
    append_row(svg, sheet, &sheet->rows[i], margin, y, width);
    y += height_of_row(sheet, &sheet->rows[i]);
  }
  g_string_append(svg, "</g></svg>");
  return g_string_free(svg, FALSE);
}

guint spore_legends_draw(const SporeStageLegend *legends, guint count, gboolean light, guint8 *pixels, int width,
                         int height, gsize stride, GError **error) {
  Sheet sheets[SPORE_STAGE_LEGENDS];
  double letters = round(CLAMP(LETTERS * height / HEIGHT_OF_PICTURE, LEAST_LETTERS, MOST_LETTERS));
  guint laid = lay(legends, count, FALSE, letters, width, height, sheets);
  if (laid < count) {
    letters = fmax(round(SMALL_SHARE * letters), LEAST_LETTERS);
    laid = lay(legends, count, TRUE, letters, width, height, sheets);
  }
  for (guint i = 0; i < laid; i++) {
    g_autofree char *svg = draw_sheet(&sheets[i], light);
    if (!spore_svg_draw_over(svg, pixels + (gsize)sheets[i].at.y * stride + 4 * (gsize)sheets[i].at.x,
                             sheets[i].at.width, sheets[i].at.height, stride, error))
      return G_MAXUINT;
  }
  return count - laid;
}
