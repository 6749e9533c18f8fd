/* The text of glTF files of strangers: read as one file and checked, or refused. No file beside it is there. The same
 * text is read as materials of OBJ, too. */
#include <glib.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/io/gltf_check.h"
#include "core/io/mesh_import.h"
#include "core/io/mesh_text.h"
#include "fuzz.h"

const unsigned fuzz_rounds = 4000;
const char *const fuzz_words[] = {"\"buffers\":[",
                                  "\"images\":[",
                                  "\nnewmtl a\nmap_Kd ",
                                  " -s 1 1 -clamp on ",
                                  "\nKd 1 nan",
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

/* Each picture that is named is said not to be there. */
static void check_beside(GBytes *given) {
  g_autoptr(SporeMeshBeside) beside = spore_mesh_beside_read("/nonexistent/fuzz.gltf", given);
  gsize size;
  const char *text = g_bytes_get_data(given, &size);
  spore_mesh_beside_describe(beside, "/nonexistent/fuzz.gltf", "", text, size);
  for (guint i = 0; i < beside->pictures->len; i++) {
    const SporeMeshPicture *picture = beside->pictures->pdata[i];
    g_assert_true(!picture->content && strstr(picture->reason, "; "));
  }
  for (guint i = 0; i < beside->materials->len; i++) {
    const SporeMeshMaterial *material = beside->materials->pdata[i];
    g_assert_cmpuint(material->picture, <=, beside->pictures->len);
    for (int k = 0; k < 3; k++) g_assert_true(material->colour[k] >= 0 && material->colour[k] <= 1);
    g_assert_true(material->opacity >= 0 && material->opacity <= 1);
  }
}

int LLVMFuzzerTestOneInput(const uint8_t *content, size_t size) {
  g_autoptr(GError) error = NULL;
  g_autoptr(GBytes) given = g_bytes_new(content, size);
  g_autoptr(GBytes) whole = spore_mesh_whole("/nonexistent/fuzz.gltf", given, &error);
  if (!whole) g_assert_true(g_str_has_prefix(error->message, "/nonexistent/fuzz.gltf"));
  else g_assert_true(whole == given);
  check_beside(given);
  check_text((const char *)content, size);
  return 0;
}
