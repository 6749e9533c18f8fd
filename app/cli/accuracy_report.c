/* What `spore accuracy` prints: lines for people and members of --json. */
#include "app/cli/accuracy_report.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/author/accuracy_page.h"

const SporeReportMember spore_accuracy_members[] = {
    {"scene", N_("file of the scene")},
    {"stretch", N_("of the input that every run took: start_s, time_s, contacts (mean a step)")},
    {"reference", N_("that errors are measured from: method, dt_s, own_error (by its steps, in lengths of a body), "
                     "order (observed), "
                     "cross_method, cross_dt_s, cross_difference (how far the second method is from it; null: there "
                     "was none), agreed, gap_m and line_stretch (as of points)")},
    {"resolution",
     N_("growth (how far a run drifted whose start was moved by 1e-8), chaotic (growth above 1e-3: errors are then of "
        "mean places over the stretch), spread (of such means over perturbed runs), floor (errors below cannot be "
        "told)")},
    {"points",
     N_("method, dt_s, level, error (root of the mean square, in lengths of a body), final, worst, energy_drift (of "
        "the energy at work), penetration (by the smaller radius), gap_m (largest between points that a link holds "
        "together), line_stretch (largest part by which a piece of a line is longer or shorter than at rest; both "
        "null: "
        "there is none), us_per_step, p99_us, real_time_factor, cpu_s (for a simulated second), stable, as_written "
        "(no step was unsolved), sound (stable, as written, its energy off by no more than all that is at work), "
        "resolved "
        "(above the floor), pareto (of those that are sound), repeats, and a step: force_evaluations, newton, "
        "linear")},
    {"methods", N_("name, order (slope of error over step; null: not told), order_spread, nominal (where forces are "
                   "smooth), alike (a method before it that moves the bodies as it does; null: none), converges "
                   "(false: at these steps smaller ones do not help, while another method is much nearer)")},
    {"levels", N_("with --levels: level, error (of space: by the reference's method)")},
    {"spheres",
     N_("with --spheres: factor, count (of the whole scene), and against the finest set, by the reference's method: "
        "force (of the contacts on each body) and depth (of the deepest contact), as parts of what they are there "
        "(null: nothing touches), error (of places). The row of the finest set is itself at half the step: what is "
        "nearer cannot be told")},
    {"pareto", N_("indices in points: no other point has a smaller error at a smaller cost, ascending by cost")},
    {"cut", N_("what was cut to fit the time, or could not be had, in words; --full cuts nothing")},
    {"sentence", N_("what it comes to, in words")},
    {NULL, NULL}};

static void report_stretch(SporeCli *cli, const char *scene, const SporeAccuracyReport *report) {
  const SporeAccuracyReference *reference = &report->reference;
  gboolean crossed = reference->cross_method < report->method_count;
  spore_cli_text(cli, "scene", scene);
  spore_cli_open(cli, "stretch");
  spore_cli_number(cli, "start_s", report->start_s);
  spore_cli_number(cli, "time_s", report->time_s);
  spore_cli_number(cli, "contacts", report->contacts);
  spore_cli_close(cli);
  spore_cli_open(cli, "reference");
  spore_cli_text(cli, "method", report->methods[reference->method].label);
  spore_cli_number(cli, "dt_s", reference->dt_s);
  spore_cli_number(cli, "own_error", reference->own_error);
  spore_cli_number(cli, "order", reference->order);
  spore_cli_text(cli, "cross_method", crossed ? report->methods[reference->cross_method].label : NULL);
  spore_cli_number(cli, "cross_dt_s", crossed ? reference->cross_dt_s : NAN);
  spore_cli_number(cli, "cross_difference", crossed ? reference->cross_difference : NAN);
  spore_cli_flag(cli, "agreed", reference->agreed);
  spore_cli_number(cli, "gap_m", reference->gap);
  spore_cli_number(cli, "line_stretch", reference->line_stretch);
  spore_cli_close(cli);
  spore_cli_open(cli, "resolution");
  spore_cli_number(cli, "growth", report->growth);
  spore_cli_flag(cli, "chaotic", report->chaotic);
  spore_cli_number(cli, "spread", report->statistics ? report->spread : NAN);
  spore_cli_number(cli, "floor", report->floor);
  spore_cli_close(cli);
}

static void report_point(SporeCli *cli, const SporeAccuracyReport *report, const SporeAccuracyPoint *point) {
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "method", report->methods[point->method].label);
  spore_cli_number(cli, "dt_s", point->dt_s);
  spore_cli_text(cli, "level", spore_accuracy_level_name(point->level));
  spore_cli_number(cli, "error", point->error);
  spore_cli_number(cli, "final", point->final);
  spore_cli_number(cli, "worst", point->worst);
  spore_cli_number(cli, "energy_drift", point->energy_drift);
  spore_cli_number(cli, "penetration", point->penetration);
  spore_cli_number(cli, "gap_m", point->gap);
  spore_cli_number(cli, "line_stretch", point->line_stretch);
  spore_cli_number(cli, "us_per_step", point->us_per_step);
  spore_cli_number(cli, "p99_us", point->p99_us);
  spore_cli_number(cli, "real_time_factor", point->real_time_factor);
  spore_cli_number(cli, "cpu_s", point->cost);
  spore_cli_flag(cli, "stable", point->stable);
  spore_cli_flag(cli, "as_written", point->as_written);
  spore_cli_flag(cli, "sound", point->sound);
  spore_cli_flag(cli, "resolved", point->resolved);
  spore_cli_flag(cli, "pareto", point->pareto);
  spore_cli_count(cli, "repeats", (gint64)point->repeats);
  spore_cli_number(cli, "force_evaluations", point->force_evaluations);
  spore_cli_number(cli, "newton", point->newton);
  spore_cli_number(cli, "linear", point->linear);
  spore_cli_close(cli);
}

