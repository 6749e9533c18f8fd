/* Numbers over time of spore run: what is measured, which points are watched, and the file. */
#include "app/cli/run_output.h"

#include <glib/gi18n.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/io/scene_xml.h"
#include "core/scene/watch_place.h"

void spore_output_options_clear(SporeOutputOptions *options) {
  g_free(options->file);
  g_free(options->quantities);
  g_free(options->every);
  g_strfreev(options->watch);
  *options = (SporeOutputOptions){0};
}

/* All quantities whose use is at least `use`, with commas between them. */
static char *list_quantities(SporeQuantityUse first, SporeQuantityUse last) {
  GString *text = g_string_new(NULL);
  for (guint i = 0; i < SPORE_QUANTITY_COUNT; i++)
    if (spore_quantities[i].use >= first && spore_quantities[i].use <= last)
      g_string_append_printf(text, text->len ? ", %s" : "%s", spore_quantities[i].name);
  return g_string_free(text, FALSE);
}

static void describe_columns(GString *text, const SporeQuantity *quantity) {
  for (gsize i = 0; i < quantity->part_count; i++) {
    const SporeQuantityPart *part = &quantity->parts[i];
    if (!*part->name && !*part->unit) continue;
    g_string_append(text, i > 0 ? ", " : " (");
    g_string_append(text, part->name);
    if (*part->unit) g_string_append_printf(text, *part->name ? " %s" : "%s", part->unit);
  }
  g_string_append_c(text, ')');
}

char *spore_output_describe(void) {
  g_autofree char *usual = list_quantities(SPORE_QUANTITY_USUAL, SPORE_QUANTITY_USUAL);
  GString *text = g_string_new(_("Quantities of --quantities, with their columns:"));
  for (guint i = 0; i < SPORE_QUANTITY_COUNT; i++) {
    g_string_append_printf(text, "\n  %-21s %s", spore_quantities[i].name, _(spore_quantities[i].doc));
    describe_columns(text, &spore_quantities[i]);
  }
  g_string_append_c(text, '\n');
  g_string_append_printf(text, _("Where none are chosen: %s. These do not depend on the clock."), usual);
  return g_string_free(text, FALSE);
}

static gboolean choose(const char *name, bool *chosen, GError **error) {
  gsize found = spore_quantity_find(name, strlen(name));
  if (found < SPORE_QUANTITY_COUNT) return chosen[found] = true;
  g_autofree char *all = list_quantities(SPORE_QUANTITY_ALWAYS, SPORE_QUANTITY_ASKED);
  return spore_error_raise(error, SPORE_ERROR_INPUT, "--quantities",
                           _("'%s' is not known; expected one of %s, or several with commas between them"), name, all);
}

/* chosen: SPORE_QUANTITY_COUNT flags. */
static gboolean parse_quantities(const char *names, bool *chosen, GError **error) {
  g_auto(GStrv) words = g_strsplit(names, ",", -1);
  if (!words[0]) return choose(names, chosen, error); /* no names at all */
  for (char **word = words; *word; word++)
    if (!choose(g_strstrip(*word), chosen, error)) return FALSE;
  return TRUE;
}

static gboolean is_csv(const char *file) { return g_str_has_suffix(file, ".csv"); }

static gboolean check_file(const char *file, const char *scene, const char *input, const char *record, GError **error) {
  if (!is_csv(file) && !g_str_has_suffix(file, ".json"))
    return spore_error_raise(error, SPORE_ERROR_INPUT, file,
                             _("--output takes the kind of file from its name; expected .csv or .json; name such a "
                               "file"));
  g_autofree char *absolute = g_canonicalize_filename(file, NULL);
  g_autofree char *other = record ? g_canonicalize_filename(record, NULL) : NULL;
  if (other && g_str_equal(absolute, other))
    return spore_error_raise(error, SPORE_ERROR_INPUT, file,
                             _("--output and --record name the same file; expected two; name another"));
  return spore_cli_has_room(file, scene, error) && (!input || spore_cli_has_room(file, input, error));
}

