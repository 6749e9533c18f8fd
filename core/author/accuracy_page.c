/* The report of an accuracy study in words, as a table, and as a page with the plot in it. */
#include "core/author/accuracy_page.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/number.h"
#include "core/scene/error.h"

const char *spore_accuracy_level_name(int level) { return level < 0 ? NULL : spore_lod_names[level]; }

static int compare_costs(gconstpointer a, gconstpointer b, gpointer data) {
  const SporeAccuracyReport *report = data;
  double x = report->points[*(const guint *)a].cost, y = report->points[*(const guint *)b].cost;
  return (x > y) - (x < y);
}

GArray *spore_accuracy_pareto(const SporeAccuracyReport *report) {
  GArray *set = g_array_new(FALSE, FALSE, sizeof(guint));
  for (guint i = 0; i < report->point_count; i++)
    if (report->points[i].pareto) g_array_append_val(set, i);
  g_array_sort_with_data(set, compare_costs, (gpointer)report);
  return set;
}

char *spore_accuracy_describe(const SporeAccuracyReport *report) {
  const SporeAccuracyReference *reference = &report->reference;
  GString *text = g_string_new(NULL);
  g_string_append_printf(text, _("stretch: %.3g s of the input from %.3g s on, %.3g contacts a step\n"), report->time_s,
                         report->start_s, report->contacts);
  g_string_append_printf(text, _("reference: %s at %.3g ms, itself %.2g %% off at most\n"),
                         report->methods[reference->method].label, 1e3 * reference->dt_s, 100 * reference->own_error);
  if (reference->cross_method >= report->method_count)
    g_string_append(text, _("no second method could be had that comes to the same; name several in --methods\n"));
  else
    g_string_append_printf(text,
                           reference->agreed ? _("%s at %.3g ms comes to the same within %.2g %%\n")
                                             : _("%s at %.3g ms differs from it by %.2g %%, more than both say of "
                                                 "themselves: the reference counts as that far off\n"),
                           report->methods[reference->cross_method].label, 1e3 * reference->cross_dt_s,
                           100 * reference->cross_difference);
  if (report->statistics)
    g_string_append_printf(text,
                           _("chaotic: a start moved by 1e-8 moves the bodies by %.2g %%; errors are of mean places, "
                             "which spread by %.2g %%\n"),
                           100 * report->growth, 100 * report->spread);
  g_string_append_printf(text, _("errors below %.2g %% cannot be told from the reference's\n"), 100 * report->floor);
  if (reference->gap > 0)
    g_string_append_printf(text, _("links part by %.2g mm at most in the reference\n"), 1e3 * reference->gap);
  if (!isnan(reference->line_stretch))
    g_string_append_printf(text, _("lines stretch by %.2g %% at most in the reference\n"),
                           100 * reference->line_stretch);
  return g_string_free(text, FALSE);
}

const char *spore_accuracy_remark(const SporeAccuracyPoint *point) {
  if (!point->stable) return _("not stable");
  if (point->pareto) return _("Pareto");
  if (!point->resolved) return _("below what can be told");
  if (!point->as_written) return _("some steps not as written");
  return point->sound ? "" : _("energy far off");
}

char *spore_accuracy_describe_methods(const SporeAccuracyReport *report) {
  GString *text = g_string_new(NULL);
  for (gsize m = 0; m < report->method_count; m++) {
    const SporeAccuracyFit *fit = &report->methods[m];
    if (fit->alike != m)
      g_string_append_printf(text, _("%s moves the bodies as %s does here\n"), fit->label,
                             report->methods[fit->alike].label);
    if (fit->alike != m || isnan(fit->order)) continue;
    g_string_append_printf(
        text, _("order of %s: %.2g +- %.1g (%g where forces are smooth)%s\n"), fit->label, fit->order,
        fit->order_spread, fit->nominal,
        fit->converges ? "" : _(": at these steps smaller ones do not help, while another method is much nearer"));
  }
  for (gsize i = 0; i < report->level_count; i++)
    g_string_append_printf(text, _("level %s: %.2g %% off in space\n"),
                           spore_accuracy_level_name(report->levels[i].level), 100 * report->levels[i].error);
  for (gsize i = 0; i < report->cut_count; i++) g_string_append_printf(text, _("cut: %s\n"), report->cuts[i]);
  return g_string_free(text, FALSE);
}

