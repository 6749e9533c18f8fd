/* Bundles: opened, or refused with a place; what is opened and written is opened again, and then stays. */
#include <glib.h>
#include <string.h>

#include "core/author/generator.h"
#include "core/io/bundle.h"
#include "fuzz.h"
#include "models/registry.h"

const unsigned fuzz_rounds = 6000;
const char *const fuzz_words[] = {"PK\x03\x04", "PK\x01\x02", "PK\x05\x06",  "PK\x06\x06", "PK\x07\x08",
                                  "../",        "/etc/",      "scene.spore", "m.off",      "\xFF\xFF\xFF\xFF",
                                  "\x01\x20",   "\x63\xA1",   "\\",          NULL};

static void assert_refused(GError *error) {
  g_assert_nonnull(error);
  if (!g_str_has_prefix(error->message, "fuzz.sporez")) g_error("%s", error->message);
  g_assert_null(strchr(error->message, '\n'));
  g_assert_true(g_utf8_validate(error->message, -1, NULL));
  g_error_free(error);
}

int LLVMFuzzerTestOneInput(const uint8_t *content, size_t size) {
  static SporeSchema *schema;
  if (!schema) schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  GError *error = NULL;
  SporeDocument *document = spore_bundle_parse(schema, "fuzz.sporez", content, size, NULL, &error);
  if (!document) {
    assert_refused(error);
    return 0;
  }
  g_autoptr(GByteArray) written = spore_bundle_format(document, "fuzz.sporez", NULL, &error);
  g_assert_no_error(error);
  SporeDocument *again = spore_bundle_parse(schema, "fuzz.sporez", written->data, written->len, NULL, &error);
  g_assert_no_error(error);
  g_autoptr(GByteArray) twice = spore_bundle_format(again, "fuzz.sporez", NULL, &error);
  g_assert_no_error(error);
  g_assert_cmpmem(written->data, written->len, twice->data, twice->len);
  spore_document_free(again);
  spore_document_free(document);
  return 0;
}
