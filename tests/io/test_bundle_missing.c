/* A build without libarchive: it refuses bundles in words, and opens scenes as ever. */
#include <glib.h>
#include <string.h>

#include "core/author/generator.h"
#include "core/io/bundle.h"
#include "core/io/scene_xml.h"
#include "models/registry.h"

static SporeSchema *schema;

static void assert_refused(GError *error, const char *place) {
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_UNSUPPORTED);
  g_assert_true(g_str_has_prefix(error->message, place));
  g_assert_nonnull(strstr(error->message, "libarchive"));
  g_error_free(error);
}

static void test_reading(void) {
  GError *error = NULL;
  g_assert_null(spore_scene_load(schema, "a.sporez", &error));
  assert_refused(error, "a.sporez: ");
  SporeDocument *document = spore_scene_load(schema, SPORE_SCENES "/minimal.spore", NULL);
  g_assert_nonnull(document);
  spore_document_free(document);
}

static void test_writing(void) {
  GError *error = NULL;
  SporeDocument *document = spore_document_new(schema);
  g_assert_null(spore_bundle_format(document, "b.sporez", NULL, &error));
  assert_refused(error, "b.sporez: ");
  spore_document_free(document);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  g_test_add_func("/bundle-missing/reading", test_reading);
  g_test_add_func("/bundle-missing/writing", test_writing);
  int status = g_test_run();
  spore_schema_free(schema);
  return status;
}
