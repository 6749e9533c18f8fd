/* spore spheres --counts: the error against the number of spheres, and where more spheres stop paying. */
#include "app/cli/spheres_series.h"

#include <glib/gi18n.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/base/number.h"
#include "core/io/scene_xml.h"
#include "core/measure/plot.h"

static int ascending(gconstpointer a, gconstpointer b) {
  const size_t *x = a, *y = b;
  return (*x > *y) - (*x < *y);
}

GArray *spore_cli_counts(const char *text, GError **error) {
  g_auto(GStrv) words = g_strsplit(text, ",", 0);
  g_autoptr(GArray) counts = g_array_new(FALSE, FALSE, sizeof(size_t));
  for (char **word = words; *word; word++) {
    guint64 number;
    if (!g_ascii_string_to_unsigned(g_strstrip(*word), 10, 1, SPORE_SPHERES_MAXIMUM, &number, NULL)) {
      spore_error_raise(
          error, SPORE_ERROR_INPUT, "--counts",
          _("\"%s\" is no number of spheres; expected numbers from 1 to %u with commas between them, such "
            "as 16,32,64; correct it"),
          *word, SPORE_SPHERES_MAXIMUM);
      return NULL;
    }
    size_t count = (size_t)number;
    g_array_append_val(counts, count);
  }
  g_array_sort(counts, ascending);
  for (guint i = counts->len; i-- > 1;)
    if (g_array_index(counts, size_t, i) == g_array_index(counts, size_t, i - 1)) g_array_remove_index(counts, i);
  if (counts->len) return g_steal_pointer(&counts);
  spore_error_raise(error, SPORE_ERROR_INPUT, "--counts",
                    _("there is no number; expected numbers from 1 to %u with commas between them, such as 16,32,64; "
                      "give some"),
                    SPORE_SPHERES_MAXIMUM);
  return NULL;
}

void spore_cli_spheres_members(SporeCli *cli, size_t count, const SporeSpheresReport *report) {
  spore_cli_count(cli, "count", (gint64)count);
  spore_cli_number(cli, "coverage", report->coverage);
  spore_cli_number(cli, "outside", report->outside);
  spore_cli_open(cli, "distance");
  spore_cli_number(cli, "mean", report->distance_mean);
  spore_cli_number(cli, "max", report->distance_max);
  spore_cli_close(cli);
  spore_cli_number(cli, "depth_error", report->depth_error);
  spore_cli_number(cli, "weighted_depth_error", report->weighted_depth_error);
  spore_cli_number(cli, "felt_outside", report->felt_outside);
  json_builder_set_member_name(cli->report, "certified");
  json_builder_add_boolean_value(cli->report, report->certified);
  spore_cli_number(cli, "seconds", report->seconds);
  spore_cli_count(cli, "mirrors", (gint64)report->mirrors);
}

typedef struct Series {
  SporeCli *cli;
  const size_t *counts;
} Series;

static void tell_point(void *data, size_t point, const SporeSpheresReport *report) {
  const Series *series = data;
  spore_cli_say(series->cli, "%7zu %9.4f %9.4f %10.4f %11.4f %8.2f\n", series->counts[point], report->coverage,
                report->outside, 100 * report->distance_mean, spore_spheres_felt_error(report), report->seconds);
}

static void append_number(GString *text, double value) {
  char digits[SPORE_NUMBER_TEXT];
  spore_number_format(value, digits);
  g_string_append_printf(text, ",%s", isfinite(value) ? digits : "");
}

static gboolean write_csv(const char *csv, const size_t *counts, const SporeSpheresReport *reports, size_t count,
                          GError **error) {
  g_autoptr(GString) text = g_string_new("count,coverage,outside,distance_mean,distance_max,depth_error,seconds,"
                                         "weighted_depth_error\n");
  for (size_t i = 0; i < count; i++) {
    const SporeSpheresReport *r = &reports[i];
    const double row[] = {r->coverage,    r->outside, r->distance_mean,       r->distance_max,
                          r->depth_error, r->seconds, r->weighted_depth_error};
    g_string_append_printf(text, "%zu", counts[i]);
    for (guint k = 0; k < G_N_ELEMENTS(row); k++) append_number(text, row[k]);
    g_string_append_c(text, '\n');
  }
  return spore_write_file(csv, text->str, text->len, error);
}

enum { DEPTH, MISSING, OUTSIDE, DISTANCE, LINES };

