/* spore export: a scene for other programs, and for running it without SPORE. */
#include <glib/gi18n.h>
#include <string.h>

#include "app/cli/scene.h"
#include "ui/export/export.h"

typedef struct ExportOptions {
  char *format, *output, *time, *every;
  SporeSceneOptions scene;
} ExportOptions;

/* The run that --time and --every ask for. */
static gboolean find_moments(SporeExport *export, const ExportOptions *options, GError **error) {
  double dt_s = spore_object_number(spore_document_section(export->document, "solver"), "time_step");
  gint64 steps = 0;
  if (options->time && !spore_cli_steps(options->time, dt_s, &steps, error)) return FALSE;
  export->steps = (guint64)steps;
  return !options->every || spore_cli_stride(options->every, dt_s, &export->stride, error);
}

static gboolean export_scene(SporeCli *cli, SporeExport *export, const char *scene, const ExportOptions *options,
                             const SporeExportFormat *format, GError **error) {
  SporeTrack input = {0};
  SporeDocument *document = NULL;
  if (spore_cli_has_room(export->output, scene, error) &&
      (!options->scene.input || spore_cli_read_track(options->scene.input, &input, error)))
    document = spore_cli_load(cli, scene, &options->scene, error);
  export->document = document;
  export->input = options->scene.input ? &input : NULL;
  gboolean done = document && find_moments(export, options, error) && spore_export_run(export, format, error);
  spore_track_clear(&input);
  export->document = NULL, export->input = NULL;
  g_clear_pointer(&document, spore_document_free);
  return done;
}

static gboolean check_moments(const ExportOptions *options, const SporeExportFormat *format, GError **error) {
  const char *option = options->every ? "--every" : "--time";
  SporeExportMoments asked = options->every  ? SPORE_EXPORT_SERIES
                             : options->time ? SPORE_EXPORT_ONE_MOMENT
                                             : SPORE_EXPORT_NO_MOMENT;
  if (asked > format->moments)
    return spore_error_raise(error, SPORE_ERROR_INPUT, option,
                             options->every ? _("format %s shows no series; expected vtk or gltf; leave it out")
                                            : _("format %s has no such thing; expected a format that shows moments of "
                                                "a run; leave it out"),
                             format->name);
  return !options->every || options->time ||
         spore_error_raise(error, SPORE_ERROR_INPUT, option,
                           _("no time to run is given; expected --time S beside it; add that"));
}

static void say_written(SporeCli *cli, const SporeExport *export) {
  gsize bytes;
  guint unsaid = spore_export_unsaid(export, &bytes);
  for (guint i = unsaid; i < export->written->len; i++) {
    const SporeExported *one = &g_array_index(export->written, SporeExported, i);
    if (unsaid) spore_cli_say(cli, _("%s: with %u other files, %zu bytes\n"), one->file, unsaid, bytes + one->bytes);
    else spore_cli_say(cli, _("%s: %zu bytes\n"), one->file, one->bytes);
  }
}

static void report_written(SporeCli *cli, const SporeExport *export) {
  spore_cli_open_array(cli, "written");
  for (guint i = 0; i < export->written->len; i++) {
    const SporeExported *exported = &g_array_index(export->written, SporeExported, i);
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "file", exported->file);
    spore_cli_count(cli, "bytes", (gint64)exported->bytes);
    spore_cli_close(cli);
  }
  spore_cli_close_array(cli);
  say_written(cli, export);
}

static void report_motions(SporeCli *cli, const GArray *motions) {
  spore_cli_open_array(cli, "animation");
  for (guint i = 0; i < motions->len; i++) {
    const SporeExportedMotion *motion = &g_array_index(motions, SporeExportedMotion, i);
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "body", motion->body);
    spore_cli_count(cli, "keys", motion->keys);
    spore_cli_number(cli, "error_m", motion->error);
    spore_cli_number(cli, "bound_m", motion->bound);
    spore_cli_close(cli);
    spore_cli_say(cli, _("%s: %u key frames for %u moments, none farther off than %.3g m; the bound is %.3g m\n"),
                  motion->body, motion->keys, motion->moments, motion->error, motion->bound);
  }
  spore_cli_close_array(cli);
}

static void report_unsolved(SporeCli *cli, guint64 steps) {
  spore_cli_count(cli, "unsolved", (gint64)steps);
  if (steps)
    spore_cli_say(cli, _("%llu steps were not solved as the scene is written; spore run says of which body, and why\n"),
                  (unsigned long long)steps);
}

