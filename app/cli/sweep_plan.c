/* spore sweep plan: the combinations of scenes and settings, each a case. */
#include <errno.h>
#include <glib/gi18n.h>
#include <glib/gstdio.h>
#include <math.h>
#include <string.h>

#include "app/cli/scene.h"
#include "app/cli/sweep.h"
#include "core/base/hash.h"
#include "core/base/number.h"
#include "core/io/scene_xml.h"

#define VALUES_MAXIMUM 10000 /* of one axis */

typedef struct PlanOptions {
  char **vary;
  char *integrators, *inputs, *command, *output, *slurm, *parallel;
  int repeats;
} PlanOptions;

/* What differs between cases. option: the argument of the command that takes a value; NULL: none does. */
typedef struct Axis {
  char *name;
  const char *option;
  gboolean setting; /* option takes NAME=VALUE */
  char **values;
} Axis;

static void axis_clear(gpointer data) {
  Axis *axis = data;
  g_free(axis->name);
  g_strfreev(axis->values);
}

static void add_axis(GArray *axes, const char *name, const char *option, gboolean setting, char **values) {
  Axis axis = {.name = g_strdup(name), .option = option, .setting = setting, .values = values};
  g_array_append_val(axes, axis);
}

/* Values. */

static gboolean read_number(const char *text, double *number) {
  gsize length = strlen(text);
  return length > 0 && spore_number_read(text, length, number) == length && isfinite(*number);
}

/* To six digits. */
static char *value_text(double value) {
  char digits[SPORE_NUMBER_TEXT];
  spore_number_format_rounded(value, 6, digits);
  return g_strdup(digits);
}

/* LOW..HIGH:COUNT or LOW..HIGH:COUNT:log, whose numbers are evenly spaced, or their logarithms are. NULL: it is not. */
static char **range_of(const char *text) {
  g_auto(GStrv) parts = g_strsplit(text, ":", 4);
  guint count = g_strv_length(parts);
  g_auto(GStrv) ends = g_strsplit(count > 0 ? parts[0] : "", "..", 2);
  double low, high;
  guint64 number;
  gboolean logarithmic = count == 3 && g_str_equal(parts[2], "log");
  if (count < 2 || (count > 2 && !logarithmic) || g_strv_length(ends) != 2 || !read_number(ends[0], &low) ||
      !read_number(ends[1], &high) || !g_ascii_string_to_unsigned(parts[1], 10, 2, VALUES_MAXIMUM, &number, NULL) ||
      (logarithmic && !(low > 0 && high > 0)))
    return NULL;
  char **values = g_new0(char *, number + 1);
  for (guint64 i = 0; i < number; i++) {
    double part = (double)i / (double)(number - 1);
    double value = logarithmic ? low * pow(high / low, part) : low + part * (high - low);
    values[i] = value_text(i == 0 ? low : i + 1 == number ? high : value);
  }
  return values;
}

/* A range, or what stands between commas. NULL with a GError: a value is empty or stands there twice. */
static char **values_of(const char *option, const char *text, GError **error) {
  char **range = range_of(text);
  if (range) return range;
  g_auto(GStrv) values = g_strsplit(text, ",", 0);
  for (guint i = 0; values[i]; i++) {
    g_strstrip(values[i]);
    gboolean again = FALSE;
    for (guint k = 0; k < i; k++) again |= g_str_equal(values[i], values[k]);
    if (values[i][0] && !again) continue;
    if (again)
      spore_error_raise(error, SPORE_ERROR_INPUT, option,
                        _("\"%s\" stands there twice; expected different values; leave one out"), values[i]);
    else
      spore_error_raise(error, SPORE_ERROR_INPUT, option,
                        _("a value is empty; expected values with commas between them, or LOW..HIGH:COUNT, or "
                          "LOW..HIGH:COUNT:log; correct it"));
    return NULL;
  }
  if (values[0] && g_strv_length(values) <= VALUES_MAXIMUM) return g_steal_pointer(&values);
  spore_error_raise(error, SPORE_ERROR_INPUT, option, _("expected 1 to %d values; give some"), VALUES_MAXIMUM);
  return NULL;
}

