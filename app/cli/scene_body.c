#include "app/cli/scene_body.h"

#include <glib/gi18n.h>

#include "app/cli/scene.h"
#include "core/author/generated_edits.h"
#include "core/io/scene_xml.h"
#include "core/scene/generated.h"

gboolean spore_cli_is_scene(const char *file) { return g_str_has_suffix(file, ".spore"); }

/* The body of that name; the only one that shows a mesh where none is named. */
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
                             _("with those of the scene these are more than %d regions; give fewer"),
                             SPORE_GENERATE_REGIONS);
  for (guint i = 0; i < regions->len; i++)
    scene->regions[scene->region_count++] = g_array_index(regions, SporeGenerateRegion, i);
  return TRUE;
}

gboolean spore_cli_open_body(SporeCli *cli, const char *file, const char *name, const SporeCliOptions *options,
                             SporeSceneBody *scene, void *fields, GError **error) {
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
