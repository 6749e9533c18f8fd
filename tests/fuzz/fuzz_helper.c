/* What an import helper says, believed in nothing: the child here says whatever the input holds. */
#include <glib.h>
#include <string.h>

#include "core/io/helper.h"
#include "core/io/mesh_import.h"
#include "answers.h"
#include "fuzz.h"

const unsigned fuzz_rounds = 150;
const char *const fuzz_words[] = {"rops", "\x05", "\xff\xff\xff\xff\xff\xff\xff\xff", "\x01", "\x7f", "%s%n", NULL};

static const char stl[] =
    "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
    "endsolid x\n";

int LLVMFuzzerTestOneInput(const uint8_t *content, size_t size) {
  GError *error = NULL;
  g_file_set_contents(fuzz_answer_file("spore-import"), (const char *)content, (gssize)size, &error);
  g_assert_no_error(error);
  SporeHelperLimits limits = {.time_s = 10, .memory = 1 << 30, .output = 1 << 20};
  g_autoptr(GBytes) request = g_bytes_new_static("x", 1);
  g_autoptr(GBytes) answer = spore_helper_run("spore-import", "fuzz", request, &limits, NULL, &error);
  g_assert_true((answer != NULL) == (error == NULL));
  if (answer) g_assert_cmpuint(g_bytes_get_size(answer), <=, limits.output);
  if (error) g_assert_true(g_str_has_prefix(error->message, "fuzz: ") && g_utf8_validate(error->message, -1, NULL));
  g_clear_error(&error);
  SporeTriangleMesh mesh = {0};
  if (spore_mesh_decode("fuzz.stl", "fuzz.stl", stl, strlen(stl), 0, 0, &mesh, NULL, &error))
    g_assert_true(spore_triangle_mesh_validate(&mesh, NULL));
  else g_assert_true(g_str_has_prefix(error->message, "fuzz.stl"));
  g_clear_error(&error);
  spore_triangle_mesh_clear(&mesh);
  return 0;
}
