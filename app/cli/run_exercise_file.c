/* The report of an exercise as a file: a table, an object, or a page with plots in it. */
#include <glib/gi18n.h>
#include <json-glib/json-glib.h>
#include <math.h>
#include <stdio.h>

#include "app/cli/run_exercise.h"
#include "core/base/number.h"
#include "core/io/scene_xml.h"

gboolean spore_exercise_file_check(const char *file, const char *scene, const char *input, GError **error) {
  if (!g_str_has_suffix(file, ".csv") && !g_str_has_suffix(file, ".json") && !g_str_has_suffix(file, ".html"))
    return spore_error_raise(error, SPORE_ERROR_INPUT, file,
                             _("--report takes the kind of file from its name; expected .csv, .json or .html; name "
                               "such a file"));
  return spore_cli_has_room(file, scene, error) && (!input || spore_cli_has_room(file, input, error));
}

/* A cell of a table; what is no number is left empty. */
static void add_number(GString *text, double value) {
  char number[SPORE_NUMBER_TEXT];
  spore_number_format(value, number);
  g_string_append(text, isfinite(value) ? number : "");
}

static void add_quoted(GString *text, const char *value) {
  g_autofree char *doubled = NULL;
  g_auto(GStrv) parts = g_strsplit(value ? value : "", "\"", -1);
  doubled = g_strjoinv("\"\"", parts);
  g_string_append_printf(text, "\"%s\"", doubled);
}

static void table(GString *text, const SporeExercise *exercise) {
  SporeExerciseState state = spore_exercise_state(exercise);
  g_string_append(text, "part,name,kind,value,unit,good,pass,mark,verdict,source\n");
  for (gsize i = 0; i < state.steps; i++) {
    SporeStepState step = spore_exercise_step_state(exercise, i);
    g_string_append_printf(text, "step,%s,%s,", step.name, step.kind->element);
    add_number(text, step.done_s);
    g_string_append_printf(text, ",s,,,,%s,\n", spore_step_phase_names[step.phase]);
  }
  for (gsize i = 0; i < state.metrics; i++) {
    SporeMetricState metric = spore_exercise_metric_state(exercise, i);
    g_string_append_printf(text, "metric,%s,%s,", metric.name, metric.kind->element);
    add_number(text, metric.value);
    g_string_append_printf(text, ",%s,", metric.unit);
    const double cells[] = {metric.good, metric.pass, metric.mark};
    for (gsize k = 0; k < G_N_ELEMENTS(cells); k++) add_number(text, cells[k]), g_string_append_c(text, ',');
    g_string_append_printf(text, "%s,", spore_metric_verdict_names[metric.verdict]);
    add_quoted(text, metric.source);
    g_string_append_c(text, '\n');
  }
  g_string_append(text, "score,,,");
  add_number(text, state.score);
  g_string_append_printf(text, ",,,,,%s,\n", state.passed ? "pass" : "fail");
}

/* The page. */

#define WIDTH 600.0 /* of a plot, pixels */
#define ROW 24.0    /* height of a row */
#define TEXT 180.0  /* width of the names */

static void add_escaped(GString *text, const char *value) {
  g_autofree char *escaped = g_markup_escape_text(value ? value : "", -1);
  g_string_append(text, escaped);
}

/* A row's name, and the beginning of its plot. */
static void begin_row(GString *text, gsize row, const char *name) {
  g_string_append_printf(text, "<text x=\"0\" y=\"%g\">", ROW * (double)row + 16);
  add_escaped(text, name);
  g_string_append(text, "</text>");
}

static void add_bar(GString *text, gsize row, double share, const char *colour) {
  g_string_append_printf(text, "<rect x=\"%g\" y=\"%g\" width=\"%.1f\" height=\"%g\" fill=\"%s\"/>", TEXT,
                         ROW * (double)row + 4, (WIDTH - TEXT) * CLAMP(share, 0, 1), ROW - 8, colour);
}

static void begin_plot(GString *text, const char *title, gsize rows) {
  g_string_append_printf(text, "<h2>%s</h2>\n<svg width=\"%g\" height=\"%g\" font-size=\"13\">", title, WIDTH + 80,
                         ROW * (double)rows);
}

/* When each step was done, as a share of the time. */
static void plot_steps(GString *text, const SporeExercise *exercise, const SporeExerciseState *state) {
  begin_plot(text, _("Steps"), state->steps);
  for (gsize i = 0; i < state->steps; i++) {
    SporeStepState step = spore_exercise_step_state(exercise, i);
    begin_row(text, i, step.name);
    if (step.phase != SPORE_STEP_DONE) continue;
    add_bar(text, i, state->time_s > 0 ? step.done_s / state->time_s : 0, "#4477aa");
    g_string_append_printf(text, "<text x=\"%g\" y=\"%g\">%.2f s</text>", WIDTH + 6, ROW * (double)i + 16, step.done_s);
  }
  g_string_append(text, "</svg>\n");
}