gboolean spore_output_check(const SporeOutputOptions *options, const char *scene, const char *input, const char *record,
                            GError **error) {
  bool chosen[SPORE_QUANTITY_COUNT] = {false};
  if (options->quantities && !parse_quantities(options->quantities, chosen, error)) return FALSE;
  if (chosen[spore_quantity_find("watch", strlen("watch"))] && !options->watch)
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--quantities",
                             _("watch needs points to watch; expected --watch BODY@X,Y,Z beside it; add that"));
  if (options->file) return check_file(options->file, scene, input, record, error);
  const char *alone = options->quantities ? "--quantities"
                      : options->watch    ? "--watch"
                      : options->every    ? "--every"
                                          : NULL;
  return !alone || spore_error_raise(error, SPORE_ERROR_INPUT, alone,
                                     _("nothing is written; expected --output F.csv or F.json beside it; add that"));
}

/* Watched points. */

/* NULL with a GError; free with g_array_unref. */
static GArray *parse_watches(const SporeRun *run, char **watch, GError **error) {
  g_autoptr(GArray) requests = g_array_new(FALSE, FALSE, sizeof(SporeWatchRequest));
  for (; watch && *watch; watch++) {
    SporeWatchRequest request = {.name = *watch};
    if (!spore_watch_place_parse(run->simulation, run->document, *watch, &request.body, &request.at, error))
      return NULL;
    g_array_append_val(requests, request);
  }
  return g_steal_pointer(&requests);
}

/* Measuring. */

gboolean spore_output_open(SporeOutput *output, const SporeOutputOptions *options, const SporeRun *run,
                           GError **error) {
  bool chosen[SPORE_QUANTITY_COUNT] = {false};
  SporeError fault = SPORE_ERROR_INIT;
  *output = (SporeOutput){.file = options->file};
  if (!options->file) return TRUE;
  output->dt_s = spore_object_number(spore_document_section(run->document, "solver"), "time_step");
  if (!spore_cli_stride(options->every, output->dt_s, &output->stride, error)) return FALSE;
  if (options->quantities && !parse_quantities(options->quantities, chosen, error)) return FALSE;
  g_autoptr(GArray) watches = parse_watches(run, options->watch, error);
  if (!watches) return FALSE;
  output->measurement =
      spore_measurement_create(run->simulation->world, options->quantities ? chosen : NULL,
                               (const SporeWatchRequest *)(gconstpointer)watches->data, watches->len, &fault);
  if (!output->measurement) return spore_error_propagate(&fault, error);
  output->numbers.measurement = output->measurement;
  output->lost = !spore_numbers_add(&output->numbers);
  return TRUE;
}

gboolean spore_output_step(SporeOutput *output, guint64 step) {
  if (!output->measurement || step % output->stride != 0) return TRUE;
  output->lost |= !spore_numbers_add(&output->numbers);
  return !output->lost;
}

static char *format(const SporeOutput *output, const char *scene, gsize *size) {
  if (is_csv(output->file)) return spore_numbers_csv(&output->numbers, size);
  g_autofree char *name = g_filename_display_name(scene);
  return spore_numbers_json(&output->numbers, name, output->dt_s, size);
}

int spore_output_save(const SporeCli *cli, const SporeOutput *output, const char *scene) {
  GError *error = NULL;
  gsize size = 0, columns = 0;
  if (!output->measurement) return SPORE_EXIT_DONE;
  if (spore_cli_interrupted()) {
    fprintf(stderr, _("%s: interrupted; the numbers were not written, and what was there stays\n"), output->file);
    return SPORE_EXIT_INTERRUPTED;
  }
  char *text = output->lost ? NULL : format(output, scene, &size);
  gboolean saved = text ? spore_write_file(output->file, text, size, &error)
                        : spore_error_raise(&error, SPORE_ERROR_MEMORY, output->file,
                                            _("not enough memory; write fewer rows (--every) or quantities"));
  spore_free(text);
  if (!saved) return spore_cli_fail(error);
  spore_measurement_columns(output->measurement, &columns);
  spore_cli_say(cli, _("%s: %zu rows of %zu columns\n"), output->file, output->numbers.row_count, columns);
  return SPORE_EXIT_DONE;
}

void spore_output_clear(SporeOutput *output) {
  spore_numbers_clear(&output->numbers);
  spore_measurement_free(output->measurement);
  *output = (SporeOutput){0};
}