static gboolean add_varied(GArray *axes, char **vary, GError **error) {
  for (; vary && *vary; vary++) {
    const char *equals = strchr(*vary, '=');
    if (!equals)
      return spore_error_raise(error, SPORE_ERROR_INPUT, "--vary",
                               _("%s names no values; expected PATH=VALUES, such as "
                                 "bodies/liver/collision/stiffness=100..800:5; correct it"),
                               *vary);
    char **values = values_of("--vary", equals + 1, error);
    if (!values) return FALSE;
    g_autofree char *name = g_strndup(*vary, (gsize)(equals - *vary));
    add_axis(axes, name, "--set", TRUE, values);
  }
  return TRUE;
}

static gboolean add_listed(GArray *axes, const char *name, const char *option, const char *list, GError **error) {
  if (!list) return TRUE;
  g_autofree char *given = g_strconcat(option, "s", NULL);
  char **values = values_of(given, list, error);
  if (values) add_axis(axes, name, option, FALSE, values);
  return values != NULL;
}

static gboolean add_repeats(GArray *axes, int repeats, GError **error) {
  if (repeats < 1 || repeats > VALUES_MAXIMUM)
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--repeats", _("%d; expected 1 to %d; correct it"), repeats,
                             VALUES_MAXIMUM);
  char **values = g_new0(char *, (gsize)repeats + 1);
  for (int i = 0; i < repeats; i++) values[i] = g_strdup_printf("%d", i + 1);
  if (repeats > 1) add_axis(axes, "repeat", NULL, FALSE, values);
  else g_strfreev(values);
  return TRUE;
}

/* Scenes first: they are axis 0. */
static GArray *find_axes(const PlanOptions *options, char **scenes, GError **error) {
  g_autoptr(GArray) axes = g_array_new(FALSE, FALSE, sizeof(Axis));
  g_array_set_clear_func(axes, axis_clear);
  add_axis(axes, "scene", NULL, FALSE, g_strdupv(scenes));
  gboolean found = add_varied(axes, options->vary, error) &&
                   add_listed(axes, "integrator", "--integrator", options->integrators, error) &&
                   add_listed(axes, "input", "--input", options->inputs, error) &&
                   add_repeats(axes, options->repeats, error);
  return found ? g_steal_pointer(&axes) : NULL;
}

/* Checks. */

/* Commands that report on a scene. Options that write a file are refused, since all cases would write the same one. */
static gboolean check_command(char **command, GError **error) {
  static const char *const known[] = {"run", "accuracy", "stability", "plan", "check", "advise", NULL};
  static const char *const writing[] = {"-o",    "--output", "--record", "--svg", "--png",
                                        "--csv", "--html",   "--apply",  NULL};
  if (spore_cli_choice("--command", command[0], known, error) < 0) return FALSE;
  for (char **argument = command + 1; *argument; argument++)
    for (const char *const *option = writing; *option; option++)
      if (g_str_has_prefix(*argument, *option))
        return spore_error_raise(error, SPORE_ERROR_INPUT, "--command",
                                 _("%s writes a file, and all cases would write the same one; expected a command that "
                                   "only reports; leave it out: results are collected from --json"),
                                 *argument);
  return TRUE;
}

/* Whether the scene takes the value of one axis, while all others are as the scene has them. */
static gboolean check_value(SporeCli *cli, const char *scene, const Axis *axis, const char *value, GError **error) {
  g_autofree char *setting = g_strdup_printf("%s=%s", axis->name, value);
  char *set[] = {setting, NULL};
  SporeSceneOptions options = {.set = axis->setting ? set : NULL};
  if (g_strcmp0(axis->option, "--integrator") == 0) options.integrator = (char *)value;
  if (g_strcmp0(axis->option, "--input") == 0) {
    g_autoptr(GBytes) track = spore_cli_read_file(value, _("a track"), error);
    if (!track) return FALSE;
  }
  SporeDocument *document = spore_cli_load(cli, scene, &options, error);
  if (document) spore_document_free(document);
  return document != NULL;
}

static gboolean check_values(SporeCli *cli, const GArray *axes, GError **error) {
  char **scenes = g_array_index(axes, Axis, 0).values;
  guint total = 0, done = 0;
  for (guint a = 1; a < axes->len; a++) total += g_strv_length(g_array_index(axes, Axis, a).values);
  total *= g_strv_length(scenes);
  for (; *scenes; scenes++)
    for (guint a = 1; a < axes->len; a++) {
      const Axis *axis = &g_array_index(axes, Axis, a);
      for (char **value = axis->values; *value; value++) {
        if (!spore_progress(spore_cli_progress(cli), (double)done++ / total, _("checking values")))
          return spore_error_raise(error, SPORE_ERROR_CANCELLED, NULL, _("interrupted; nothing was written"));
        if (axis->option && !check_value(cli, *scenes, axis, *value, error)) return FALSE;
      }
    }
  spore_progress(spore_cli_progress(cli), 1, NULL);
  return TRUE;
}

