/* Meshes that SPORE reads itself (OFF): read and valid, or refused. What would go to a helper stops there: there is
 * none here. */
#include <glib.h>
#include <string.h>

#include "core/io/mesh_import.h"
#include "fuzz.h"

const unsigned fuzz_rounds = 50000;
const char *const fuzz_words[] = {"OFF\n", "4 4 0\n", "3 0 1 2\n",      "4 0 1 2 3\n", "4294967296", "-1", "nan",
                                  "inf",   "1e999",   "20000001 1 0\n", "# ",          "COFF\n",     "\n", NULL};

int LLVMFuzzerTestOneInput(const uint8_t *content, size_t size) {
  SporeTriangleMesh mesh = {0};
  GError *error = NULL;
  g_setenv("SPORE_HELPERS", "/nonexistent", TRUE);
  if (size < 3 || memcmp(content, "OFF", 3) != 0) return 0;
  if (!spore_mesh_decode("fuzz.off", "fuzz.off", content, size, 0, 1, &mesh, NULL, &error)) {
    g_assert_true(g_str_has_prefix(error->message, "fuzz.off"));
    g_clear_error(&error);
    g_assert_null(mesh.vertices);
    return 0;
  }
  g_assert_true(spore_triangle_mesh_validate(&mesh, NULL));
  spore_triangle_mesh_clear(&mesh);
  return 0;
}
