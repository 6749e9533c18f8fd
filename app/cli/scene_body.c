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

static void take_fields(SporeSceneBody *scene, const char *element, void *fields) {
  const SporeObject *assets = spore_document_section(scene->document, "assets");
  if (scene->target) spore_object_fields(scene->target, fields);
  else spore_parameters_set_initial(spore_object_type_child(spore_object_type(assets), element)->table, fields);
}

gboolean spore_cli_open_body(SporeCli *cli, const char *file, const char *name, const char *element,
                             SporeObject *(*find)(SporeDocument *document, SporeObject *body), SporeSceneBody *scene,
                             void *fields, GError **error) {
  scene->document = spore_scene_load(cli->schema, file, error);
  scene->body = scene->document ? choose_body(scene->document, file, name, error) : NULL;
  if (!scene->body) return FALSE;
  scene->target = find(scene->document, scene->body);
  if (scene->target && !spore_generated_may_change(scene->target, error)) return FALSE;
  scene->source = spore_edit_generator_source(scene->document, scene->body, scene->target, error);
  scene->mesh = scene->source ? spore_document_mesh(scene->document, scene->source, error) : NULL;
  if (!scene->mesh) return FALSE;
  scene->source_hash = spore_document_asset_hash(scene->document, scene->source);
  take_fields(scene, element, fields);
  if (!spore_edit_generator_regions(scene->target, scene->regions, &scene->region_count, error)) return FALSE;
  scene->own_count = scene->region_count;
  return TRUE;
}

gboolean spore_cli_add_region(SporeSceneBody *scene, const double centre[3], double radius, double value,
                              GError **error) {
  if (scene->region_count == SPORE_GENERATE_REGIONS)
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--region",
                             _("with those of the scene these are more than %d regions; give fewer"),
                             SPORE_GENERATE_REGIONS);
  scene->regions[scene->region_count++] = (SporeGenerateRegion){{centre[0], centre[1], centre[2]}, radius, value};
  return TRUE;
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
