/* Opening a scene from the command line, with the options that change it, and running it. */
#include "app/cli/scene.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/author/addition.h"
#include "core/author/edits.h"
#include "core/base/memory.h"
#include "core/io/scene_xml.h"
#include "core/scene/check.h"

#define ROUNDING 1e-9   /* of a time as a number of steps */
#define MOST_STEPS 9e15 /* up to here a double counts one by one */

void spore_scene_options_clear(SporeSceneOptions *options) {
  g_strfreev(options->set);
  g_free(options->integrator);
  g_free(options->dt);
  g_free(options->input);
  *options = (SporeSceneOptions){0};
}

/* The elements below `type` that hold such a child, each once. */
static void find_holders(const SporeObjectType *type, const char *element, GPtrArray *holders) {
  for (guint i = 0; i < type->children->len; i++) {
    const SporeObjectType *child = type->children->pdata[i];
    if (spore_object_type_child(child, element) && !g_ptr_array_find(holders, child->element, NULL))
      g_ptr_array_add(holders, (gpointer)child->element);
    find_holders(child, element, holders);
  }
}

/* What is wrong with a path that names no object, and that nothing can be added for. */
static gboolean refuse_path(SporeDocument *document, const char *path, GError **error) {
  const char *slash = strrchr(path, '/');
  g_autofree char *place = slash ? g_strndup(path, (gsize)(slash - path)) : NULL;
  g_autoptr(GPtrArray) holders = g_ptr_array_new();
  if (place && spore_document_by_path(document, place))
    find_holders(spore_object_type(spore_document_root(document)), slash + 1, holders);
  if (holders->len == 0)
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--set",
                             _("the scene has no object '%s'; expected a path such as bodies/NAME/collision"), path);
  g_ptr_array_add(holders, NULL);
  g_autofree char *names = g_strjoinv(", ", (char **)holders->pdata);
  return spore_error_raise(error, SPORE_ERROR_INPUT, "--set", _("'%s' cannot hold '%s'; what can is: %s; set it there"),
                           place, slash + 1, names);
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
  if (!object) {
    g_autofree char *addition = spore_edit_addition_for(document, path);
    if (addition)
      return spore_error_raise(error, SPORE_ERROR_INPUT, "--set",
                               _("the scene has no object '%s'; correct the name, or add it: spore edit --add '%s'"),
                               path, addition);
    return refuse_path(document, path, error);
  }
  return spore_document_set_text(document, object, slash + 1, equals + 1, error);
}

SporeDocument *spore_cli_new_scene(SporeCli *cli, const char *file) {
  SporeDocument *document = spore_document_new(cli->schema);
  spore_document_set_readers(document, &spore_io_readers);
  if (file && g_file_test(file, G_FILE_TEST_EXISTS))
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
  g_autoptr(GPtrArray) diagnostics = spore_document_check(document, spore_cli_cancel());
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

gboolean spore_cli_read_track(const char *file, SporeTrack *track, GError **error) {
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
  if (options->input && !spore_cli_read_track(options->input, &run->input, error)) return NULL;
  run->pool = spore_pool_create(threads);
  if (!run->pool) {
    spore_error_raise(error, SPORE_ERROR_MEMORY, "--threads", _("%d threads are not to be had; ask for fewer"),
                      threads);
    return NULL;
  }
  run->simulation =
      spore_simulation_new(run->document, run->pool, options->input ? &run->input : NULL, spore_cli_cancel(), error);
  return run->simulation ? g_steal_pointer(&run) : NULL;
}

void spore_run_free(SporeRun *run) {
  g_clear_pointer(&run->simulation, spore_simulation_free);
  spore_pool_free(run->pool);
  spore_track_clear(&run->input);
  g_clear_pointer(&run->document, spore_document_free);
  g_free(run);
}

gboolean spore_cli_steps(const char *time, double dt_s, gint64 *steps, GError **error) {
  double time_s;
  if (!spore_cli_seconds("--time", time, &time_s, error)) return FALSE;
  double count = ceil(time_s / dt_s - ROUNDING);
  if (count > MOST_STEPS)
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--time",
                             _("%s s are %.3g steps of %g s; expected at most %g; ask for a shorter time"), time, count,
                             dt_s, MOST_STEPS);
  *steps = (gint64)fmax(count, 0);
  return TRUE;
}

