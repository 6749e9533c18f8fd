/* The report of an exercise as a file: a table, an object, or a page with plots in it. */
#include "core/author/exercise_report.h"

#include <glib/gi18n.h>
#include <math.h>

#include "core/base/number.h"
#include "core/scene/error.h"

gboolean spore_exercise_report_names(const char *file, GError **error) {
  return g_str_has_suffix(file, ".csv") || g_str_has_suffix(file, ".json") || g_str_has_suffix(file, ".html") ||
         spore_error_raise(error, SPORE_ERROR_INPUT, file,
                           _("a report takes the kind of file from its name; expected .csv, .json or .html; name such "
                             "a file"));
}

/* The object. */

static void add_known(JsonBuilder *builder, const char *member, double value) {
  if (!isfinite(value)) return;
  json_builder_set_member_name(builder, member);
  json_builder_add_double_value(builder, value);
}

static void add_text(JsonBuilder *builder, const char *member, const char *value) {
  if (!value) return;
  json_builder_set_member_name(builder, member);
  json_builder_add_string_value(builder, value);
}

static void add_step(JsonBuilder *builder, const SporeStepState *step) {
  json_builder_begin_object(builder);
  add_text(builder, "name", step->name);
  add_text(builder, "kind", step->kind->element);
  add_text(builder, "phase", spore_step_phase_names[step->phase]);
  add_known(builder, "done_s", step->done_s);
  json_builder_set_member_name(builder, "early");
  json_builder_add_int_value(builder, (gint64)step->early);
  json_builder_set_member_name(builder, "lost");
  json_builder_add_int_value(builder, (gint64)step->lost);
  add_text(builder, "hint", step->hint);
  json_builder_end_object(builder);
}

static void add_metric(JsonBuilder *builder, const SporeMetricState *metric) {
  json_builder_begin_object(builder);
  add_text(builder, "name", metric->name);
  add_text(builder, "kind", metric->kind->element);
  json_builder_set_member_name(builder, "value");
  if (isfinite(metric->value)) json_builder_add_double_value(builder, metric->value);
  else json_builder_add_null_value(builder);
  add_text(builder, "unit", metric->unit);
  add_known(builder, "good", metric->good);
  add_known(builder, "pass", metric->pass);
  add_known(builder, "mark", metric->mark);
  add_text(builder, "verdict", spore_metric_verdict_names[metric->verdict]);
  add_text(builder, "source", metric->source);
  json_builder_end_object(builder);
}

void spore_exercise_report_add(const SporeExercise *exercise, JsonBuilder *builder) {
  SporeExerciseState state = spore_exercise_state(exercise);
  json_builder_set_member_name(builder, "exercise");
  json_builder_begin_object(builder);
  add_text(builder, "phase", spore_exercise_phase_names[state.phase]);
  add_known(builder, "time_s", state.time_s);
  add_known(builder, "score", state.score);
  json_builder_set_member_name(builder, "passed");
  json_builder_add_boolean_value(builder, state.passed);
  if (state.tried) { /* a run from the command line is none */
    json_builder_set_member_name(builder, "tried");
    json_builder_add_boolean_value(builder, TRUE);
  }
  json_builder_set_member_name(builder, "steps");
  json_builder_begin_array(builder);
  for (gsize i = 0; i < state.steps; i++) {
    SporeStepState step = spore_exercise_step_state(exercise, i);
    add_step(builder, &step);
  }
  json_builder_end_array(builder);
  json_builder_set_member_name(builder, "metrics");
  json_builder_begin_array(builder);
  for (gsize i = 0; i < state.metrics; i++) {
    SporeMetricState metric = spore_exercise_metric_state(exercise, i);
    add_metric(builder, &metric);
  }
  json_builder_end_array(builder);
  json_builder_end_object(builder);
}

static void object(GString *text, const SporeExercise *exercise) {
  g_autoptr(JsonBuilder) builder = json_builder_new();
  json_builder_begin_object(builder);
  spore_exercise_report_add(exercise, builder);
  json_builder_end_object(builder);
  g_autoptr(JsonNode) root = json_builder_get_root(builder);
  g_autofree char *json = json_to_string(root, TRUE);
  g_string_append_printf(text, "%s\n", json);
}

