/* The text of glTF files of strangers: read as one file and checked, or refused. No buffer's file is there. */
#include <glib.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/io/gltf_check.h"
#include "core/io/mesh_import.h"
#include "core/io/mesh_text.h"
#include "fuzz.h"

const unsigned fuzz_rounds = 4000;
const char *const fuzz_words[] = {"\"buffers\":[",
                                  "\"uri\":\"",
                                  "\"uri\":\"../a.bin\"",
                                  "\"byteLength\":99",
                                  "data:",
                                  "%2F",
                                  "\\u002f",
                                  "{",
                                  "}",
                                  "[",
                                  "]",
                                  "\"",
                                  "\xFE\xFF",
                                  "\xFF\xFE",
                                  ",",
                                  "-1",
                                  NULL};

static void check_text(const char *content, gsize size) {
  const char *text = content;
  char *held = NULL;
  g_autoptr(GError) error = NULL;
  g_assert_true(spore_mesh_text(&text, &size, &held));
  if (!spore_gltf_check("fuzz.gltf", text, size, &error)) g_assert_true(g_str_has_prefix(error->message, "fuzz.gltf"));
  spore_free(held);
}

int LLVMFuzzerTestOneInput(const uint8_t *content, size_t size) {
  g_autoptr(GError) error = NULL;
  g_autoptr(GBytes) given = g_bytes_new(content, size);
  g_autoptr(GBytes) whole = spore_mesh_whole("/nonexistent/fuzz.gltf", given, &error);
  if (!whole) g_assert_true(g_str_has_prefix(error->message, "/nonexistent/fuzz.gltf"));
  else g_assert_true(whole == given);
  check_text((const char *)content, size);
  return 0;
}
