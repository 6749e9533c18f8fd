/* Tetrahedra in Medit's format: read and valid, or refused. */
#include <glib.h>
#include <string.h>

#include "core/io/mesh_import.h"
#include "fuzz.h"

const unsigned fuzz_rounds = 50000;
const char *const fuzz_words[] = {"MeshVersionFormatted 2\n",
                                  "Dimension 3\n",
                                  "Vertices ",
                                  "Tetrahedra ",
                                  "Triangles ",
                                  "End",
                                  "\n",
                                  "4000000000",
                                  "-1",
                                  "0",
                                  "nan",
                                  "1e999",
                                  "99999999999999999999",
                                  "# ",
                                  NULL};

int LLVMFuzzerTestOneInput(const uint8_t *content, size_t size) {
  SporeTetrahedralMesh mesh = {0};
  GError *error = NULL;
  if (!spore_medit_parse("fuzz.mesh", (const char *)content, size, &mesh, &error)) {
    g_assert_true(g_str_has_prefix(error->message, "fuzz.mesh"));
    g_clear_error(&error);
    g_assert_null(mesh.vertices);
    return 0;
  }
  g_assert_true(spore_tetrahedral_mesh_validate(&mesh, NULL));
  spore_tetrahedral_mesh_clear(&mesh);
  return 0;
}
