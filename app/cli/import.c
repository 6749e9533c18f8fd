/* spore import: a new scene from organ meshes. */
#include <glib/gi18n.h>
#include <string.h>

#include "app/cli/scene.h"
#include "core/author/organ_import.h"
#include "core/io/mesh_import.h"
#include "core/io/scene_xml.h"

static void report_figures(SporeCli *cli, const char *member, const SporeMeshFigures *figures) {
  spore_cli_open(cli, member);
  spore_cli_count(cli, "triangles", (gint64)figures->triangles);
  spore_cli_count(cli, "components", (gint64)figures->report.components);
  spore_cli_count(cli, "boundary_edges", (gint64)figures->report.boundary_edges);
  spore_cli_count(cli, "nonmanifold_edges", (gint64)figures->report.nonmanifold_edges);
  spore_cli_count(cli, "degenerate_triangles", (gint64)figures->report.degenerate_triangles);
  spore_cli_number(cli, "volume_m3", figures->report.volume);
  spore_cli_number(cli, "area_m2", figures->report.area);
  spore_cli_close(cli);
}

static void say_row(const SporeCli *cli, const char *what, const SporeMeshFigures *figures, double moved) {
  g_autofree char *distance = moved < 0 ? g_strdup("") : spore_length_text(moved < 1e-9 ? 0 : moved);
  spore_cli_say(cli, "  %-12s %9zu %10zu %8zu %12zu %10.4g %10.4g  %s\n", what, figures->triangles,
                figures->report.components, figures->report.boundary_edges, figures->report.nonmanifold_edges,
                1e6 * figures->report.volume, 1e4 * figures->report.area, distance);
}

static void report_changes(SporeCli *cli, const SporeImportBody *body) {
  spore_cli_open_array(cli, "operations");
  for (guint i = 0; i < body->changes->len; i++) {
    const SporeMeshChange *change = &g_array_index(body->changes, SporeMeshChange, i);
    const SporeMeshOperation *operation = &spore_mesh_operations[change->operation];
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "name", operation->name);
    if (operation->argument) spore_cli_number(cli, "argument", change->argument);
    report_figures(cli, "before", &change->before);
    report_figures(cli, "after", &change->after);
    spore_cli_number(cli, "moved_m", change->moved);
    spore_cli_close(cli);
    say_row(cli, operation->name, &change->after, change->moved);
  }
  spore_cli_close_array(cli);
}

/* name: of the body in the scene. */
static void report_mesh(SporeCli *cli, const SporeImportBody *body, const char *name, int unit) {
  const SporeMeshReport *figures = &body->as_read.report;
  g_autofree char *size = spore_length_text(figures->diagonal);
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "body", name);
  spore_cli_text(cli, "group", *body->group ? body->group : NULL);
  spore_cli_open_array(cli, "colour");
  for (int k = 0; body->coloured && k < 3; k++) spore_cli_number(cli, NULL, body->colour[k]);
  spore_cli_close_array(cli);
  spore_cli_text(cli, "file", body->source ? body->source->file : NULL);
  if (body->source) unit = body->source->unit;
  spore_cli_text(cli, "unit", unit < 0 ? NULL : spore_length_units[unit]); /* null: several files, each with its own */
  spore_cli_text(cli, "frame", body->source ? spore_mesh_frames[body->source->frame] : NULL);
  spore_cli_number(cli, "diagonal_m", figures->diagonal);
  report_figures(cli, "as_read", &body->as_read);
  spore_cli_say(cli, _("%s: %s across, unit %s, axes %s\n"), name, size,
                unit < 0 ? _("of several files") : spore_length_units[unit],
                body->source ? spore_mesh_frames[body->source->frame] : _("of several files"));
  spore_cli_say(cli, "  %-12s %9s %10s %8s %12s %10s %10s  %s\n", "", _("triangles"), _("components"), _("boundary"),
                _("non-manifold"), _("volume cm3"), _("area cm2"), _("moved"));
  say_row(cli, _("as read"), &body->as_read, -1);
  report_changes(cli, body);
  spore_cli_close(cli);
}

/* remark: "what; remedy"; NULL: none. */
static void report_remark(SporeCli *cli, const char *place, const char *remark) {
  const char *remedy = remark ? strstr(remark, "; ") : NULL;
  if (!remedy) return;
  g_autofree char *what = g_strndup(remark, (gsize)(remedy - remark));
  spore_cli_diagnostic(cli, place, what, remedy + 2);
}