/* The mark of each metric, 0 to 1. */
static void plot_metrics(GString *text, const SporeExercise *exercise, const SporeExerciseState *state) {
  static const char *const colours[SPORE_METRIC_VERDICTS] = {"#bbbbbb", "#228833", "#ccbb44", "#cc3311"};
  begin_plot(text, _("Marks"), state->metrics);
  for (gsize i = 0; i < state->metrics; i++) {
    SporeMetricState metric = spore_exercise_metric_state(exercise, i);
    begin_row(text, i, metric.name);
    if (metric.verdict == SPORE_METRIC_NONE) continue;
    add_bar(text, i, metric.mark, colours[metric.verdict]);
    g_string_append_printf(text, "<text x=\"%g\" y=\"%g\">%.2f</text>", WIDTH + 6, ROW * (double)i + 16, metric.mark);
  }
  g_string_append(text, "</svg>\n");
}

static void add_cell(GString *text, double value) {
  g_string_append(text, "<td>");
  if (isfinite(value)) g_string_append_printf(text, "%.4g", value);
  g_string_append(text, "</td>");
}

static void add_metrics(GString *text, const SporeExercise *exercise, const SporeExerciseState *state) {
  g_string_append_printf(text, "<table><tr><th>%s</th><th>%s</th><th>%s</th><th>%s</th><th>%s</th><th>%s</th></tr>\n",
                         _("metric"), _("value"), _("unit"), _("good"), _("pass"), _("source"));
  for (gsize i = 0; i < state->metrics; i++) {
    SporeMetricState metric = spore_exercise_metric_state(exercise, i);
    g_string_append(text, "<tr><td>");
    add_escaped(text, metric.name);
    g_string_append(text, "</td>");
    add_cell(text, metric.value);
    g_string_append_printf(text, "<td>%s</td>", metric.unit);
    add_cell(text, metric.good);
    add_cell(text, metric.pass);
    g_string_append(text, "<td>");
    add_escaped(text, metric.source);
    g_string_append(text, "</td></tr>\n");
  }
  g_string_append(text, "</table>\n");
}

static void page(GString *text, const SporeExercise *exercise, const char *scene) {
  SporeExerciseState state = spore_exercise_state(exercise);
  g_autofree char *name = g_filename_display_basename(scene);
  g_string_append(text, "<!DOCTYPE html>\n<html><head><meta charset=\"utf-8\"/><title>");
  add_escaped(text, name);
  g_string_append(text, "</title><style>body{font-family:sans-serif;margin:2em}td,th{padding:2px 10px;text-align:left}"
                        "</style></head><body>\n<h1>");
  add_escaped(text, name);
  g_string_append_printf(text, "</h1>\n<p>%s</p>\n<p>", _("For training and preview only."));
  g_string_append_printf(text, _("%zu of %zu steps done in %.2f s, score %.1f of 100"), state.steps_done, state.steps,
                         state.time_s, state.score);
  g_string_append(text, "</p>\n");
  plot_steps(text, exercise, &state);
  plot_metrics(text, exercise, &state);
  add_metrics(text, exercise, &state);
  g_string_append(text, "</body></html>\n");
}

/* The member `exercise` of the command's report. */
static char *object(const SporeExercise *exercise) {
  g_autoptr(JsonBuilder) builder = json_builder_new();
  SporeCli cli = {.report = builder, .quiet = TRUE};
  json_builder_begin_object(builder);
  spore_run_report_exercise(&cli, exercise);
  json_builder_end_object(builder);
  g_autoptr(JsonNode) root = json_builder_get_root(builder);
  return json_to_string(root, TRUE);
}

int spore_exercise_file_save(const SporeCli *cli, const SporeExercise *exercise, const char *scene, const char *file) {
  GError *error = NULL;
  if (spore_cli_interrupted()) {
    fprintf(stderr, _("%s: interrupted; the report was not written, and what was there stays\n"), file);
    return SPORE_EXIT_INTERRUPTED;
  }
  g_autoptr(GString) text = g_string_new(NULL);
  if (g_str_has_suffix(file, ".csv")) table(text, exercise);
  else if (g_str_has_suffix(file, ".html")) page(text, exercise, scene);
  else {
    g_autofree char *json = object(exercise);
    g_string_append_printf(text, "%s\n", json);
  }
  if (!spore_write_file(file, text->str, text->len, &error)) return spore_cli_fail(error);
  spore_cli_say(cli, _("%s: the report of the exercise\n"), file);
  return SPORE_EXIT_DONE;
}
