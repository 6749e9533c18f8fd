/* Scene files: read, or refused with a place; what is read and written is read again, and then stays. */
#include <glib.h>
#include <string.h>

#include "core/author/generator.h"
#include "core/io/scene_xml.h"
#include "fuzz.h"
#include "models/registry.h"

const unsigned fuzz_rounds = 40000;
const char *const fuzz_words[] = {"<!--",
                                  "-->",
                                  "<body ",
                                  "name=\"a\"",
                                  "</bodies>",
                                  "/>",
                                  "<",
                                  ">",
                                  "\"",
                                  "'",
                                  "&amp;",
                                  "&#38;",
                                  "&#x0;",
                                  "&x;",
                                  "<!DOCTYPE a [",
                                  "<![CDATA[",
                                  "]]>",
                                  "<?xml ",
                                  "?>",
                                  "\xEF\xBB\xBF",
                                  "\xFF\xFE",
                                  "xmlns=\"u\"",
                                  "version=\"1.0\"",
                                  "1e999",
                                  "nan",
                                  "-0",
                                  "../",
                                  "<spore>",
                                  "</spore>",
                                  "\r\n",
                                  "<mechanical><rigid_body/></mechanical>",
                                  "file=\"a\"",
                                  NULL};

int LLVMFuzzerTestOneInput(const uint8_t *content, size_t size) {
  static SporeSchema *schema;
  if (!schema) schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  GError *error = NULL;
  SporeDocument *document = spore_scene_parse(schema, "fuzz.spore", (const char *)content, size, &error);
  if (!document) {
    g_assert_true(g_str_has_prefix(error->message, "fuzz.spore:"));
    g_assert_null(strchr(error->message, '\n'));
    g_assert_true(g_utf8_validate(error->message, -1, NULL));
    g_clear_error(&error);
    return 0;
  }
  g_assert_null(error);
  gsize length;
  g_autofree char *text = spore_scene_format(document, &length);
  SporeDocument *again = spore_scene_parse(schema, "fuzz.spore", text, length, &error);
  g_assert_no_error(error);
  g_autofree char *fixed = spore_scene_format(again, NULL);
  g_assert_cmpstr(fixed, ==, text);
  spore_document_free(again);
  spore_document_free(document);
  return 0;
}
