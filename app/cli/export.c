/* spore export: a scene for other programs, and for running it without SPORE. */
#include <glib/gi18n.h>

#include "app/cli/cli.h"
#include "app/cli/scene.h"
#include "core/base/memory.h"
#include "core/io/scene_xml.h"
#include "core/scene/compile_runtime.h"

typedef struct ExportOptions {
  char *format, *output;
  SporeSceneOptions scene;
} ExportOptions;

/* What one export has to tell. */
typedef struct Written {
  gsize bytes;
  GPtrArray *lost; /* sentences, g_free */
} Written;

/* One format: its name, and what makes the content of its file. */
typedef struct ExportFormat {
  const char *name;
  const char *left_out; /* of what the scene holds, translatable: the file needs none of it */
  gpointer (*make)(SporeDocument *document, const SporeTrack *input, Written *written, GError **error);
} ExportFormat;

static gpointer make_runtime(SporeDocument *document, const SporeTrack *input, Written *written, GError **error) {
  g_autoptr(GPtrArray) undrawn = g_ptr_array_new_with_free_func(g_free);
  gpointer content =
      spore_document_format_runtime(document, input, spore_cli_cancel(), undrawn, &written->bytes, error);
  for (guint i = 0; content && i < undrawn->len; i++)
    g_ptr_array_add(written->lost, g_strdup_printf(_("%s: it has no visual mesh, and what SPORE draws in place of one "
                                                     "is not in the file"),
                                                   (const char *)undrawn->pdata[i]));
  if (content && spore_object_child_count(spore_document_section(document, "exercise")) > 0)
    g_ptr_array_add(written->lost, g_strdup(_("the exercise: its steps and metrics are not in the file")));
  return content;
}

static const ExportFormat formats[] = {
    {"runtime", N_("comments, metadata, settings of generators, colours and names of tissues, unused assets"),
     make_runtime},
};

static void report(SporeCli *cli, const char *file, const ExportFormat *format, const Written *written) {
  spore_cli_open_array(cli, "written");
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "file", file);
  spore_cli_count(cli, "bytes", (gint64)written->bytes);
  spore_cli_close(cli);
  spore_cli_close_array(cli);
  spore_cli_say(cli, _("%s: %zu bytes\n"), file, written->bytes);
  spore_cli_open_array(cli, "lost");
  for (guint i = 0; i < written->lost->len; i++) {
    spore_cli_text(cli, NULL, written->lost->pdata[i]);
    spore_cli_say(cli, _("lost: %s\n"), (const char *)written->lost->pdata[i]);
  }
  spore_cli_close_array(cli);
  spore_cli_open_array(cli, "left_out");
  spore_cli_text(cli, NULL, _(format->left_out));
  spore_cli_close_array(cli);
  spore_cli_say(cli, _("left out: %s\n"), _(format->left_out));
}

static gboolean export(SporeCli *cli, const char *scene, const ExportOptions *options, const ExportFormat *format,
                       GError **error) {
  SporeTrack input = {0};
  Written written = {.lost = g_ptr_array_new_with_free_func(g_free)};
  SporeDocument *document = NULL;
  gpointer content = NULL;
  if (spore_cli_has_room(options->output, scene, error) &&
      (!options->scene.input || spore_cli_read_track(options->scene.input, &input, error)))
    document = spore_cli_load(cli, scene, &options->scene, error);
  if (document) content = format->make(document, options->scene.input ? &input : NULL, &written, error);
  gboolean done = content && spore_write_file(options->output, content, written.bytes, error);
  if (done) report(cli, options->output, format, &written);
  spore_free(content);
  g_clear_pointer(&document, spore_document_free);
  spore_track_clear(&input);
  g_ptr_array_unref(written.lost);
  return done;
}

/* The format of that name; NULL after a message. */
static const ExportFormat *find_format(const char *name) {
  const char *names[G_N_ELEMENTS(formats) + 1] = {NULL};
  for (gsize i = 0; i < G_N_ELEMENTS(formats); i++) names[i] = formats[i].name;
  GError *error = NULL;
  int found = spore_cli_choice("--format", name, names, &error);
  if (found < 0) spore_cli_fail(error);
  return found < 0 ? NULL : &formats[found];
}

static int run(SporeCli *cli, const char *scene, const ExportOptions *options) {
  if (!options->format)
    return spore_cli_usage(_("spore export: no format is given; expected --format runtime; add it"));
  if (!options->output) return spore_cli_usage(_("spore export: no file to write is given; expected -o F; add it"));
  const ExportFormat *format = find_format(options->format);
  GError *error = NULL;
  if (!format) return SPORE_EXIT_INPUT;
  return export(cli, scene, options, format, &error) ? spore_cli_finish(cli, SPORE_EXIT_DONE) : spore_cli_fail(error);
}

int spore_command_export(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {{"written", N_("each file: file (as given), bytes")},
                                              {"lost", N_("sentences: what of the scene the format cannot hold")},
                                              {"left_out", N_("what the file does not need")},
                                              {NULL, NULL}};
  static const SporeCommandInfo info = {
      "export",
      "SCENE",
      N_("Writes a scene for other programs. --format runtime: the compiled scene in one file, which libspore and "
         "spore-player load without GLib and XML, and run to the same bits."),
      1,
      1,
      members};
  ExportOptions options = {0};
  const GOptionEntry entries[] = {
      {"format", 'f', 0, G_OPTION_ARG_STRING, &options.format, N_("What to write: runtime"), "NAME"},
      {"output", 'o', 0, G_OPTION_ARG_FILENAME, &options.output, N_("File to write"), "F"},
      SPORE_SCENE_OPTION_ENTRIES(options.scene),
      G_OPTION_ENTRY_NULL};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE) status = run(cli, argv[1], &options);
  spore_scene_options_clear(&options.scene);
  g_free(options.format);
  g_free(options.output);
  return status;
}