/* Four errors against the number of spheres and against the time it takes to make them, in per cent. */
static char *draw(const char *file, const size_t *counts, const SporeSpheresReport *reports, size_t count,
                  size_t enough, double worth, SporeError *error) {
  g_autofree double *y = g_new(double, LINES *count), *number = g_new(double, count);
  g_autofree double *seconds = g_new(double, count);
  const char *labels[LINES] = {_("depth error"), _("not covered"), _("outside"), _("distance")};
  SporePlotLine lines[2][LINES];
  for (size_t i = 0; i < count; i++) {
    number[i] = (double)counts[i], seconds[i] = reports[i].seconds;
    y[DEPTH * count + i] = 100 * spore_spheres_felt_error(&reports[i]),
                      y[MISSING * count + i] = 100 * (1 - reports[i].coverage);
    y[OUTSIDE * count + i] = 100 * reports[i].outside, y[DISTANCE * count + i] = 100 * reports[i].distance_mean;
  }
  for (int l = 0; l < LINES; l++) {
    lines[0][l] = (SporePlotLine){labels[l], count, number, y + (size_t)l * count, false};
    lines[1][l] = (SporePlotLine){labels[l], count, seconds, y + (size_t)l * count, true};
  }
  g_autofree char *name = g_path_get_basename(file), *title = g_strdup_printf(_("Spheres of %s"), name);
  g_autofree char *mark = enough < count ? g_strdup_printf(_("enough: %zu"), counts[enough]) : NULL;
  g_autofree char *found = g_strdup_printf(
      enough < count
          ? _("Enough: from there on, twice as many spheres lower the depth error by less than %.2g %% of the largest "
              "depth.")
          : _("Not enough yet: twice as many spheres still lower the depth error by %.2g %% of the largest depth or "
              "more."),
      100 * worth);
  g_autofree char *note = g_strconcat(
      found, "\n",
      _("Depth error: of the largest depth; not covered, outside: of the volume; distance: of the diagonal."), NULL);
  const SporePlotPanel panels[] = {
      {_("number of spheres"), _("error (%)"), true, true, lines[0], LINES, mark, enough < count ? number[enough] : 0},
      {_("time to generate (s)"), _("error (%)"), true, true, lines[1], LINES, mark,
       enough < count ? seconds[enough] : 0}};
  return spore_plot_svg(title, note, panels, G_N_ELEMENTS(panels), error);
}

static gboolean write_svg(const char *svg, const char *file, const size_t *counts, const SporeSpheresReport *reports,
                          size_t count, size_t enough, double worth, GError **error) {
  SporeError fault = SPORE_ERROR_INIT;
  char *text = draw(file, counts, reports, count, enough, worth, &fault);
  gboolean done = text ? spore_write_file(svg, text, strlen(text), error) : spore_error_propagate(&fault, error);
  spore_free(text);
  return done;
}

static void report_series(SporeCli *cli, const size_t *counts, const SporeSpheresReport *reports, size_t count,
                          size_t enough, double worth) {
  spore_cli_open_array(cli, "points");
  for (size_t i = 0; i < count; i++) {
    spore_cli_open(cli, NULL);
    spore_cli_spheres_members(cli, counts[i], &reports[i]);
    spore_cli_close(cli);
  }
  spore_cli_close_array(cli);
  spore_cli_number(cli, "enough", enough < count ? (double)counts[enough] : NAN);
  spore_cli_number(cli, "worth", worth);
  if (enough < count)
    spore_cli_say(cli,
                  _("From %zu spheres on, twice as many lower the depth error by less than %g of the largest depth.\n"),
                  counts[enough], worth);
  else
    spore_cli_say(cli,
                  _("Twice as many spheres still lower the depth error by %g of the largest depth or more, up to %zu: "
                    "more would pay.\n"),
                  worth, counts[count - 1]);
}

gboolean spore_cli_spheres_series(SporeCli *cli, const char *file, const SporeSpheresSource *source,
                                  const SporeSpheresOptions *options, const GArray *counts, double worth,
                                  const char *svg, const char *csv, GError **error) {
  const size_t *numbers = (const size_t *)(gconstpointer)counts->data;
  size_t count = counts->len;
  g_autofree SporeSpheresReport *reports = g_new0(SporeSpheresReport, count);
  Series series = {cli, numbers};
  SporeError fault = SPORE_ERROR_INIT;
  spore_cli_say(cli, "%7s %9s %9s %10s %11s %8s\n", _("spheres"), _("coverage"), _("outside"), _("distance %"),
                _("depth error"), _("seconds"));
  if (!spore_spheres_series(source, options, numbers, count, reports, tell_point, &series, spore_cli_progress(cli),
                            &fault)) {
    spore_error_at(&fault, file);
    return spore_error_propagate(&fault, error);
  }
  g_autofree double *errors = g_new(double, count);
  for (size_t i = 0; i < count; i++) errors[i] = spore_spheres_felt_error(&reports[i]);
  size_t enough = spore_enough(numbers, errors, count, worth);
  if (svg && !write_svg(svg, file, numbers, reports, count, enough, worth, error)) return FALSE;
  if (csv && !write_csv(csv, numbers, reports, count, error)) return FALSE;
  report_series(cli, numbers, reports, count, enough, worth);
  return TRUE;
}