char *spore_accuracy_describe_spheres(const SporeAccuracyReport *report) {
  GString *text = g_string_new(NULL);
  for (gsize i = 0; i < report->sphere_count; i++) {
    const SporeAccuracySpheres *spheres = &report->spheres[i];
    gboolean finest = i + 1 == report->sphere_count;
    g_string_append_printf(text, _("%zu spheres (%g times): "), spheres->count, spheres->factor);
    if (isnan(spheres->force)) g_string_append(text, _("nothing touches"));
    else
      g_string_append_printf(text, _("contact forces %.2g %% off, depth %.2g %%"), 100 * spheres->force,
                             100 * spheres->depth);
    g_string_append_printf(text, _(", places %.2g %%"), 100 * spheres->error);
    g_string_append(text, finest ? _(": by the steps alone, the others are measured from it\n") : "\n");
  }
  return g_string_free(text, FALSE);
}

static void append_number(GString *text, double value) {
  char digits[SPORE_NUMBER_TEXT];
  spore_number_format(value, digits);
  g_string_append_printf(text, ",%s", isfinite(value) ? digits : "");
}

char *spore_accuracy_csv(const SporeAccuracyReport *report) {
  GString *text =
      g_string_new("method,level,dt_s,error,final,worst,energy_drift,penetration,gap_m,line_stretch,us_per_step,p99_us,"
                   "real_time_factor,cpu_s,force_evaluations,newton,linear,stable,as_written,sound,resolved,"
                   "pareto,repeats\n");
  for (gsize i = 0; i < report->point_count; i++) {
    const SporeAccuracyPoint *p = &report->points[i];
    const double row[] = {p->dt_s,
                          p->error,
                          p->final,
                          p->worst,
                          p->energy_drift,
                          p->penetration,
                          p->gap,
                          p->line_stretch,
                          p->us_per_step,
                          p->p99_us,
                          p->real_time_factor,
                          p->cost,
                          p->force_evaluations,
                          p->newton,
                          p->linear};
    g_string_append_printf(text, "%s,%s", report->methods[p->method].label,
                           p->level < 0 ? "" : spore_accuracy_level_name(p->level));
    for (gsize k = 0; k < G_N_ELEMENTS(row); k++) append_number(text, row[k]);
    g_string_append_printf(text, ",%d,%d,%d,%d,%d,%zu\n", p->stable, p->as_written, p->sound, p->resolved, p->pareto,
                           p->repeats);
  }
  return g_string_free(text, FALSE);
}

char *spore_accuracy_plot(const char *scene, const SporeAccuracyReport *report, GError **error) {
  g_autofree char *name = g_path_get_basename(scene), *title = g_strdup_printf(_("Accuracy of %s"), name);
  SporeError fault = SPORE_ERROR_INIT;
  char *svg = spore_accuracy_svg(report, title, &fault), *text = g_strdup(svg);
  if (!svg) spore_error_propagate(&fault, error);
  spore_free(svg);
  return text;
}

/* The page. */

static void append_cell(GString *page, double value) { g_string_append_printf(page, "<td>%.3g</td>", value); }

/* What the scene may not have at all. */
static void append_known(GString *page, double value, double scale) {
  if (isnan(value)) g_string_append(page, "<td></td>");
  else append_cell(page, scale * value);
}

