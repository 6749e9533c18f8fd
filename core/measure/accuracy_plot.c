/* Work-precision plot of an accuracy study: error over step, and error over cost. */
#include <math.h>
#include <stdio.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/measure/accuracy.h"
#include "core/measure/plot.h"

/* A line a method and level. Points whose error is not a number stand above all others. */
typedef struct SporeAccuracyPlotData {
  SporePlotLine *by_step, *by_cost;
  size_t count, *first;
  double *step, *cost, *error;
  bool *hollow, *ringed;
  char (*labels)[SPORE_ACCURACY_LABEL + 20];
} Lines;

static bool allocate(Lines *lines, size_t points) {
  lines->by_step = SPORE_NEW_ARRAY(SporePlotLine, points);
  lines->by_cost = SPORE_NEW_ARRAY(SporePlotLine, points);
  lines->step = SPORE_NEW_ARRAY(double, points);
  lines->cost = SPORE_NEW_ARRAY(double, points);
  lines->error = SPORE_NEW_ARRAY(double, points);
  lines->hollow = SPORE_NEW_ARRAY(bool, points);
  lines->ringed = SPORE_NEW_ARRAY(bool, points);
  lines->first = SPORE_NEW_ARRAY(size_t, points);
  lines->labels = spore_allocate(points, sizeof *lines->labels);
  return lines->by_step && lines->by_cost && lines->step && lines->cost && lines->error && lines->hollow &&
         lines->ringed && lines->first && lines->labels;
}

static void clear(Lines *lines) {
  void *const all[] = {lines->by_step, lines->by_cost, lines->step,  lines->cost,  lines->error,
                       lines->hollow,  lines->ringed,  lines->first, lines->labels};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) spore_free(all[i]);
}

/* Of all errors that are numbers. */
static double largest_error(const SporeAccuracyReport *report) {
  double most = 0;
  for (size_t i = 0; i < report->point_count; i++)
    if (isfinite(report->points[i].error)) most = fmax(most, report->points[i].error);
  return most > 0 ? most : 1;
}

static void add_line(Lines *lines, const SporeAccuracyReport *report, size_t first, size_t count) {
  const SporeAccuracyPoint *point = &report->points[first];
  char *label = lines->labels[lines->count];
  snprintf(label, sizeof *lines->labels, "%s%s%s", report->methods[point->method].label, point->level < 0 ? "" : " ",
           point->level < 0 ? "" : spore_lod_names[point->level]);
  SporePlotLine line = {.label = label,
                        .count = count,
                        .x = lines->step + first,
                        .y = lines->error + first,
                        .hollow = lines->hollow + first,
                        .ringed = lines->ringed + first};
  lines->first[lines->count] = first;
  lines->by_step[lines->count] = line;
  line.x = lines->cost + first;
  lines->by_cost[lines->count++] = line;
}

static void fill(Lines *lines, const SporeAccuracyReport *report) {
  double beyond = 3 * largest_error(report);
  for (size_t i = 0, first = 0; i < report->point_count; i++) {
    const SporeAccuracyPoint *point = &report->points[i];
    bool last = i + 1 == report->point_count || point[1].method != point->method || point[1].level != point->level;
    lines->step[i] = 1e3 * point->dt_s;
    lines->cost[i] = point->cost;
    lines->error[i] = 100 * (isfinite(point->error) ? fmax(point->error, 1e-14) : beyond);
    lines->hollow[i] = !point->sound;
    lines->ringed[i] = point->pareto;
    if (!last) continue;
    add_line(lines, report, first, i + 1 - first);
    first = i + 1;
  }
}

static void set_panels(SporeAccuracyPlot *plot, const SporeAccuracyReport *report, const Lines *lines) {
  const SporePlotPanel both = {.y_label = report->statistics ? _("error of mean places (percent of a body's length)")
                                                             : _("error (percent of a body's length)"),
                               .log_x = true,
                               .log_y = true,
                               .line_count = lines->count,
                               .shade_below = 100 * report->floor,
                               .shade_label = _("cannot be told")};
  plot->panels[0] = plot->panels[1] = both;
  plot->panels[0].x_label = _("step (ms)");
  plot->panels[0].lines = lines->by_step;
  plot->panels[0].label_lines = true;
  plot->panels[1].x_label = _("time on the processor for a simulated second (s)");
  plot->panels[1].lines = lines->by_cost;
  plot->panels[1].mark_label = _("real time");
  plot->panels[1].mark_x = 1;
}

bool spore_accuracy_plot_make(SporeAccuracyPlot *plot, const SporeAccuracyReport *report, SporeError *error) {
  *plot = (SporeAccuracyPlot){.data = SPORE_NEW(Lines)};
  if (plot->data && allocate(plot->data, report->point_count)) {
    fill(plot->data, report);
    set_panels(plot, report, plot->data);
    plot->first = plot->data->first;
    return true;
  }
  spore_accuracy_plot_clear(plot);
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a plot"));
}

void spore_accuracy_plot_clear(SporeAccuracyPlot *plot) {
  if (plot->data) clear(plot->data);
  spore_free(plot->data);
  *plot = (SporeAccuracyPlot){0};
}

char *spore_accuracy_svg(const SporeAccuracyReport *report, const char *title, SporeError *error) {
  SporeAccuracyPlot plot;
  char note[1024];
  if (!spore_accuracy_plot_make(&plot, report, error)) return NULL;
  snprintf(note, sizeof note, "%s\n%s", report->sentence ? report->sentence : "",
           _("Ringed: the Pareto set. Empty: not stable, not solved as written, or its energy far off.\n"
             "In grey: what cannot be told from the reference's own error."));
  char *svg = spore_plot_svg(title, note, plot.panels, sizeof plot.panels / sizeof *plot.panels, error);
  spore_accuracy_plot_clear(&plot);
  return svg;
}