gboolean spore_cli_stride(const char *every, double dt_s, guint64 *stride, GError **error) {
  double every_s;
  *stride = 1;
  if (!every) return TRUE;
  if (!spore_cli_seconds("--every", every, &every_s, error)) return FALSE;
  double steps = every_s / dt_s, whole = round(steps);
  if (whole >= 1 && whole < MOST_STEPS && fabs(steps - whole) <= ROUNDING * whole) {
    *stride = (guint64)whole;
    return TRUE;
  }
  if (steps < 1)
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--every",
                             _("%s s is less than a step; expected a multiple of the step; the nearest is %.10g s"),
                             every, dt_s);
  return spore_error_raise(error, SPORE_ERROR_INPUT, "--every",
                           _("%s s is no multiple of the step of %.10g s; the nearest are %.10g s and %.10g s"), every,
                           dt_s, floor(steps) * dt_s, ceil(steps) * dt_s);
}

int spore_cli_body_width(const SporeWorld *world) {
  int width = 15;
  for (guint32 body = 0; body < spore_world_body_count(world); body++)
    width = MAX(width, (int)strlen(spore_world_body_name(world, body)));
  return width;
}

/* Changes of level. */

static gboolean refuse_change(const char *setting, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_INPUT, "--level",
                           _("'%s' is no change of level; expected BODY=LEVEL or BODY=LEVEL@SECONDS, such as "
                             "thread=coarse@1.5"),
                           setting);
}

/* BODY=LEVEL@SECONDS; @SECONDS may be missing. */
static gboolean parse_change(const SporeWorld *world, const char *setting, SporeLevelChange *change, GError **error) {
  g_auto(GStrv) sides = g_strsplit(setting, "=", 2);
  if (g_strv_length(sides) != 2) return refuse_change(setting, error);
  g_auto(GStrv) words = g_strsplit(sides[1], "@", 2);
  char *end = NULL;
  if (words[0] && words[1]) change->time_s = g_ascii_strtod(words[1], &end);
  if (!words[0] || (end && (end == words[1] || *end)) || !(change->time_s >= 0)) return refuse_change(setting, error);
  change->body = spore_world_find_body(world, sides[0]);
  if (change->body == SPORE_NO_BODY)
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--level",
                             _("the scene has no body '%s'; expected the name of one that has levels"), sides[0]);
  for (int k = 0; k < SPORE_LOD_COUNT; k++) {
    if (strcmp(spore_lod_names[k], words[0]) != 0) continue;
    change->level = (SporeLodGrade)k;
    if (spore_world_lod_model(world, change->body, change->level)) return TRUE;
  }
  return spore_error_raise(error, SPORE_ERROR_INPUT, "--level",
                           _("the body '%s' has no level '%s'; expected fine, or one of the levels in its fidelity"),
                           sides[0], words[0]);
}

GArray *spore_level_changes_parse(const SporeWorld *world, char **settings, GError **error) {
  GArray *changes = g_array_new(FALSE, TRUE, sizeof(SporeLevelChange));
  for (char **setting = settings; setting && *setting; setting++) {
    SporeLevelChange change = {0};
    if (!parse_change(world, *setting, &change, error)) {
      g_array_unref(changes);
      return NULL;
    }
    g_array_append_val(changes, change);
  }
  return changes;
}

void spore_level_changes_post(GArray *changes, SporeWorld *world) {
  for (guint i = 0; i < changes->len; i++) {
    SporeLevelChange *change = &g_array_index(changes, SporeLevelChange, i);
    if (change->posted || change->time_s > spore_world_time_s(world)) continue;
    const SporeCommand command = {.kind = SPORE_COMMAND_LOD, .body = change->body, .level = change->level};
    change->posted = spore_world_post(world, &command);
  }
}
