/* spore import: a new scene from organ meshes. */
#include <errno.h>
#include <glib/gi18n.h>

#include "app/cli/cli.h"
#include "core/io/organ.h"
#include "core/io/scene_xml.h"
#include "core/scene/check.h"

static gboolean add_organ(SporeCli *cli, SporeDocument *document, const char *file, const char *unit, const char *frame,
                          GError **error) {
  SporeTriangleMesh mesh = {0};
  g_autoptr(GBytes) content = NULL;
  int unit_index = 0, frame_index = 0;
  if (!spore_cli_read_mesh(cli, file, unit, frame, &mesh, &content, &unit_index, &frame_index, error)) return FALSE;
  spore_triangle_mesh_clear(&mesh);
  return spore_organ_insert(document, file, content, unit_index, frame_index, error) != NULL;
}

static void report(SporeCli *cli, SporeDocument *document) {
  SporeObject *bodies = spore_document_section(document, "bodies");
  spore_cli_open_array(cli, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++)
    spore_cli_text(cli, NULL, spore_object_name(spore_object_child(bodies, i)));
  spore_cli_close_array(cli);
  g_autoptr(GPtrArray) diagnostics = spore_document_check(document);
  spore_cli_open_array(cli, "diagnostics");
  for (guint i = 0; i < diagnostics->len; i++) {
    const SporeDiagnostic *diagnostic = g_ptr_array_index(diagnostics, i);
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "place", diagnostic->place);
    spore_cli_text(cli, "message", diagnostic->message);
    spore_cli_text(cli, "remedy", diagnostic->remedy);
    spore_cli_close(cli);
    spore_cli_say(cli, "%s: %s; %s\n", diagnostic->place, diagnostic->message, diagnostic->remedy);
  }
  spore_cli_close_array(cli);
}

static gboolean make_folder_of(const char *file, GError **error) {
  g_autofree char *folder = g_path_get_dirname(file);
  if (g_mkdir_with_parents(folder, 0777) == 0) return TRUE;
  return spore_error_raise(error, SPORE_ERROR_FILE, folder, _("the folder cannot be made (%s); name another place"),
                           g_strerror(errno));
}

static int import(SporeCli *cli, char **meshes, const char *unit, const char *frame, const char *output) {
  GError *error = NULL;
  SporeDocument *document = spore_document_new(cli->schema);
  spore_document_set_readers(document, &spore_io_readers);
  gboolean done = TRUE;
  for (char **mesh = meshes; *mesh && done; mesh++)
    done = spore_cli_keeps(output, *mesh, &error) && add_organ(cli, document, *mesh, unit, frame, &error);
  done = done && make_folder_of(output, &error) && spore_scene_save(document, output, &error);
  if (done) {
    spore_cli_say(cli, _("%s: written\n"), output);
    report(cli, document);
  }
  spore_document_free(document);
  return done ? spore_cli_finish(cli, SPORE_EXIT_DONE) : spore_cli_fail(error);
}

int spore_command_import(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"bodies", N_("names of the bodies of the scene")},
      {"diagnostics", N_("what there is to mend in it: place, message, remedy")},
      {NULL, NULL}};
  static const SporeCommandInfo info = {"import", "MESH...", N_("Makes a new scene from organ meshes, each a body."),
                                        1,        10000,     members};
  char *unit = NULL, *frame = NULL, *output = NULL;
  const GOptionEntry entries[] = {
      {"unit", 'u', 0, G_OPTION_ARG_STRING, &unit, N_("Unit of the meshes: m, cm, mm, um, in (default m)"), "UNIT"},
      {"frame", 'f', 0, G_OPTION_ARG_STRING, &frame,
       N_("Axes of the meshes: Y_UP, RAS, LPS (default: what the file says)"), "FRAME"},
      {"output", 'o', 0, G_OPTION_ARG_FILENAME, &output, N_("Scene to write"), "F.spore"},
      G_OPTION_ENTRY_NULL};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE) {
    if (!output) status = spore_cli_usage(_("spore import: no scene named; expected -o F.spore"));
    else status = import(cli, argv + 1, unit, frame, output);
  }
  g_free(unit);
  g_free(frame);
  g_free(output);
  return status;
}
