/* Textures in pictures: where the colours of a picture come to lie, that they go with the surface, and pictures that
 * cannot be decoded. */
#include <string.h>

#include "tests/render/scenery.h"

/* A PNG whose left half is red and whose right half is blue. */
static GBytes *half_and_half(void) {
  guint32 pixels[64];
  GError *error = NULL;
  for (int i = 0; i < 64; i++) pixels[i] = i % 8 < 4 ? 0xe01010 : 0x1010e0;
  GBytes *png = spore_png_encode((const guint8 *)pixels, 8, 8, 32, &error);
  g_assert_no_error(error);
  return png;
}

static const double square[12] = {-0.05, -0.05, 0, 0.05, -0.05, 0, 0.05, 0.05, 0, -0.05, 0.05, 0};
static const guint32 triangles[6] = {0, 1, 2, 0, 2, 3};
static const SporeSurfaceStyle white = {{1, 1, 1}, 0, SPORE_MATERIAL_TISSUE, FALSE, FALSE};

/* The difference between red and blue, 0..255, left and right of the middle. */
static void look(SporeRenderer *renderer, gboolean antialias, int difference[2]) {
  const SporeCamera camera = straight_camera(0.3);
  Picture picture = draw_picture(renderer, &camera, 120, 80, antialias, FALSE);
  for (int i = 0; i < 2; i++) {
    int rgb[3];
    picture_pixel(&picture, i ? 66 : 54, 40, rgb);
    difference[i] = rgb[0] - rgb[2];
  }
  picture_clear(&picture);
}

static void test_places(void) {
  static const float straight[12] = {0, 1, 1, 1, 1, 0, 0, 1, 1, 0, 0, 0},
                     turned[12] = {1, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0},
                     parted[12] = {0, 1, 0.4f, 1, 0.4f, 0, 0.6f, 1, 0.6f, 0, 1, 0}; /* below red, above blue */
  for (int antialias = 0; antialias < 2; antialias++) {
    Bench bench = bench_open();
    GError *error = NULL;
    int shown[2];
    g_autoptr(GBytes) png = half_and_half();
    guint texture = spore_renderer_add_texture(bench.renderer, "half.png", png, &error);
    g_assert_no_error(error);
    const float *places[3] = {straight, turned, parted};
    for (int i = 0; i < 3; i++) {
      guint surface = spore_renderer_add_surface(bench.renderer, square, 4, triangles, 2, &white);
      look(bench.renderer, antialias, shown);
      g_assert_cmpint(abs(shown[0]), <, 40); /* white as long as nothing is laid over it */
      spore_renderer_lay_texture(bench.renderer, surface, square, texture, places[i]);
      if (i == 2) spore_renderer_move_surface(bench.renderer, surface, square);
      look(bench.renderer, antialias, shown);
      g_test_message("%d %d: %d %d", antialias, i, shown[0], shown[1]);
      if (i == 0) g_assert_true(shown[0] > 60 && shown[1] < -60);
      if (i == 1) g_assert_true(shown[0] < -60 && shown[1] > 60);
      if (i == 2) g_assert_true(shown[0] < -60 && shown[1] > 60); /* the diagonal rises to the right */
      spore_renderer_remove(bench.renderer, surface);
    }
    spore_renderer_remove_texture(bench.renderer, texture);
    bench_close(&bench);
  }
}

/* A surface that wears a picture and one that wears none, side by side, each as if it were alone. */
static void test_beside(void) {
  static const float all_red[12] = {0.1f, 0.1f, 0.2f, 0.1f, 0.2f, 0.2f, 0.1f, 0.1f, 0.2f, 0.2f, 0.1f, 0.2f};
  double moved[2][12];
  for (int i = 0; i < 12; i++)
    moved[0][i] = square[i] - (i % 3 ? 0 : 0.051), moved[1][i] = square[i] + (i % 3 ? 0 : 0.051);
  Bench bench = bench_open();
  int shown[2];
  g_autoptr(GBytes) png = half_and_half();
  guint texture = spore_renderer_add_texture(bench.renderer, "half.png", png, NULL);
  guint red = spore_renderer_add_surface(bench.renderer, moved[0], 4, triangles, 2, &white);
  spore_renderer_add_surface(bench.renderer, moved[1], 4, triangles, 2, &white);
  spore_renderer_lay_texture(bench.renderer, red, moved[0], texture, all_red);
  look(bench.renderer, TRUE, shown);
  g_assert_cmpint(shown[0], >, 60);
  g_assert_cmpint(abs(shown[1]), <, 40);
  bench_close(&bench);
}

static void test_hostile(void) {
  Bench bench = bench_open();
  g_autoptr(GBytes) png = half_and_half();
  gsize size;
  const guint8 *good = g_bytes_get_data(png, &size);
  for (int kind = 0; kind < 3; kind++) {
    GError *error = NULL;
    g_autofree guint8 *bytes = g_memdup2(good, size);
    if (kind == 1) bytes[18] = bytes[22] = 0xea;             /* about 60,000 pixels a side */
    if (kind == 2) memset(bytes + size - 12 - 24, 0xff, 16); /* pixels that do not decode */
    g_autoptr(GBytes) bad = g_bytes_new(bytes, kind == 0 ? size / 2 : size);
    g_assert_cmpuint(spore_renderer_add_texture(bench.renderer, "bad.png", bad, &error), ==, 0);
    g_test_message("%s", error->message);
    g_assert_error(error, SPORE_ERROR, SPORE_ERROR_INPUT);
    g_assert_nonnull(strstr(error->message, kind == 0 ? "cut off" : kind == 1 ? "pixels" : "cannot be decoded"));
    g_error_free(error);
  }
  bench_close(&bench);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/texture/places", test_places);
  g_test_add_func("/texture/beside", test_beside);
  g_test_add_func("/texture/hostile", test_hostile);
  return g_test_run();
}
