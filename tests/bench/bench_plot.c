/* bench_plot: draws a plot in the way of the program's own, for benchmarks that are no scenes.
 *
 * Reads lines of words apart by tabs: `title TEXT`, `note TEXT`, `panel X-LABEL Y-LABEL` with both axes logarithmic,
 * then of each panel `line LABEL` and its points `point X Y`. Writes the SVG. */
#include <glib.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/measure/plot.h"

typedef struct Points {
  char *label;
  GArray *x, *y;
} Points;

typedef struct Panel {
  char *x_label, *y_label;
  GPtrArray *lines; /* Points */
} Panel;

typedef struct Drawing {
  char *title, *note;
  GPtrArray *panels; /* Panel */
} Drawing;

static void refuse(const char *line) {
  fprintf(stderr, "bench_plot: '%s' is no line of a plot\n", line);
  exit(2);
}

static Points *last_line(const Drawing *drawing, const char *text) {
  Panel *panel = drawing->panels->len ? g_ptr_array_index(drawing->panels, drawing->panels->len - 1) : NULL;
  if (!panel || !panel->lines->len) refuse(text);
  return g_ptr_array_index(panel->lines, panel->lines->len - 1);
}

static void add_panel(Drawing *drawing, char **words) {
  Panel *panel = g_new0(Panel, 1);
  panel->x_label = g_strdup(words[1]), panel->y_label = g_strdup(words[2]);
  panel->lines = g_ptr_array_new();
  g_ptr_array_add(drawing->panels, panel);
}

static void add_line(Drawing *drawing, const char *label, const char *text) {
  if (!drawing->panels->len) refuse(text);
  Panel *panel = g_ptr_array_index(drawing->panels, drawing->panels->len - 1);
  Points *points = g_new0(Points, 1);
  points->label = g_strdup(label);
  points->x = g_array_new(FALSE, FALSE, sizeof(double)), points->y = g_array_new(FALSE, FALSE, sizeof(double));
  g_ptr_array_add(panel->lines, points);
}

static void add_point(Drawing *drawing, char **words, const char *text) {
  Points *points = last_line(drawing, text);
  double x = g_ascii_strtod(words[1], NULL), y = g_ascii_strtod(words[2], NULL);
  g_array_append_val(points->x, x);
  g_array_append_val(points->y, y);
}

static void read_line(Drawing *drawing, const char *text) {
  g_auto(GStrv) words = g_strsplit(text, "\t", -1);
  guint count = g_strv_length(words);
  if (count == 2 && !strcmp(words[0], "title")) drawing->title = g_strdup(words[1]);
  else if (count == 2 && !strcmp(words[0], "note")) drawing->note = g_strdup(words[1]);
  else if (count == 3 && !strcmp(words[0], "panel")) add_panel(drawing, words);
  else if (count == 2 && !strcmp(words[0], "line")) add_line(drawing, words[1], text);
  else if (count == 3 && !strcmp(words[0], "point")) add_point(drawing, words, text);
  else refuse(text);
}

static SporePlotPanel panel_of(const Panel *panel) {
  SporePlotLine *lines = g_new0(SporePlotLine, panel->lines->len);
  for (guint i = 0; i < panel->lines->len; i++) {
    const Points *points = g_ptr_array_index(panel->lines, i);
    lines[i] = (SporePlotLine){.label = points->label,
                               .count = points->x->len,
                               .x = (const double *)(gconstpointer)points->x->data,
                               .y = (const double *)(gconstpointer)points->y->data};
  }
  return (SporePlotPanel){.x_label = panel->x_label,
                          .y_label = panel->y_label,
                          .log_x = true,
                          .log_y = true,
                          .lines = lines,
                          .line_count = panel->lines->len,
                          .label_lines = true};
}

int main(void) {
  Drawing drawing = {.panels = g_ptr_array_new()};
  char text[4096];
  while (fgets(text, sizeof text, stdin)) read_line(&drawing, g_strchomp(text));
  SporePlotPanel *panels = g_new0(SporePlotPanel, drawing.panels->len + 1);
  for (guint i = 0; i < drawing.panels->len; i++) panels[i] = panel_of(g_ptr_array_index(drawing.panels, i));
  SporeError error = SPORE_ERROR_INIT;
  char *svg = spore_plot_svg(drawing.title, drawing.note, panels, drawing.panels->len, &error);
  if (!svg) {
    fprintf(stderr, "bench_plot: %s\n", error.message);
    return 1;
  }
  fputs(svg, stdout);
  spore_free(svg);
  return 0;
}