/* The table. */

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
  static const char *const colours[SPORE_METRIC_VERDICTS] = {"#bbbbbb", "#228833", "#ccbb44", "#cc3311", "#bbbbbb"};
  begin_plot(text, _("Marks"), state->metrics);
  for (gsize i = 0; i < state->metrics; i++) {
    SporeMetricState metric = spore_exercise_metric_state(exercise, i);
    begin_row(text, i, metric.name);
    if (metric.verdict == SPORE_METRIC_NONE) continue;
    add_bar(text, i, metric.mark, colours[metric.verdict]);
    g_autofree char *mark =
        metric.verdict == SPORE_METRIC_UNFINISHED ? g_strdup(_("not finished")) : g_strdup_printf("%.2f", metric.mark);
    g_string_append_printf(text, "<text x=\"%g\" y=\"%g\">", WIDTH + 6, ROW * (double)i + 16);
    add_escaped(text, mark);
    g_string_append(text, "</text>");
  }
  g_string_append(text, "</svg>\n");
}

static void add_cell(GString *text, double value) {
  g_string_append(text, "<td>");
  if (isfinite(value)) g_string_append_printf(text, "%.4g", value);
  g_string_append(text, "</td>");
}

static void list_metrics(GString *text, const SporeExercise *exercise, const SporeExerciseState *state) {
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

/* The moments that counted: a picture for each step that was done and drawn. */
static void show_pictures(GString *text, const SporeExercise *exercise, const SporeReportPictures *pictures) {
  gsize count = spore_exercise_state(exercise).steps;
  for (gsize i = 0; i < MIN(count, pictures->of_step->len); i++) {
    SporeStepState step = spore_exercise_step_state(exercise, i);
    GBytes *picture = pictures->of_step->pdata[i];
    if (!picture || step.phase != SPORE_STEP_DONE) continue;
    g_autofree char *data = g_base64_encode(g_bytes_get_data(picture, NULL), g_bytes_get_size(picture));
    g_string_append_printf(text, "<figure><img alt=\"\" src=\"data:image/png;base64,%s\"/><figcaption>", data);
    add_escaped(text, step.name);
    g_string_append_printf(text, ", %.2f s</figcaption></figure>\n", step.done_s);
  }
  if (!pictures->fault) return;
  g_string_append_printf(text, "<p>%s ", _("Pictures are missing:"));
  add_escaped(text, pictures->fault);
  g_string_append(text, "</p>\n");
}

static void page(GString *text, const SporeExercise *exercise, const char *title, const SporeReportPictures *pictures) {
  SporeExerciseState state = spore_exercise_state(exercise);
  g_string_append(text, "<!DOCTYPE html>\n<html><head><meta charset=\"utf-8\"/><title>");
  add_escaped(text, title);
  g_string_append(text, "</title><style>body{font-family:sans-serif;margin:2em}td,th{padding:2px 10px;text-align:left}"
                        "figure{display:inline-block;margin:4px}"
                        "</style></head><body>\n<h1>");
  add_escaped(text, title);
  g_string_append_printf(text, "</h1>\n<p>%s</p>\n<p>", _("For training and preview only."));
  g_string_append_printf(text, _("%zu of %zu steps done in %.2f s, score %.1f of 100"), state.steps_done, state.steps,
                         state.time_s, state.score);
  if (state.tried)
    g_string_append_printf(
        text, "</p>\n<p>%s",
        _("A try-out: steps were skipped and count as done, or the scene was changed or pulled at meanwhile."));
  g_string_append(text, "</p>\n");
  plot_steps(text, exercise, &state);
  if (pictures) show_pictures(text, exercise, pictures);
  plot_metrics(text, exercise, &state);
  list_metrics(text, exercise, &state);
  g_string_append(text, "</body></html>\n");
}

char *spore_exercise_report(const SporeExercise *exercise, const char *title, const char *file,
                            const SporeReportPictures *pictures) {
  GString *text = g_string_new(NULL);
  if (g_str_has_suffix(file, ".csv")) table(text, exercise);
  else if (g_str_has_suffix(file, ".html")) page(text, exercise, title, pictures);
  else object(text, exercise);
  return g_string_free(text, FALSE);
}
