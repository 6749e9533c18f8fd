/* A machine whose EGL has no driver: a message, not an abort. The environment is set for this program in meson.build.
 */
#include <string.h>

#include "ui/render/renderer.h"

static void test_message(void) {
  for (int i = 0; i < 2; i++) {
    GError *error = NULL;
    g_assert_null(spore_offscreen_new(&error));
    g_assert_error(error, SPORE_ERROR, SPORE_ERROR_UNSUPPORTED);
    g_assert_nonnull(strstr(error->message, "OpenGL 3.3"));
    g_error_free(error);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/render/no-graphics/message", test_message);
  return g_test_run();
}
