/* Generators that work for a body of a scene: opening the body, running the generator, and saving its result. */
#include "app/cli/generate.h"

#include <glib/gi18n.h>
#include <string.h>

#include "app/cli/scene.h"
#include "core/io/mesh_import.h"
#include "core/io/scene_xml.h"
#include "core/scene/generated.h"

/* The body. */

gboolean spore_cli_is_scene(const char *file) { return g_str_has_suffix(file, ".spore"); }

/* The body of that name; without a name, the only body that shows a mesh. */
static SporeObject *choose_body(SporeDocument *document, const char *file, const char *name, GError **error) {
  if (name) return spore_cli_find_body(document, file, name, error);
  SporeObject *bodies = spore_document_section(document, "bodies"), *only = NULL;
  g_autoptr(GString) names = g_string_new(NULL);
  guint count = 0;
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    if (!spore_object_child_of(body, "visual")) continue;
    g_string_append_printf(names, names->len ? ", %s" : "%s", spore_object_name(body));
    only = body;
    count++;
  }
  if (count == 1) return only;
  spore_error_raise(error, SPORE_ERROR_INPUT, file, _("no body is named; expected --body with one of: %s"),
                    count ? names->str : _("none: import a mesh first"));
  return NULL;
}

static gboolean add_regions(SporeSceneBody *scene, const GArray *regions, GError **error) {
  if (scene->region_count + regions->len > SPORE_GENERATE_REGIONS)
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--region",
                             _("with those of the scene these are more than %d balls; give fewer"),
                             SPORE_GENERATE_REGIONS);
  gsize own = scene->region_count ? scene->regions[scene->region_count - 1].region + 1 : 0;
  for (guint i = 0; i < regions->len; i++) {
    scene->regions[scene->region_count] = g_array_index(regions, SporeGenerateRegion, i);
    scene->regions[scene->region_count++].region = own + i;
  }
  return TRUE;
}

gboolean spore_cli_open_body(SporeCli *cli, const char *file, const char *name, const SporeCliOptions *options,
                             SporeSceneBody *scene, void *fields, GError **error) {
  if (!spore_file_may_be_written(file, TRUE, error)) return FALSE;
  scene->document = spore_scene_load(cli->schema, file, error);
  scene->body = scene->document ? choose_body(scene->document, file, name, error) : NULL;
  if (!scene->body) return FALSE;
  scene->target = options->type->target(scene->document, scene->body);
  if (scene->target && !spore_generated_may_change(scene->target, error)) return FALSE;
  scene->source = spore_edit_generator_source(scene->document, scene->body, scene->target, error);
  scene->mesh = scene->source ? spore_document_mesh(scene->document, scene->source, error) : NULL;
  if (!scene->mesh) return FALSE;
  scene->source_hash = spore_document_asset_hash(scene->document, scene->source);
  if (scene->target) spore_object_fields(scene->target, fields);
  else spore_parameters_set_initial(&options->table, fields);
  spore_cli_options_fill(options, fields);
  if (!spore_edit_generator_regions(scene->target, scene->regions, &scene->region_count, error)) return FALSE;
  scene->own_count = scene->region_count;
  return add_regions(scene, options->regions, error);
}

SporeGeneratedFrom spore_cli_generated_from(const SporeSceneBody *scene, const void *fields) {
  return (SporeGeneratedFrom){spore_object_name(scene->source), scene->source_hash, fields,
                              scene->regions + scene->own_count, scene->region_count - scene->own_count};
}

gboolean spore_cli_save_body(SporeCli *cli, SporeSceneBody *scene, const char *file, GError **error) {
  if (!spore_scene_save(scene->document, file, error)) return FALSE;
  spore_cli_text(cli, "scene", file);
  spore_cli_text(cli, "body", spore_object_name(scene->body));
  spore_cli_say(cli, _("%s: written; the body \"%s\" has what was made\n"), file, spore_object_name(scene->body));
  return TRUE;
}

