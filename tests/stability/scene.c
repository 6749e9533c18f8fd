/* Shipped scenes for the stability suite. */
#include "tests/stability/scene.h"

#include "core/author/edits.h"
#include "core/author/generator.h"
#include "core/io/scene_xml.h"
#include "models/registry.h"

Scene scene_open(const char *file, const char *path, const char *property, const char *value) {
  GError *error = NULL;
  Scene scene = {.schema = spore_schema_new(spore_model_registry, spore_generator_elements())};
  scene.document = spore_scene_load(scene.schema, file, &error);
  g_assert_no_error(error);
  if (path) spore_edit_set_property(scene.document, path, property, value, &error);
  g_assert_no_error(error);
  scene.simulation = spore_simulation_new(scene.document, NULL, NULL, NULL, &error);
  g_assert_no_error(error);
  scene.world = scene.simulation->world;
  return scene;
}

void scene_close(Scene *scene) {
  spore_simulation_free(scene->simulation);
  spore_document_free(scene->document);
  spore_schema_free(scene->schema);
}