/* label: translated, before each sentence. */
static void report_sentences(SporeCli *cli, const char *member, const GPtrArray *sentences, const char *label) {
  spore_cli_open_array(cli, member);
  for (guint i = 0; i < sentences->len; i++) {
    spore_cli_text(cli, NULL, sentences->pdata[i]);
    spore_cli_say(cli, "%s %s\n", label, (const char *)sentences->pdata[i]);
  }
  spore_cli_close_array(cli);
}

/* Members of the report, and lines for people. */
static void report_export(SporeCli *cli, const SporeExport *export) {
  if (export->ran) report_unsolved(cli, export->unsolved);
  if (export->motions) report_motions(cli, export->motions);
  report_written(cli, export);
  report_sentences(cli, "lost", export->lost, _("lost:"));
  report_sentences(cli, "left_out", export->left_out, _("left out:"));
}

static int run_export(SporeCli *cli, const char *scene, const ExportOptions *options, const SporeExportFormat *format) {
  SporeExport export = {.output = options->output, .progress = spore_cli_progress(cli), .cancel = spore_cli_cancel()};
  GError *error = NULL;
  spore_export_init(&export);
  gboolean done = check_moments(options, format, &error) && export_scene(cli, &export, scene, options, format, &error);
  if (done) report_export(cli, &export);
  spore_export_clear(&export);
  return done ? spore_cli_finish(cli, SPORE_EXIT_DONE) : spore_cli_fail(error);
}

/* g_free the array; the last one is NULL. */
static const char **list_names(void) {
  guint count = 0;
  while (spore_export_formats[count].name) count++;
  const char **names = g_new0(const char *, count + 1);
  for (guint i = 0; i < count; i++) names[i] = spore_export_formats[i].name;
  return names;
}

/* The format of that name; NULL after a message. */
static const SporeExportFormat *find_format(const char *name) {
  g_autofree const char **names = list_names();
  GError *error = NULL;
  int found = spore_cli_choice("--format", name, names, &error);
  if (found < 0) spore_cli_fail(error);
  return found < 0 ? NULL : &spore_export_formats[found];
}

static int refuse_no_format(void) {
  g_autofree const char **names = list_names();
  g_autofree char *all = g_strjoinv(", ", (char **)names);
  return spore_cli_usage(_("spore export: no format is given; expected --format and one of %s; add it"), all);
}

/* A folder may be named with slashes behind it. */
static void strip_slashes(char *path) {
  for (gsize size = strlen(path); size > 1 && path[size - 1] == '/'; size--) path[size - 1] = '\0';
}

static int run(SporeCli *cli, const char *scene, const ExportOptions *options) {
  if (!options->format) return refuse_no_format();
  if (!options->output) return spore_cli_usage(_("spore export: no file to write is given; expected -o F; add it"));
  strip_slashes(options->output);
  const SporeExportFormat *format = find_format(options->format);
  return format ? run_export(cli, scene, options, format) : SPORE_EXIT_INPUT;
}

static char *describe_formats(void) {
  GString *text = g_string_new(_("Formats:"));
  for (const SporeExportFormat *format = spore_export_formats; format->name; format++)
    g_string_append_printf(text, "\n  %-9s %s", format->name, _(format->doc));
  return g_string_free(text, FALSE);
}

int spore_command_export(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"written", N_("each file: file (as given), bytes")},
      {"lost", N_("sentences: what of the scene the format cannot hold")},
      {"left_out", N_("what the file does not need")},
      {"unsolved", N_("of formats that show moments of a run: steps that were not solved as the scene is "
                      "written, of the body and cause that are worst")},
      {NULL, NULL}};
  static const SporeCommandInfo info = {
      "export", "SCENE",         N_("Writes a scene for other programs, and for running it without SPORE."), 1, 1,
      members,  describe_formats};
  ExportOptions options = {0};
  const GOptionEntry entries[] = {
      {"format", 'f', 0, G_OPTION_ARG_STRING, &options.format, N_("What to write: one of the formats below"), "NAME"},
      {"output", 'o', 0, G_OPTION_ARG_FILENAME, &options.output, N_("File to write"), "F"},
      {"time", 't', 0, G_OPTION_ARG_STRING, &options.time, N_("Simulated time that is shown (default 0)"), "S"},
      {"every", 0, 0, G_OPTION_ARG_STRING, &options.every,
       N_("Show a series from 0 on: time between two moments, a multiple of the step"), "S"},
      SPORE_SCENE_OPTION_ENTRIES(options.scene),
      G_OPTION_ENTRY_NULL};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE) status = run(cli, argv[1], &options);
  spore_scene_options_clear(&options.scene);
  g_free(options.format);
  g_free(options.output);
  g_free(options.time);
  g_free(options.every);
  return status;
}