static void append_table(GString *page, const SporeAccuracyReport *report) {
  const char *const heads[] = {_("method"),    _("step ms"),   _("level"),  _("error %"),
                               _("energy %"),  _("depth"),     _("gap mm"), _("stretch %"),
                               _("us a step"), _("real time"), ""};
  g_string_append(page, "<table>\n<tr>");
  for (gsize i = 0; i < G_N_ELEMENTS(heads); i++) g_string_append_printf(page, "<th>%s</th>", heads[i]);
  g_string_append(page, "</tr>\n");
  for (gsize i = 0; i < report->point_count; i++) {
    const SporeAccuracyPoint *point = &report->points[i];
    g_string_append_printf(page, "<tr%s><td>%s</td><td>%.4g</td><td>%s</td>",
                           point->pareto     ? " class=\"pareto\""
                           : point->resolved ? ""
                                             : " class=\"shaded\"",
                           report->methods[point->method].label, 1e3 * point->dt_s,
                           point->level < 0 ? "" : spore_accuracy_level_name(point->level));
    append_cell(page, 100 * point->error);
    append_cell(page, 100 * point->energy_drift);
    append_cell(page, point->penetration);
    append_known(page, point->gap, 1e3);
    append_known(page, point->line_stretch, 100);
    append_cell(page, point->us_per_step);
    append_cell(page, point->real_time_factor);
    g_string_append_printf(page, "<td>%s</td></tr>\n", spore_accuracy_remark(point));
  }
  g_string_append(page, "</table>\n");
}

static void append_spheres(GString *page, const SporeAccuracyReport *report) {
  const char *const heads[] = {_("times"), _("spheres"), _("force %"), _("depth %"), _("places %")};
  if (report->sphere_count == 0) return;
  g_string_append(page, "<table>\n<tr>");
  for (gsize i = 0; i < G_N_ELEMENTS(heads); i++) g_string_append_printf(page, "<th>%s</th>", heads[i]);
  g_string_append(page, "</tr>\n");
  for (gsize i = 0; i < report->sphere_count; i++) {
    const SporeAccuracySpheres *spheres = &report->spheres[i];
    g_string_append_printf(page, "<tr><td>%g</td><td>%zu</td>", spheres->factor, spheres->count);
    append_known(page, spheres->force, 100);
    append_known(page, spheres->depth, 100);
    append_known(page, spheres->error, 100);
    g_string_append(page, "</tr>\n");
  }
  g_string_append(page, "</table>\n");
}

/* Lines of a text as paragraphs. */
static void append_lines(GString *page, const char *text) {
  g_auto(GStrv) lines = g_strsplit(text, "\n", -1);
  for (char **line = lines; *line; line++) {
    g_autofree char *safe = g_markup_escape_text(*line, -1);
    if (*safe) g_string_append_printf(page, "<p>%s</p>\n", safe);
  }
}

char *spore_accuracy_html(const char *scene, const SporeAccuracyReport *report, GError **error) {
  g_autofree char *svg = spore_accuracy_plot(scene, report, error);
  if (!svg) return NULL;
  g_autofree char *name = g_path_get_basename(scene), *title = g_strdup_printf(_("Accuracy of %s"), name);
  g_autofree char *safe = g_markup_escape_text(title, -1), *head = spore_accuracy_describe(report),
                  *tail = spore_accuracy_describe_methods(report), *spheres = spore_accuracy_describe_spheres(report);
  const char *picture = strstr(svg, "<svg");
  GString *page = g_string_new("<!DOCTYPE html>\n<html>\n<head>\n<meta charset=\"utf-8\">\n");
  g_string_append_printf(page, "<title>%s</title>\n", safe);
  g_string_append(page, "<style>\nbody { font-family: sans-serif; margin: 2em; max-width: 70em; }\n"
                        "svg { max-width: 100%; height: auto; }\n"
                        "table { border-collapse: collapse; }\n"
                        "td, th { padding: .2em .8em; text-align: right; border-bottom: 1px solid #ccc; }\n"
                        "td:first-child, td:last-child { text-align: left; }\n"
                        ".pareto { font-weight: bold; }\n.shaded { color: #777; }\n</style>\n</head>\n<body>\n");
  g_string_append_printf(page, "<h1>%s</h1>\n", safe);
  append_lines(page, report->sentence);
  g_string_append(page, picture ? picture : "");
  append_lines(page, head);
  append_table(page, report);
  append_spheres(page, report);
  append_lines(page, spheres);
  append_lines(page, tail);
  g_string_append(page, "</body>\n</html>\n");
  return g_string_free(page, FALSE);
}
