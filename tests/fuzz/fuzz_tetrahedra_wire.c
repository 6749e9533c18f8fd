/* What the tetrahedra helper says, believed in nothing: it answers with a frame around whatever the input holds. */
#include <glib.h>
#include <string.h>

#include "core/generate/tetrahedra/private.h"
#include "core/io/helper_wire.h"
#include "answers.h"
#include "fuzz.h"

const unsigned fuzz_rounds = 150;
const char *const fuzz_words[] = {"\xff\xff\xff\xff\xff\xff\xff\xff", "\x03", "\x04", "\x01", "\x7f\xf0", "nan", NULL};

int LLVMFuzzerTestOneInput(const uint8_t *content, size_t size) {
  GError *error = NULL;
  SporeFrame frame = {SPORE_FRAME_MAGIC, SPORE_FRAME_ANSWER, size};
  g_autoptr(GByteArray) bytes = g_byte_array_new();
  g_byte_array_append(bytes, (const guint8 *)&frame, sizeof frame);
  g_byte_array_append(bytes, content, (guint)size);
  g_file_set_contents(fuzz_answer_file("spore-tetrahedra"), (const char *)bytes->data, bytes->len, &error);
  g_assert_no_error(error);
  double vertices[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, length = 1;
  uint32_t triangles[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  SporeTetrahedraWork work = {.surface = {4, 4, vertices, triangles, false}, .share = 1};
  SporeSizing sizing = {.count = {1, 1, 1}, .spacing = 1, .size = &length};
  SporeTriangleMesh surface = {0};
  SporeTetrahedralMesh mesh = {0};
  if (spore_tetrahedra_prepare(&work, SPORE_TETRAHEDRA_REPAIR, 0, 0, &surface, &error))
    g_assert_true(spore_triangle_mesh_validate(&surface, NULL));
  else g_assert_nonnull(error);
  g_clear_error(&error);
  if (spore_tetrahedra_refine(&work, &work.surface, &sizing, SPORE_TETRAHEDRA_ROUGH, 100, &mesh, &error))
    g_assert_true(spore_tetrahedral_mesh_validate(&mesh, NULL));
  else g_assert_nonnull(error);
  g_clear_error(&error);
  spore_triangle_mesh_clear(&surface);
  spore_tetrahedral_mesh_clear(&mesh);
  return 0;
}
