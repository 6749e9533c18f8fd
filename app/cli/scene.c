#include "app/cli/scene.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/author/edits.h"
#include "core/base/memory.h"
#include "core/io/scene_xml.h"
#include "core/scene/check.h"

void spore_scene_options_clear(SporeSceneOptions *options) {
  g_strfreev(options->set);
  g_free(options->integrator);
  g_free(options->dt);
  g_free(options->input);
  *options = (SporeSceneOptions){0};
}

gboolean spore_cli_set(SporeDocument *document, const char *setting, GError **error) {
  const char *equals = strchr(setting, '=');
  g_autofree char *path = equals ? g_strndup(setting, (gsize)(equals - setting)) : NULL;
  char *slash = path ? strrchr(path, '/') : NULL;
  if (!slash)
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--set",
                             _("'%s' names no property; expected PATH/PROPERTY=VALUE, such as solver/time_step=0.001"),
                             setting);
  *slash = '\0';
  SporeObject *object = spore_edit_object_or_unit(document, path, NULL);
  if (!object)
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--set",
                             _("the scene has no object '%s'; expected a path such as bodies/NAME/collision"), path);
  return spore_document_set_text(document, object, slash + 1, equals + 1, error);
}

SporeDocument *spore_cli_new_scene(SporeCli *cli, const char *file) {
  SporeDocument *document = spore_document_new(cli->schema);
  spore_document_set_readers(document, &spore_io_readers);
  if (g_file_test(file, G_FILE_TEST_EXISTS))
    spore_cli_say(cli, _("%s: a new scene takes the place of the one that was there\n"), file);
  return document;
}

SporeObject *spore_cli_find_body(SporeDocument *document, const char *place, const char *name, GError **error) {
  SporeObject *bodies = spore_document_section(document, "bodies");
  g_autoptr(GString) names = g_string_new(NULL);
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    if (g_str_equal(spore_object_name(body), name)) return body;
    g_string_append_printf(names, names->len ? ", %s" : "%s", spore_object_name(body));
  }
  spore_error_raise(error, SPORE_ERROR_INPUT, place, _("there is no body \"%s\"; expected one of: %s"), name,
                    names->len ? names->str : _("none: import a mesh first"));
  return NULL;
}

static gboolean apply(SporeDocument *document, const SporeSceneOptions *options, GError **error) {
  SporeObject *solver = spore_document_section(document, "solver");
  if (options->dt && !spore_document_set_text(document, solver, "time_step", options->dt, error)) return FALSE;
  if (options->integrator && !spore_document_set_text(document, solver, "integrator", options->integrator, error))
    return FALSE;
  for (char **setting = options->set; setting && *setting; setting++)
    if (!spore_cli_set(document, *setting, error)) return FALSE;
  return TRUE;
}

void spore_cli_diagnostic(SporeCli *cli, const char *place, const char *message, const char *remedy) {
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "place", place);
  spore_cli_text(cli, "message", message);
  spore_cli_text(cli, "remedy", remedy);
  spore_cli_close(cli);
  spore_cli_say(cli, "%s: %s; %s\n", place, message, remedy);
}

void spore_cli_diagnostics(SporeCli *cli, SporeDocument *document) {
  g_autoptr(GPtrArray) diagnostics = spore_document_check(document);
  for (guint i = 0; i < diagnostics->len; i++) {
    const SporeDiagnostic *diagnostic = g_ptr_array_index(diagnostics, i);
    spore_cli_diagnostic(cli, diagnostic->place, diagnostic->message, diagnostic->remedy);
  }
}

SporeDocument *spore_cli_load(SporeCli *cli, const char *file, const SporeSceneOptions *options, GError **error) {
  SporeDocument *document = spore_scene_load(cli->schema, file, error);
  if (document && !apply(document, options, error)) g_clear_pointer(&document, spore_document_free);
  return document;
}

static gboolean read_track(const char *file, SporeTrack *track, GError **error) {
  g_autoptr(GBytes) content = spore_cli_read_file(file, _("a track"), error);
  if (!content) return FALSE;
  gsize size = 0;
  const char *text = g_bytes_get_data(content, &size);
  SporeError fault = SPORE_ERROR_INIT;
  return spore_track_parse(track, file, text, size, &fault) || spore_error_propagate(&fault, error);
}

SporeRun *spore_run_open(SporeCli *cli, const char *file, const SporeSceneOptions *options, int threads,
                         GError **error) {
  g_autoptr(SporeRun) run = g_new0(SporeRun, 1);
  run->document = spore_cli_load(cli, file, options, error);
  if (!run->document) return NULL;
  if (options->input && !read_track(options->input, &run->input, error)) return NULL;
  run->pool = spore_pool_create(threads);
  if (!run->pool) {
    spore_error_raise(error, SPORE_ERROR_MEMORY, "--threads", _("%d threads are not to be had; ask for fewer"),
                      threads);
    return NULL;
  }
  run->simulation = spore_simulation_new(run->document, run->pool, options->input ? &run->input : NULL, error);
  return run->simulation ? g_steal_pointer(&run) : NULL;
}

void spore_run_free(SporeRun *run) {
  g_clear_pointer(&run->simulation, spore_simulation_free);
  spore_pool_free(run->pool);
  spore_track_clear(&run->input);
  g_clear_pointer(&run->document, spore_document_free);
  g_free(run);
}

int spore_cli_body_width(const SporeWorld *world) {
  int width = 15;
  for (guint32 body = 0; body < spore_world_body_count(world); body++)
    width = MAX(width, (int)strlen(spore_world_body_name(world, body)));
  return width;
}