/* Cases. */

typedef struct Planner {
  const GArray *axes;
  char **command;
  const char *folder; /* of the manifest */
  char **scene_hashes, **input_hashes;
} Planner;

static guint64 hash_text(guint64 hash, const char *text) { return spore_hash(hash, text, strlen(text) + 1); }

/* Files are named from the manifest's folder, where the case runs. */
static char *argument_of(const Planner *planner, const Axis *axis, const char *value) {
  if (axis->setting) return g_strdup_printf("--set=%s=%s", axis->name, value);
  g_autofree char *path =
      g_str_equal(axis->option, "--input") ? spore_sweep_path_from(planner->folder, value) : g_strdup(value);
  return g_strdup_printf("%s=%s", axis->option, path);
}

/* picked: of each axis, the number of a value. */
static SporeSweepCase *make_case(const Planner *planner, guint number, const guint *picked) {
  SporeSweepCase *one = spore_sweep_case_new(number);
  g_autoptr(GPtrArray) arguments = g_ptr_array_new(), values = g_ptr_array_new();
  one->scene = spore_sweep_path_from(planner->folder, g_array_index(planner->axes, Axis, 0).values[picked[0]]);
  one->scene_hash = g_strdup(planner->scene_hashes[picked[0]]);
  guint64 hash = hash_text(hash_text(SPORE_HASH_INIT, SPORE_VERSION), one->scene_hash);
  g_ptr_array_add(arguments, g_strdup(planner->command[0]));
  g_ptr_array_add(arguments, g_strdup(one->scene));
  g_ptr_array_add(arguments, g_strdup("--json"));
  for (char **word = planner->command + 1; *word; word++) g_ptr_array_add(arguments, g_strdup(*word));
  for (guint a = 0; a < planner->axes->len; a++) {
    const Axis *axis = &g_array_index(planner->axes, Axis, a);
    const char *value = axis->values[picked[a]];
    g_ptr_array_add(values, a == 0 ? g_path_get_basename(value) : g_strdup(value));
    if (axis->option) g_ptr_array_add(arguments, argument_of(planner, axis, value));
    gboolean track = g_strcmp0(axis->option, "--input") == 0;
    if (a > 0) hash = hash_text(hash_text(hash, axis->name), track ? planner->input_hashes[picked[a]] : value);
  }
  for (char **word = planner->command; *word; word++) hash = hash_text(hash, *word);
  g_ptr_array_add(arguments, NULL), g_ptr_array_add(values, NULL);
  one->arguments = (char **)g_ptr_array_steal(arguments, NULL);
  one->values = (char **)g_ptr_array_steal(values, NULL);
  one->hash = g_strdup_printf("%016" G_GINT64_MODIFIER "x", hash);
  return one;
}

/* The last axis runs fastest. FALSE: the last combination was picked. */
static gboolean next(const GArray *axes, guint *picked) {
  for (guint a = axes->len; a-- > 0;) {
    if (g_array_index(axes, Axis, a).values[++picked[a]]) return TRUE;
    picked[a] = 0;
  }
  return FALSE;
}

static GPtrArray *make_cases(const Planner *planner) {
  GPtrArray *cases = g_ptr_array_new_with_free_func((GDestroyNotify)spore_sweep_case_free);
  g_autofree guint *picked = g_new0(guint, planner->axes->len);
  do g_ptr_array_add(cases, make_case(planner, cases->len, picked));
  while (next(planner->axes, picked));
  return cases;
}

static gboolean count_cases(const GArray *axes, GError **error) {
  double count = 1;
  for (guint a = 0; a < axes->len; a++) count *= g_strv_length(g_array_index(axes, Axis, a).values);
  if (count <= SPORE_SWEEP_CASES_MAXIMUM) return TRUE;
  return spore_error_raise(error, SPORE_ERROR_INPUT, NULL,
                           _("these are %.0f cases; expected at most %d; give fewer values, or plan several sweeps"),
                           count, SPORE_SWEEP_CASES_MAXIMUM);
}

