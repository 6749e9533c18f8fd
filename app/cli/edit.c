/* spore edit: changes a scene from the command line. */
#include <glib/gi18n.h>
#include <string.h>

#include "app/cli/scene.h"
#include "core/author/addition.h"
#include "core/author/edits.h"
#include "core/io/scene_xml.h"
#include "core/scene/check.h"

/* The options of the command line. */
typedef struct Request {
  char **add, **set, **hold, *output;
  gboolean probe;
} Request;

static SporeObject *hold(SporeDocument *document, const char *name, GError **error) {
  SporeObject *body = spore_cli_find_body(document, "--hold", name, error);
  return body ? spore_edit_add_pin(document, body, error) : NULL;
}

static gboolean set(SporeDocument *document, const char *setting, GPtrArray *changed, GError **error) {
  if (!spore_cli_set(document, setting, error)) return FALSE;
  g_ptr_array_add(changed, g_strndup(setting, strcspn(setting, "=")));
  return TRUE;
}

/* Notes the path of what was changed, for the report. */
static void note(GPtrArray *changed, const SporeObject *object) { g_ptr_array_add(changed, spore_object_path(object)); }

static gboolean apply(SporeDocument *document, const Request *request, GPtrArray *changed, GError **error) {
  for (char **path = request->add; path && *path; path++) {
    SporeObject *added = spore_edit_add(document, *path, error);
    if (!added) return FALSE;
    note(changed, added);
  }
  for (char **setting = request->set; setting && *setting; setting++)
    if (!set(document, *setting, changed, error)) return FALSE;
  for (char **name = request->hold; name && *name; name++) {
    SporeObject *pin = hold(document, *name, error);
    if (!pin) return FALSE;
    note(changed, pin);
  }
  SporeObject *probe = request->probe ? spore_edit_add_probe(document, error) : NULL;
  if (probe) note(changed, probe);
  return probe || !request->probe;
}

static void report_changed(SporeCli *cli, const GPtrArray *changed) {
  spore_cli_open_array(cli, "changed");
  for (guint i = 0; i < changed->len; i++) {
    json_builder_add_string_value(cli->report, changed->pdata[i]);
    spore_cli_say(cli, _("changed: %s\n"), (const char *)changed->pdata[i]);
  }
  spore_cli_close_array(cli);
}

static gboolean edit(SporeCli *cli, const char *file, const Request *request, GError **error) {
  const char *output = request->output ? request->output : file;
  if (!spore_file_may_be_written(output, TRUE, error)) return FALSE;
  SporeDocument *document = spore_scene_load(cli->schema, file, error);
  g_autoptr(GPtrArray) changed = g_ptr_array_new_with_free_func(g_free);
  gboolean done = document && apply(document, request, changed, error) && spore_cli_save_scene(document, output, error);
  if (done) {
    spore_cli_text(cli, "scene", output);
    spore_cli_say(cli, _("%s: written\n"), output);
    report_changed(cli, changed);
    spore_cli_open_array(cli, "diagnostics");
    spore_cli_diagnostics(cli, document);
    spore_cli_close_array(cli);
  }
  if (document) spore_document_free(document);
  return done;
}

int spore_command_edit(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"scene", N_("file that was written")},
      {"changed", N_("paths of what was added and set")},
      {"diagnostics", N_("what there is to mend in it: place, message, remedy")},
      {NULL, NULL}};
  static const SporeCommandInfo info = {
      "edit", "SCENE", N_("Changes a scene and saves it; then says what there is to mend in it."), 1, 1, members};
  Request request = {0};
  const GOptionEntry entries[] = {
      {"add", 'a', 0, G_OPTION_ARG_STRING_ARRAY, &request.add,
       N_("Add an object, before anything is set: links/spring:cord, bodies/liver/mechanical/spline_1d (may be "
          "repeated)"),
       "PATH"},
      {"set", 's', 0, G_OPTION_ARG_STRING_ARRAY, &request.set,
       N_("Set a property, and keep it: bodies/liver/mechanical/material=liver (may be repeated)"), "PATH=VALUE"},
      {"hold", 0, 0, G_OPTION_ARG_STRING_ARRAY, &request.hold,
       N_("Pin a body where it lies lowest and farthest behind, so that it does not fall (may be repeated)"), "BODY"},
      {"probe", 0, 0, G_OPTION_ARG_NONE, &request.probe, N_("Add a probe that the mouse moves, above the organs"),
       NULL},
      {"output", 'o', 0, G_OPTION_ARG_FILENAME, &request.output, N_("Scene to write (default: the same)"), "F.spore"},
      G_OPTION_ENTRY_NULL};
  GError *error = NULL;
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE && !request.add && !request.set && !request.hold && !request.probe)
    status = spore_cli_usage(
        _("spore edit: nothing is asked for; expected --add, --set, --hold or --probe; give one of them"));
  if (status == SPORE_EXIT_DONE)
    status = edit(cli, argv[1], &request, &error) ? spore_cli_finish(cli, SPORE_EXIT_DONE) : spore_cli_fail(error);
  g_strfreev(request.add);
  g_strfreev(request.set);
  g_strfreev(request.hold);
  g_free(request.output);
  return status;
}