void spore_cli_close_body(SporeSceneBody *scene) {
  g_clear_pointer(&scene->document, spore_document_free);
  g_clear_pointer(&scene->source_hash, g_free);
}

/* Meshes as files. */

typedef char *(*Formatter)(const SporeTriangleMesh *mesh, gsize *size);
/* NULL: the file's name ends in nothing known. */
static Formatter formatter_of(const char *file) {
  if (g_str_has_suffix(file, ".off")) return spore_off_format;
  return g_str_has_suffix(file, ".obj") ? spore_obj_format : NULL;
}

gboolean spore_cli_knows_mesh(const char *file) {
  if (formatter_of(file)) return TRUE;
  spore_cli_usage(_("-o %s: the format is not known; expected a name ending in .off or .obj"), file);
  return FALSE;
}

gboolean spore_cli_write_mesh(const char *file, const SporeTriangleMesh *mesh, GError **error) {
  gsize size = 0;
  g_autofree char *text = formatter_of(file)(mesh, &size);
  return spore_write_file(file, text, size, error);
}

/* The generator. */

static SporeGenerateKind kind_of(const SporeGeneratorType *type) {
  SporeGenerateKind kind = 0;
  while (spore_generators[kind] != type) kind++;
  return kind;
}

/* The regions of the command line come after those of the asset. */
static SporeGenerateWork *new_work(const SporeSceneBody *scene, const SporeGenerateOptions *options, GError **error) {
  SporeGenerateWork *work = spore_generate_work_new(scene->document, scene->body, options, error);
  if (!work) return NULL;
  memcpy(work->regions, scene->regions, scene->region_count * sizeof *scene->regions);
  work->region_count = scene->region_count;
  return work;
}

static gboolean generate(SporeCli *cli, const SporeCliOptions *asked, const char *file, const char *body,
                         SporeCliReport *report, SporeSceneBody *scene, GError **error) {
  SporeGenerateOptions options = {.kind = kind_of(asked->type), .purpose = MAX(asked->purpose, 0)};
  if (!spore_cli_open_body(cli, file, body, asked, scene, &options.fields, error)) return FALSE;
  SporeGenerateWork *work = new_work(scene, &options, error);
  gboolean done = work && asked->type->run(work, spore_cli_progress(cli), error) &&
                  spore_generate_work_apply(work, scene->document, error);
  if (done) report(cli, work);
  if (work) spore_generate_work_unref(work);
  return done && spore_cli_save_body(cli, scene, file, error);
}

gboolean spore_cli_generate(SporeCli *cli, const SporeCliOptions *options, const char *file, const char *body,
                            SporeCliReport *report, GError **error) {
  SporeSceneBody scene = {0};
  gboolean done = generate(cli, options, file, body, report, &scene, error);
  spore_cli_close_body(&scene);
  return done;
}

static void report_facts(SporeCli *cli, const SporeGenerateWork *work) {
  g_autofree char *facts = spore_generators[work->options.kind]->facts(work);
  spore_cli_text(cli, "facts", facts);
  spore_cli_say(cli, "%s\n", facts);
}

int spore_command_generate(SporeCli *cli, const SporeGeneratorType *type, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"facts", N_("what was made, in words")},
      {"scene", N_("that was given: as written, and the name of the body that has the result: body")},
      {NULL, NULL}};
  const SporeCommandInfo info = {type->command, "SCENE", type->working, 1, 1, members};
  char *body = NULL;
  GError *error = NULL;
  const GOptionEntry entries[] = {SPORE_SCENE_BODY_ENTRY(&body), G_OPTION_ENTRY_NULL};
  g_auto(SporeCliOptions) options = {0};
  int status = spore_cli_options_parse(&options, cli, type, "", &info, entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE)
    status = spore_cli_generate(cli, &options, argv[1], body, report_facts, &error)
                 ? spore_cli_finish(cli, SPORE_EXIT_DONE)
                 : spore_cli_fail(error);
  g_free(body);
  return status;
}