static void report_methods(SporeCli *cli, const SporeAccuracyReport *report) {
  spore_cli_open_array(cli, "methods");
  for (gsize m = 0; m < report->method_count; m++) {
    const SporeAccuracyFit *fit = &report->methods[m];
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "name", fit->label);
    spore_cli_number(cli, "order", fit->order);
    spore_cli_number(cli, "order_spread", fit->order_spread);
    spore_cli_number(cli, "nominal", fit->nominal);
    spore_cli_text(cli, "alike", fit->alike == m ? NULL : report->methods[fit->alike].label);
    spore_cli_flag(cli, "converges", fit->converges);
    spore_cli_close(cli);
  }
  spore_cli_close_array(cli);
}

static void report_lists(SporeCli *cli, const SporeAccuracyReport *report) {
  g_autoptr(GArray) set = spore_accuracy_pareto(report);
  spore_cli_open_array(cli, "points");
  for (gsize i = 0; i < report->point_count; i++) report_point(cli, report, &report->points[i]);
  spore_cli_close_array(cli);
  report_methods(cli, report);
  spore_cli_open_array(cli, "levels");
  for (gsize i = 0; i < report->level_count; i++) {
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "level", spore_accuracy_level_name(report->levels[i].level));
    spore_cli_number(cli, "error", report->levels[i].error);
    spore_cli_close(cli);
  }
  spore_cli_close_array(cli);
  spore_cli_open_array(cli, "spheres");
  for (gsize i = 0; i < report->sphere_count; i++) {
    spore_cli_open(cli, NULL);
    spore_cli_number(cli, "factor", report->spheres[i].factor);
    spore_cli_count(cli, "count", (gint64)report->spheres[i].count);
    spore_cli_number(cli, "force", report->spheres[i].force);
    spore_cli_number(cli, "depth", report->spheres[i].depth);
    spore_cli_number(cli, "error", report->spheres[i].error);
    spore_cli_close(cli);
  }
  spore_cli_close_array(cli);
  spore_cli_open_array(cli, "pareto");
  for (guint i = 0; i < set->len; i++) json_builder_add_int_value(cli->report, g_array_index(set, guint, i));
  spore_cli_close_array(cli);
  spore_cli_open_array(cli, "cut");
  for (gsize i = 0; i < report->cut_count; i++) json_builder_add_string_value(cli->report, report->cuts[i]);
  spore_cli_close_array(cli);
  spore_cli_text(cli, "sentence", report->sentence);
}

/* A number in a column of what the scene may not have at all: then there is no such column. */
static char *column_of(double reference, double value) {
  return isnan(reference) ? g_strdup("") : g_strdup_printf(" %9.2g", value);
}

static void say_heads(SporeCli *cli, const SporeAccuracyReport *report, int width) {
  const SporeAccuracyReference *reference = &report->reference;
  spore_cli_say(cli, "%-*s %9s %8s %9s %9s %9s", width, _("method"), _("step ms"),
                report->level_count ? _("level") : "", _("error %"), _("energy %"), _("depth"));
  if (!isnan(reference->gap)) spore_cli_say(cli, " %9s", _("gap mm"));
  if (!isnan(reference->line_stretch)) spore_cli_say(cli, " %9s", _("stretch %"));
  spore_cli_say(cli, " %9s %9s\n", _("us a step"), _("real time"));
}

static void say_points(SporeCli *cli, const SporeAccuracyReport *report) {
  int width = 17;
  for (gsize m = 0; m < report->method_count; m++) width = MAX(width, (int)strlen(report->methods[m].label));
  say_heads(cli, report, width);
  for (gsize i = 0; i < report->point_count; i++) {
    const SporeAccuracyPoint *point = &report->points[i];
    g_autofree char *gap = column_of(report->reference.gap, 1e3 * point->gap),
                    *stretch = column_of(report->reference.line_stretch, 100 * point->line_stretch);
    spore_cli_say(cli, "%-*s %9.4g %8s %9.2g %9.2g %9.2g%s%s %9.4g %8.3gx  %s\n", width,
                  report->methods[point->method].label, 1e3 * point->dt_s,
                  point->level < 0 ? "" : spore_accuracy_level_name(point->level), 100 * point->error,
                  100 * point->energy_drift, point->penetration, gap, stretch, point->us_per_step,
                  point->real_time_factor, spore_accuracy_remark(point));
  }
}

void spore_accuracy_tell(SporeCli *cli, const char *scene, const SporeAccuracyReport *report) {
  g_autofree char *head = spore_accuracy_describe(report), *tail = spore_accuracy_describe_methods(report),
                  *spheres = spore_accuracy_describe_spheres(report);
  report_stretch(cli, scene, report);
  report_lists(cli, report);
  spore_cli_say(cli, "%s", head);
  say_points(cli, report);
  spore_cli_say(cli, "%s%s%s\n", spheres, tail, report->sentence);
}
