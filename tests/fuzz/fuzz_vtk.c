/* VTK files of strangers, legacy and XML: whatever the bytes, an answer that holds what its head promises, or a
 * message. */
#include <glib.h>
#include <stdlib.h>
#include <string.h>

#include "app/helpers/vtk.h"
#include "core/io/import_wire.h"
#include "fuzz.h"

const unsigned fuzz_rounds = 4000;
const char *const fuzz_words[] = {"# vtk DataFile Version 5.1\n",
                                  "BINARY\n",
                                  "POINTS 4000000000 double\n",
                                  "POLYGONS 1 4\n",
                                  "OFFSETS vtktypeint64\n",
                                  "FIELD f 1\na 2 4294967295 int\n",
                                  "METADATA\n",
                                  "<Piece>",
                                  "</Piece>",
                                  "<Polys>",
                                  "<DataArray type=\"Int8\" Name=\"offsets\" format=\"ascii\">",
                                  "format=\"binary\"",
                                  "format=\"appended\" offset=\"1e9\"",
                                  "header_type=\"UInt64\"",
                                  "nan",
                                  "-1",
                                  "1e308",
                                  "AAAA",
                                  "\xff\xff\xff\xff",
                                  "<!--",
                                  NULL};

static void check_answer(void *answer, size_t size) {
  SporeImportAnswer head;
  g_assert_cmpuint(size, >, sizeof head);
  memcpy(&head, answer, sizeof head);
  g_assert_cmpuint(head.part_count, ==, 1);
  g_assert_cmpuint(size, ==, sizeof head + sizeof(SporeImportPart) + 24 * head.vertex_count + 12 * head.triangle_count);
  const char *triangles = (const char *)answer + size - 12 * head.triangle_count;
  for (guint64 i = 0; i < 3 * head.triangle_count; i++) {
    guint32 corner;
    memcpy(&corner, triangles + 4 * i, sizeof corner);
    g_assert_cmpuint(corner, <, head.vertex_count);
  }
}

int LLVMFuzzerTestOneInput(const uint8_t *content, size_t size) {
  for (int xml = 0; xml < 2; xml++) {
    SporeHelperFailure failure = {0};
    void *answer = NULL;
    size_t answer_size = 0;
    if ((xml ? spore_vtk_xml : spore_vtk_legacy)((const char *)content, size, &answer, &answer_size, &failure))
      check_answer(answer, answer_size);
    else
      g_assert_true(failure.message && strchr(failure.message, ';') &&
                    memchr(failure.detail, 0, sizeof failure.detail));
    free(answer);
  }
  return 0;
}