static void report_diagnostics(SporeCli *cli, SporeDocument *document, const SporeImport *import) {
  spore_cli_open_array(cli, "diagnostics");
  for (guint i = 0; i < import->files->len; i++) {
    const SporeImportFile *file = g_ptr_array_index(import->files, i);
    g_autofree char *remark = spore_import_remark(file);
    report_remark(cli, file->file, remark);
  }
  for (guint i = 0; i < import->bodies->len; i++) {
    const SporeImportBody *body = g_ptr_array_index(import->bodies, i);
    g_autofree char *doubt = spore_import_doubt(body), *burden = spore_import_burden(body);
    g_autofree char *option =
        burden ? g_strdup_printf("%s (--%s %u)", burden, spore_mesh_operations[SPORE_MESH_DECIMATE].name,
                                 SPORE_IMPORT_TRIANGLES_ENOUGH)
               : NULL;
    report_remark(cli, body->name, option);
    report_remark(cli, body->name, doubt);
    report_remark(cli, body->name, body->untextured);
    report_remark(cli, body->name, body->unclear);
  }
  spore_cli_diagnostics(cli, document);
  spore_cli_close_array(cli);
}

static void report(SporeCli *cli, SporeDocument *document, const SporeImport *import, const GPtrArray *bodies,
                   int unit) {
  SporeObject *all = spore_document_section(document, "bodies");
  spore_cli_open_array(cli, "bodies");
  for (guint i = 0; i < spore_object_child_count(all); i++)
    spore_cli_text(cli, NULL, spore_object_name(spore_object_child(all, i)));
  spore_cli_close_array(cli);
  spore_cli_open_array(cli, "meshes");
  for (guint i = 0; i < import->bodies->len; i++)
    report_mesh(cli, g_ptr_array_index(import->bodies, i), spore_object_name(g_ptr_array_index(bodies, i)), unit);
  spore_cli_close_array(cli);
  report_diagnostics(cli, document, import);
}

/* The scene that the bodies are added to. */
static SporeDocument *open_scene(SporeCli *cli, const char *output, gboolean add, GError **error) {
  if (add) return spore_scene_load(cli->schema, output, error);
  if (g_file_test(output, G_FILE_TEST_EXISTS)) spore_cli_say(cli, _("--add would have kept what is there:\n"));
  return spore_cli_new_scene(cli, output);
}

static int import(SporeCli *cli, char **meshes, const SporeImportOptions *options, const char *output, gboolean add) {
  GError *error = NULL;
  gboolean done = TRUE;
  for (char **mesh = meshes; *mesh && done; mesh++) done = spore_cli_has_room_for_scene(output, *mesh, &error);
  g_autoptr(SporeImport) found = done ? spore_import_read(meshes, options, spore_cli_progress(cli), &error) : NULL;
  g_autoptr(GPtrArray) bodies = NULL;
  SporeDocument *document = found ? open_scene(cli, output, add, &error) : NULL;
  done = document && spore_import_insert(document, found, &bodies, &error) &&
         spore_cli_save_scene(document, output, &error);
  if (done) {
    spore_cli_say(cli, _("%s: written\n"), output);
    report(cli, document, found, bodies, options->unit);
  }
  if (document) spore_document_free(document);
  return done ? spore_cli_finish(cli, SPORE_EXIT_DONE) : spore_cli_fail(error);
}

/* The options as they are given, before they are read. */
typedef struct Request {
  char *unit, *frame, *output;
  gboolean merge, add;
  SporeImportOptions options;
} Request;

static gboolean read_operation(const char *name, const char *text, gpointer data, GError **error) {
  Request *request = data;
  int kind = 0;
  while (strcmp(spore_mesh_operations[kind].name, name + 2) != 0) kind++; /* without the leading dashes */
  const SporeMeshOperation *operation = &spore_mesh_operations[kind];
  double value = operation->usual;
  char *end = NULL;
  if (text) value = g_ascii_strtod(text, &end);
  if (text && (end == text || *end || !spore_mesh_argument_is_valid(operation, value))) {
    g_set_error(error, G_OPTION_ERROR, G_OPTION_ERROR_BAD_VALUE,
                operation->whole ? _("%s %s: expected a whole number from %g to %g")
                                 : _("%s %s: expected a number from %g to %g"),
                name, text, operation->minimum, operation->maximum);
    return FALSE;
  }
  request->options.operations[kind].wanted = true;
  request->options.operations[kind].argument = value;
  return TRUE;
}

static gboolean read_split(const char *name, const char *text, gpointer data, GError **error) {
  Request *request = data;
  gboolean pieces = text && strcmp(text, "pieces") == 0;
  request->options.division = pieces ? SPORE_IMPORT_PIECES : SPORE_IMPORT_PARTS;
  if (!text || pieces || strcmp(text, "parts") == 0) return TRUE;
  g_set_error(error, G_OPTION_ERROR, G_OPTION_ERROR_BAD_VALUE, _("%s=%s: expected parts or pieces"), name, text);
  return FALSE;
}