static char **hash_scenes(SporeCli *cli, char **scenes, GError **error) {
  g_auto(GStrv) hashes = g_new0(char *, g_strv_length(scenes) + 1);
  for (guint i = 0; scenes[i]; i++)
    if (!(hashes[i] = spore_sweep_scene_hash(cli, scenes[i], error))) return NULL;
  return g_steal_pointer(&hashes);
}

/* Of the tracks, if they are an axis. */
static char **hash_inputs(const GArray *axes, GError **error) {
  g_autoptr(GStrvBuilder) hashes = g_strv_builder_new();
  for (guint a = 1; a < axes->len; a++) {
    const Axis *axis = &g_array_index(axes, Axis, a);
    for (char **file = axis->values; g_strcmp0(axis->option, "--input") == 0 && *file; file++) {
      g_autoptr(GBytes) track = spore_cli_read_file(*file, _("a track"), error);
      if (!track) return NULL;
      gsize size;
      const void *bytes = g_bytes_get_data(track, &size);
      g_autofree char *hash = g_strdup_printf("%016" G_GINT64_MODIFIER "x", spore_hash(SPORE_HASH_INIT, bytes, size));
      g_strv_builder_add(hashes, hash);
    }
  }
  return g_strv_builder_end(hashes);
}

/* Scripts that hand the cases to others. */

static gboolean write_script(const char *file, const char *text, GError **error) {
  if (!spore_write_file(file, text, strlen(text), error)) return FALSE;
  if (g_chmod(file, 0755) == 0) return TRUE;
  return spore_error_raise(error, SPORE_ERROR_FILE, file, _("cannot be made executable (%s); do that by hand"),
                           g_strerror(errno));
}

static gboolean write_scripts(const PlanOptions *options, guint cases, GError **error) {
  g_autofree char *program = g_file_read_link("/proc/self/exe", NULL),
                  *manifest = g_canonicalize_filename(options->output, NULL);
  g_autofree char *spore = g_shell_quote(program ? program : "spore"), *sweep = g_shell_quote(manifest);
  g_autofree char *slurm = g_strdup_printf("#!/bin/sh\n"
                                           "#SBATCH --job-name=spore-sweep\n"
                                           "#SBATCH --array=0-%u\n"
                                           "#SBATCH --ntasks=1 --cpus-per-task=1 --output=/dev/null\n"
                                           "exec %s sweep run --quiet %s --case \"$SLURM_ARRAY_TASK_ID\"\n",
                                           cases - 1, spore, sweep);
  g_autofree char *parallel = g_strdup_printf("#!/bin/sh\n"
                                              "seq 0 %u | parallel --joblog %s.joblog --retries 3 --resume-failed \\\n"
                                              "  %s sweep run --quiet %s --case {}\n",
                                              cases - 1, sweep, spore, sweep);
  return (!options->slurm || write_script(options->slurm, slurm, error)) &&
         (!options->parallel || write_script(options->parallel, parallel, error));
}

static int say_plan(SporeCli *cli, const PlanOptions *options, const SporeManifest *sweep) {
  spore_cli_text(cli, "manifest", options->output);
  spore_cli_open_array(cli, "cases");
  for (guint i = 0; i < sweep->cases->len; i++) {
    const SporeSweepCase *one = g_ptr_array_index(sweep->cases, i);
    spore_cli_open(cli, NULL);
    spore_cli_count(cli, "case", one->number);
    spore_cli_text(cli, "hash", one->hash);
    for (guint a = 0; sweep->axes[a]; a++) spore_cli_text(cli, sweep->axes[a], one->values[a]);
    spore_cli_close(cli);
  }
  spore_cli_close_array(cli);
  g_autofree char *axes = g_strjoinv(", ", sweep->axes), *name = g_shell_quote(options->output);
  spore_cli_say(cli, _("%s: %u cases, of %s\n"), options->output, sweep->cases->len, axes);
  spore_cli_say(cli, _("run them by: spore sweep run %s\n"), name);
  if (options->slurm) spore_cli_say(cli, _("or on a cluster by: sbatch %s\n"), options->slurm);
  if (options->parallel) spore_cli_say(cli, _("or by GNU parallel: sh %s\n"), options->parallel);
  return spore_cli_finish(cli, SPORE_EXIT_DONE);
}

static gboolean has_room(const PlanOptions *options, char **scenes, GError **error) {
  const char *const outputs[] = {options->output, options->slurm, options->parallel};
  for (gsize i = 0; i < G_N_ELEMENTS(outputs); i++)
    for (char **scene = scenes; outputs[i] && *scene; scene++)
      if (!spore_cli_has_room(outputs[i], *scene, error)) return FALSE;
  return TRUE;
}

