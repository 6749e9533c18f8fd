/* Sphere sets: read and valid, or refused; what is read and written is read again to the same bits. */
#include <glib.h>
#include <string.h>

#include "core/io/mesh_import.h"
#include "fuzz.h"

const unsigned fuzz_rounds = 50000;
const char *const fuzz_words[] = {"0 0 0 1\n", "# ",     "\n", "nan", "inf",  "1e999", "-1",
                                  " ",         "1e-320", "+",  ".",   "\r\n", "\t",    NULL};

int LLVMFuzzerTestOneInput(const uint8_t *content, size_t size) {
  SporeSphereSet set = {0}, again = {0};
  GError *error = NULL;
  if (!spore_spheres_parse("fuzz.spheres", (const char *)content, size, &set, &error)) {
    g_assert_true(g_str_has_prefix(error->message, "fuzz.spheres"));
    g_clear_error(&error);
    g_assert_null(set.spheres);
    return 0;
  }
  g_assert_true(spore_sphere_set_validate(&set, NULL));
  gsize length;
  g_autofree char *text = spore_spheres_format(&set, &length);
  spore_spheres_parse("again.spheres", text, length, &again, &error);
  g_assert_no_error(error);
  g_assert_true(!set.weights == !again.weights);
  if (set.weights)
    g_assert_cmpmem(set.weights, set.count * sizeof(double), again.weights, again.count * sizeof(double));
  g_assert_cmpmem(set.spheres, set.count * 4 * sizeof(double), again.spheres, again.count * 4 * sizeof(double));
  spore_sphere_set_clear(&set);
  spore_sphere_set_clear(&again);
  return 0;
}
