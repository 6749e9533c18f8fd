/* Files of textures: what is hostile is refused with its place, and places follow the form of a mesh. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/scene/texture.h"
#include "fixture.h"

/* A PNG of that size with no pixels in it, and its end mark where `whole`. */
static GBytes *head_of_png(guint8 width_high, guint8 width, gboolean whole) {
  guint8 bytes[45] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0, 0, 0, 13, 'I', 'H', 'D', 'R'};
  bytes[18] = width_high, bytes[19] = width, bytes[23] = 8, bytes[24] = 8, bytes[25] = 2;
  memcpy(bytes + 37, "IEND", 4);
  return g_bytes_new(bytes, whole ? sizeof bytes : 40);
}

static void refuse_picture(GBytes *content, const char *says) {
  GError *error = NULL;
  int width, height;
  g_assert_false(spore_texture_size("a.png", content, &width, &height, &error));
  g_assert_true(g_str_has_prefix(error->message, "a.png: "));
  fixture_assert_error(error, SPORE_ERROR_INPUT, says);
  g_bytes_unref(content);
}

static void test_pictures(void) {
  int width = 0, height = 0;
  g_autoptr(GError) error = NULL;
  g_autoptr(GBytes) good = head_of_png(0, 16, TRUE);
  g_assert_true(spore_texture_size("a.png", good, &width, &height, &error));
  g_assert_no_error(error);
  g_assert_cmpint(width, ==, 16);
  g_assert_cmpint(height, ==, 8);
  refuse_picture(head_of_png(60000 >> 8, 60000 & 255, TRUE), "60000 x 8 pixels");
  refuse_picture(head_of_png(0, 0, TRUE), "0 x 8 pixels");
  refuse_picture(head_of_png(0, 16, FALSE), "cut off");
  refuse_picture(g_bytes_new_static("\xff\xd8\xff\xe0 a photograph of some kind", 28), "no PNG");
  refuse_picture(g_bytes_new_static("", 0), "no PNG");
}

static void refuse_places(const char *text, const char *says) {
  GError *error = NULL;
  g_assert_null(spore_texture_places_parse("a.places", text, strlen(text), 3, &error));
  g_test_message("%s", error->message);
  fixture_assert_error(error, SPORE_ERROR_INPUT, says);
}

static void test_places(void) {
  static const float places[6] = {0, 0, 0.25f, 1, -3.5f, 1e-7f};
  gsize size;
  g_autoptr(GError) error = NULL;
  g_autofree char *text = spore_texture_places_format(places, 3, &size);
  float *read = spore_texture_places_parse("a.places", text, size, 3, &error);
  g_assert_no_error(error);
  g_assert_cmpmem(read, sizeof places, places, sizeof places);
  spore_free(read);
  refuse_places("spore-places 1\n0 0\n1 0\n", "line 4: expected exactly 3 lines");
  refuse_places("spore-places 1\n0 0\n1 0\n1 1\n0 1\n", "line 5: expected exactly 3 lines");
  refuse_places("spore-places 1\n0 0\n1 nan\n1 1\n", "line 3: expected two numbers");
  refuse_places("spore-places 1\n0 0\n1\n0 1 1\n", "line 3: expected two numbers");
  refuse_places("spore-places 1\n0 0\n1 1e9\n1 1\n", "line 3: expected two numbers");
  refuse_places("OFF\n3 1 0\n", "line 1: expected spore-places 1");
}

/* Two triangles of a square, the picture cut along their common edge: places of one begin at 0, of the other at 5. */
static void test_transfer(void) {
  double vertices[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  uint32_t triangles[6] = {0, 1, 2, 0, 2, 3}, turned[6] = {3, 2, 0, 2, 1, 0};
  static const float places[12] = {0, 0, 1, 0, 1, 1, 5, 0, 6, 1, 5, 1};
  const SporeTriangleMesh from = {4, 2, vertices, triangles, false}, to = {4, 2, vertices, turned, false};
  SporeError failure = SPORE_ERROR_INIT;
  float *moved = spore_texture_places_transfer(&from, places, &to, &failure);
  static const float expected[12] = {5, 1, 6, 1, 5, 0, 1, 1, 1, 0, 0, 0};
  g_assert_nonnull(moved);
  for (int i = 0; i < 12; i++) g_assert_cmpfloat_with_epsilon(moved[i], expected[i], 1e-6);
  spore_free(moved);
}

/* Of a strip whose picture begins anew in its middle, one large triangle over the seam keeps to the side of its middle
 * and does not show the whole picture once more. */
static void test_seam(void) {
  double strip[18] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0},
         large[9] = {0.2, 0, 0, 1.2, 0, 0, 0.2, 1, 0};
  uint32_t triangles[12] = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4}, one[3] = {0, 1, 2};
  static const float places[24] = {0.9f, 0, 1,    0, 1,    1, 0.9f, 0, 1,    1, 0.9f, 1,
                                   0,    0, 0.1f, 0, 0.1f, 1, 0,    0, 0.1f, 1, 0,    1};
  const SporeTriangleMesh from = {6, 4, strip, triangles, false}, to = {3, 1, large, one, false};
  SporeError failure = SPORE_ERROR_INIT;
  float *moved = spore_texture_places_transfer(&from, places, &to, &failure);
  g_assert_nonnull(moved);
  g_assert_cmpfloat_with_epsilon(moved[0], 0.92, 1e-6);
  g_assert_cmpfloat_with_epsilon(moved[2], 1.02, 1e-6);
  spore_free(moved);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/texture/pictures", test_pictures);
  g_test_add_func("/texture/places", test_places);
  g_test_add_func("/texture/transfer", test_transfer);
  g_test_add_func("/texture/seam", test_seam);
  return g_test_run();
}