/* The operations' options come from their table. */
static GOptionEntry *make_entries(Request *request) {
  const GOptionEntry first[] = {
      {"unit", 'u', 0, G_OPTION_ARG_STRING, &request->unit,
       N_("Unit of the meshes: m, cm, mm, um, in (default m); guess: of each file by itself, what makes it "
          "as large as an organ"),
       "UNIT|guess"},
      {"frame", 'f', 0, G_OPTION_ARG_STRING, &request->frame,
       N_("Axes of the meshes: Y_UP, RAS, LPS (default: what the file says)"), "FRAME"},
      {"output", 'o', 0, G_OPTION_ARG_FILENAME, &request->output, N_("Scene to write"), "F.spore"},
      {"add", 0, 0, G_OPTION_ARG_NONE, &request->add,
       N_("Add to the scene that is there, and keep what is in it: meshes of another unit, for instance"), NULL},
      {"merge", 0, 0, G_OPTION_ARG_NONE, &request->merge, N_("Make one body of all meshes"), NULL},
      {"split", 0, G_OPTION_FLAG_OPTIONAL_ARG, G_OPTION_ARG_CALLBACK, (gpointer)read_split,
       N_("Make a body of each part that a file names (parts), or of each connected piece (pieces); default: parts "
          "where "
          "there are several, else pieces"),
       "parts|pieces"}};
  GOptionEntry *entries = g_new0(GOptionEntry, G_N_ELEMENTS(first) + SPORE_MESH_OPERATIONS + 1);
  memcpy(entries, first, sizeof first);
  for (int kind = 0; kind < SPORE_MESH_OPERATIONS; kind++) {
    const SporeMeshOperation *operation = &spore_mesh_operations[kind];
    GOptionFlags flags = !operation->argument           ? G_OPTION_FLAG_NO_ARG
                         : operation->argument_optional ? G_OPTION_FLAG_OPTIONAL_ARG
                                                        : G_OPTION_FLAG_NONE;
    entries[G_N_ELEMENTS(first) + (gsize)kind] =
        (GOptionEntry){operation->name,    0, flags, G_OPTION_ARG_CALLBACK, (gpointer)read_operation, operation->doc,
                       operation->argument};
  }
  return entries;
}

static int understand(Request *request) {
  GError *error = NULL;
  SporeImportOptions *options = &request->options;
  if (!request->output) return spore_cli_usage(_("spore import: no scene named; expected -o F.spore"));
  if (request->merge && options->division != SPORE_IMPORT_FILES)
    return spore_cli_usage(_("spore import: --merge and --split are both there; expected one of them; leave one out"));
  if (request->merge) options->division = SPORE_IMPORT_MERGED;
  gboolean guess = g_strcmp0(request->unit, "guess") == 0;
  options->unit =
      guess ? -1 : spore_cli_choice("--unit", request->unit ? request->unit : "m", spore_length_units, &error);
  options->frame = request->frame ? spore_cli_choice("--frame", request->frame, spore_mesh_frames, &error) : -1;
  return error ? spore_cli_fail(error) : SPORE_EXIT_DONE;
}

int spore_command_import(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"bodies", N_("names of the bodies of the scene")},
      {"meshes",
       N_("of each body that was made: body, file, unit, frame, diagonal_m (across, as read), "
          "group (the nodes of the file that it lies in), colour (that the file gives it, sRGB; else empty)")},
      {"meshes.as_read",
       N_("triangles, components, boundary_edges, nonmanifold_edges, degenerate_triangles, volume_m3, area_m2")},
      {"meshes.operations", N_("in the order done: name, argument, moved_m (largest distance, sampled)")},
      {"meshes.operations.before",
       N_("triangles, components, boundary_edges, nonmanifold_edges, degenerate_triangles, volume_m3, area_m2")},
      {"meshes.operations.after",
       N_("triangles, components, boundary_edges, nonmanifold_edges, degenerate_triangles, volume_m3, area_m2")},
      {"diagnostics", N_("what there is to mend in it: place, message, remedy")},
      {NULL, NULL}};
  static const SporeCommandInfo info = {
      .name = "import",
      .arguments = "MESH|LABELS...",
      .summary = N_("Makes a new scene from organ meshes, each a body, or label maps (NIfTI, NRRD), each label a "
                    "body. Operations on the meshes are done in the order "
                    "in which they are listed below, whatever the order of the options."),
      .minimum = 1,
      .maximum = 10000,
      .report = members};
  Request request = {0};
  g_autofree GOptionEntry *entries = make_entries(&request);
  int status = spore_cli_parse_with(cli, &info, entries, &request, &argc, &argv);
  if (status == SPORE_EXIT_DONE) status = understand(&request);
  if (status == SPORE_EXIT_DONE) status = import(cli, argv + 1, &request.options, request.output, request.add);
  g_free(request.unit);
  g_free(request.frame);
  g_free(request.output);
  return status;
}
