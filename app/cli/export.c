/* spore export: a scene for other programs, and for running it without SPORE. */
#include "app/cli/export.h"

#include <glib/gi18n.h>
#include <string.h>

#include "app/cli/scene.h"

typedef struct ExportOptions {
  char *format, *output, *time, *every;
  SporeSceneOptions scene;
} ExportOptions;

/* What a format shows of a run. */
typedef enum ExportMoments {
  EXPORT_NO_MOMENT,  /* the scene as such: neither --time nor --every */
  EXPORT_ONE_MOMENT, /* --time */
  EXPORT_SERIES      /* both */
} ExportMoments;

/* One format: its name, what it is, and what writes it. */
typedef struct ExportFormat {
  const char *name;
  ExportMoments moments;
  const char *doc; /* translatable, for --help */
  gboolean (*write)(SporeExport *export, GError **error);
} ExportFormat;

static const ExportFormat formats[] = {
    {"bundle", EXPORT_NO_MOMENT,
     N_("the scene and the files that its run needs in one .sporez file, which spore and the editor open like a scene"),
     spore_export_bundle},
    {"runtime", EXPORT_NO_MOMENT,
     N_("the compiled scene in one file, which libspore and spore-player load without GLib and XML, and run to the "
        "same bits"),
     spore_export_runtime},
    {"player", EXPORT_NO_MOMENT,
     N_("a folder, -o FOLDER, with the runtime file and spore-player, which runs where nothing but the C library is: "
        "./play there"),
     spore_export_player},
    {"vtk", EXPORT_SERIES,
     N_("a series over time that ParaView opens, -o F.pvd or a folder: surfaces, tetrahedra with displacement and "
        "strain, lines, particles, all with velocities"),
     spore_export_vtk},
    {"gltf", EXPORT_SERIES,
     N_("one .glb file: surfaces with materials; over time, rigid bodies as tracks, others as morph targets of few key "
        "frames"),
     spore_export_gltf},
    {"obj", EXPORT_ONE_MOMENT,
     N_("the surfaces at a moment, in metres: an object for each body, and F.mtl with the colours"), spore_export_obj},
    {"ply", EXPORT_ONE_MOMENT, N_("the surfaces at a moment, in metres: one mesh with colours"), spore_export_ply},
    {"stl", EXPORT_ONE_MOMENT, N_("the surfaces at a moment, in metres: one mesh"), spore_export_stl},
    {"mjcf", EXPORT_ONE_MOMENT, N_("rigid bodies at a moment for MuJoCo 2.2: spheres, masses, springs, ball joints"),
     spore_export_mjcf},
    {"sofa", EXPORT_NO_MOMENT,
     N_("the start of the scene for SOFA (.scn): rigid bodies, tetrahedra and springs, with masses, spheres and pins"),
     spore_export_sofa},
};

static gboolean export_scene(SporeExport *export, const char *scene, const SporeSceneOptions *options,
                             const ExportFormat *format, GError **error) {
  SporeTrack input = {0};
  if (spore_cli_has_room(export->output, scene, error) &&
      (!options->input || spore_cli_read_track(options->input, &input, error)))
    export->document = spore_cli_load(export->cli, scene, options, error);
  export->input = options->input ? &input : NULL;
  gboolean done = export->document && format->write(export, error);
  spore_track_clear(&input);
  return done;
}

static gboolean check_moments(const ExportOptions *options, const ExportFormat *format, GError **error) {
  const char *option = options->every ? "--every" : "--time";
  ExportMoments asked = options->every ? EXPORT_SERIES : options->time ? EXPORT_ONE_MOMENT : EXPORT_NO_MOMENT;
  if (asked > format->moments)
    return spore_error_raise(error, SPORE_ERROR_INPUT, option,
                             _("format %s has no such thing; expected a format that shows moments of a run; leave it "
                               "out"),
                             format->name);
  return !options->every || options->time ||
         spore_error_raise(error, SPORE_ERROR_INPUT, option,
                           _("no time to run is given; expected --time S beside it; add that"));
}

static int run_export(SporeCli *cli, const char *scene, const ExportOptions *options, const ExportFormat *format) {
  SporeExport export = {.cli = cli, .output = options->output, .time = options->time, .every = options->every};
  GError *error = NULL;
  spore_export_init(&export);
  gboolean done =
      check_moments(options, format, &error) && export_scene(&export, scene, &options->scene, format, &error);
  if (done) spore_export_report(&export);
  spore_export_clear(&export);
  return done ? spore_cli_finish(cli, SPORE_EXIT_DONE) : spore_cli_fail(error);
}

static void list_names(const char *names[G_N_ELEMENTS(formats) + 1]) {
  for (gsize i = 0; i < G_N_ELEMENTS(formats); i++) names[i] = formats[i].name;
  names[G_N_ELEMENTS(formats)] = NULL;
}

/* The format of that name; NULL after a message. */
static const ExportFormat *find_format(const char *name) {
  const char *names[G_N_ELEMENTS(formats) + 1];
  list_names(names);
  GError *error = NULL;
  int found = spore_cli_choice("--format", name, names, &error);
  if (found < 0) spore_cli_fail(error);
  return found < 0 ? NULL : &formats[found];
}

static int refuse_no_format(void) {
  const char *names[G_N_ELEMENTS(formats) + 1];
  list_names(names);
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
  const ExportFormat *format = find_format(options->format);
  return format ? run_export(cli, scene, options, format) : SPORE_EXIT_INPUT;
}

static char *describe_formats(void) {
  GString *text = g_string_new(_("Formats:"));
  for (gsize i = 0; i < G_N_ELEMENTS(formats); i++)
    g_string_append_printf(text, "\n  %-9s %s", formats[i].name, _(formats[i].doc));
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