static int plan(SporeCli *cli, const PlanOptions *options, char **scenes) {
  GError *error = NULL;
  g_auto(GStrv) command = NULL;
  if (!options->output) return spore_cli_usage(_("spore sweep plan: where to? expected -o F.sweep; name a file"));
  if (!g_shell_parse_argv(options->command ? options->command : "run", NULL, &command, NULL))
    return spore_cli_usage(_("--command: \"%s\" cannot be told into words; expected such as \"run --steps 500\""),
                           options->command);
  if (!check_command(command, &error) || !has_room(options, scenes, &error)) return spore_cli_fail(error);
  g_autoptr(GArray) axes = find_axes(options, scenes, &error);
  if (!axes || !count_cases(axes, &error) || !check_values(cli, axes, &error)) return spore_cli_fail(error);
  g_auto(GStrv) scene_hashes = hash_scenes(cli, scenes, &error);
  g_auto(GStrv) input_hashes = scene_hashes ? hash_inputs(axes, &error) : NULL;
  if (!input_hashes) return spore_cli_fail(error);
  g_autoptr(GStrvBuilder) names = g_strv_builder_new();
  for (guint a = 0; a < axes->len; a++) g_strv_builder_add(names, g_array_index(axes, Axis, a).name);
  g_autofree char *folder = g_path_get_dirname(options->output);
  const Planner planner = {axes, command, folder, scene_hashes, input_hashes};
  g_autoptr(SporeManifest) sweep = g_new0(SporeManifest, 1);
  sweep->axes = g_strv_builder_end(names);
  sweep->cases = make_cases(&planner);
  g_autofree char *text = spore_sweep_format(sweep);
  if (!spore_write_file(options->output, text, strlen(text), &error) ||
      !write_scripts(options, sweep->cases->len, &error))
    return spore_cli_fail(error);
  return say_plan(cli, options, sweep);
}

int spore_sweep_plan(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"manifest", N_("the file that was written")},
      {"cases", N_("each one's case (its number), hash (of all that its result follows from), and a member for each "
                   "axis: what differs between cases")},
      {NULL}};
  PlanOptions options = {.repeats = 1};
  const GOptionEntry entries[] = {
      {"output", 'o', 0, G_OPTION_ARG_FILENAME, &options.output, N_("The manifest"), "F.sweep"},
      {"vary", 0, 0, G_OPTION_ARG_STRING_ARRAY, &options.vary,
       N_("Values of a property: PATH=1000,2000 or PATH=1000..8000:5 or PATH=1e3..1e5:5:log"), "PATH=VALUES"},
      {"integrators", 0, 0, G_OPTION_ARG_STRING, &options.integrators, N_("Integrators, with commas between them"),
       "NAMES"},
      {"inputs", 0, 0, G_OPTION_ARG_STRING, &options.inputs, N_("Recorded device inputs, with commas between them"),
       "TRACKS"},
      {"repeats", 0, 0, G_OPTION_ARG_INT, &options.repeats, N_("Run each so often, for what the clock decides"), "N"},
      {"command", 0, 0, G_OPTION_ARG_STRING, &options.command,
       N_("What runs (default \"run\"): \"run --steps 500\", \"accuracy --seconds 12\", \"stability --quick\""),
       "TEXT"},
      {"slurm", 0, 0, G_OPTION_ARG_FILENAME, &options.slurm, N_("Write a script for sbatch, too: a job array"), "F.sh"},
      {"parallel", 0, 0, G_OPTION_ARG_FILENAME, &options.parallel, N_("Write a script for GNU parallel, too"), "F.sh"},
      G_OPTION_ENTRY_NULL};
  static const SporeCommandInfo info = {
      .name = "sweep plan",
      .arguments = "SCENE...",
      .summary = N_("Writes a manifest with one line for each combination of scenes and settings. Every value is tried "
                    "on every scene before."),
      .minimum = 1,
      .maximum = 10000,
      .report = members};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE) status = plan(cli, &options, argv + 1);
  g_strfreev(options.vary);
  char *texts[] = {options.integrators, options.inputs, options.command,
                   options.output,      options.slurm,  options.parallel};
  for (gsize i = 0; i < G_N_ELEMENTS(texts); i++) g_free(texts[i]);
  return status;
}
