/* spore sweep collect: the results of a sweep, put together. */
#include <glib/gi18n.h>
#include <string.h>

#include "app/cli/sweep_table.h"
#include "core/io/scene_xml.h"

typedef struct CollectOptions {
  char *results, *output, *svg, *quantities, *over;
} CollectOptions;

static void report_case(SporeCli *cli, const SporeSweepTable *table, guint number) {
  const SporeSweepCase *one = g_ptr_array_index(table->sweep->cases, number);
  const SporeSweepResult *result = table->results[number];
  guint columns = g_strv_length(table->quantities);
  spore_cli_open(cli, NULL);
  spore_cli_count(cli, "case", number);
  spore_cli_count(cli, "status", result->status);
  spore_cli_number(cli, "seconds", result->seconds);
  spore_cli_text(cli, "host", result->host);
  spore_cli_count(cli, "core", result->core);
  spore_cli_open(cli, "values");
  for (guint a = 0; table->sweep->axes[a]; a++) spore_cli_text(cli, table->sweep->axes[a], one->values[a]);
  spore_cli_close(cli);
  spore_cli_open(cli, "quantities");
  for (guint k = 0; k < columns; k++) spore_cli_number(cli, table->quantities[k], table->values[number * columns + k]);
  spore_cli_close(cli);
  spore_cli_close(cli);
}

/* Whether the case has nothing to go by. */
static gboolean is_failed(const SporeSweepTable *table, guint i) {
  return table->results[i] && spore_sweep_result_failed(table->results[i]);
}

static guint report_cases(SporeCli *cli, const SporeSweepTable *table) {
  guint count = table->sweep->cases->len, whole = 0;
  spore_cli_open_array(cli, "cases");
  for (guint i = 0; i < count; i++)
    if (table->results[i] && !is_failed(table, i)) report_case(cli, table, i), whole++;
  spore_cli_close_array(cli);
  return whole;
}

static guint report_missing(SporeCli *cli, const SporeSweepTable *table) {
  guint missing = 0;
  spore_cli_open_array(cli, "missing");
  for (guint i = 0; i < table->sweep->cases->len; i++) {
    if (table->results[i]) continue;
    spore_cli_count(cli, NULL, i);
    missing++;
  }
  spore_cli_close_array(cli);
  return missing;
}

static guint report_failed(SporeCli *cli, const SporeSweepTable *table) {
  guint failed = 0;
  spore_cli_open_array(cli, "failed");
  for (guint i = 0; i < table->sweep->cases->len; i++) {
    if (!is_failed(table, i)) continue;
    const SporeSweepResult *result = table->results[i];
    spore_cli_open(cli, NULL);
    spore_cli_count(cli, "case", i);
    spore_cli_count(cli, "status", result->status);
    spore_cli_text(cli, "said", result->said);
    spore_cli_close(cli);
    spore_cli_say(cli, _("case %u: status %d: %s\n"), i, (int)result->status, result->said ? result->said : "");
    failed++;
  }
  spore_cli_close_array(cli);
  return failed;
}

/* CSV or a page, by the name of the file. */
static gboolean write_output(const SporeSweepTable *table, const CollectOptions *options, GError **error) {
  const char *file = options->output;
  gboolean page = g_str_has_suffix(file, ".html"), csv = g_str_has_suffix(file, ".csv");
  if (!page && !csv)
    return spore_error_raise(error, SPORE_ERROR_INPUT, file, _("expected a name that ends in .csv or .html; name one"));
  g_autofree char *text = page ? spore_sweep_html(table, options->over, error) : spore_sweep_csv(table);
  return text && spore_write_file(file, text, strlen(text), error);
}

static gboolean write_svg(const SporeSweepTable *table, const CollectOptions *options, GError **error) {
  if (!options->quantities || g_strv_length(table->quantities) != 1)
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--svg",
                             _("a plot shows one quantity; expected its name in --quantities; give one"));
  g_autofree char *text = spore_sweep_svg(table, 0, options->over, error);
  return text && spore_write_file(options->svg, text, strlen(text), error);
}

static int collect(SporeCli *cli, const char *file, const CollectOptions *options) {
  GError *error = NULL;
  const char *const outputs[] = {options->output, options->svg};
  for (gsize i = 0; i < G_N_ELEMENTS(outputs); i++)
    if (outputs[i] && !spore_cli_has_room(outputs[i], file, &error)) return spore_cli_fail(error);
  g_autoptr(SporeManifest) sweep = spore_sweep_read(file, options->results, &error);
  g_autoptr(SporeSweepTable) table = sweep ? spore_sweep_table_read(sweep, options->quantities, &error) : NULL;
  if (!table || (options->output && !write_output(table, options, &error)) ||
      (options->svg && !write_svg(table, options, &error)))
    return spore_cli_fail(error);
  guint whole = report_cases(cli, table), missing = report_missing(cli, table), failed = report_failed(cli, table);
  spore_cli_say(cli, _("%s: %u of %u cases have results, %u failed, %u are missing\n"), file, whole, sweep->cases->len,
                failed, missing);
  return spore_cli_finish(cli, missing + failed > 0 ? SPORE_EXIT_NOT_HELD : SPORE_EXIT_DONE);
}

int spore_sweep_collect(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"cases", N_("each one's case (its number), status (of the command), seconds, host, core (that it had to itself, "
                   "or -1), values (of the axes) and quantities")},
      {"missing", N_("numbers of cases without a result")},
      {"failed", N_("of cases that gave nothing to go by: case, status (above 128: ended by a signal), said")},
      {NULL}};
  CollectOptions options = {0};
  const GOptionEntry entries[] = {
      {"output", 'o', 0, G_OPTION_ARG_FILENAME, &options.output, N_("A table, or one page with plots and the table"),
       "F.csv or F.html"},
      {"quantities", 0, 0, G_OPTION_ARG_STRING, &options.quantities,
       N_("Numbers of the results, with commas between them: step_us.p99, links.cord.load_N (default: all at hand)"),
       "NAMES"},
      {"over", 0, 0, G_OPTION_ARG_STRING, &options.over,
       N_("One axis to plot over, or two: a map (default: those that differ)"), "AXES"},
      {"svg", 0, 0, G_OPTION_ARG_FILENAME, &options.svg, N_("The plot of one quantity"), "F.svg"},
      {"results", 0, 0, G_OPTION_ARG_FILENAME, &options.results, N_("Folder of results (default: F.sweep.results)"),
       "FOLDER"},
      G_OPTION_ENTRY_NULL};
  static const SporeCommandInfo info = {
      .name = "sweep collect",
      .arguments = "F.sweep",
      .summary = N_("Puts the results of a sweep together. The exit status is 1 where cases failed or are missing."),
      .minimum = 1,
      .maximum = 1,
      .report = members};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE) status = collect(cli, argv[1], &options);
  char *texts[] = {options.results, options.output, options.svg, options.quantities, options.over};
  for (gsize i = 0; i < G_N_ELEMENTS(texts); i++) g_free(texts[i]);
  return status;
}
