/* What the tests of the renderer draw, and how pictures are compared. */
#include "tests/render/scenery.h"

#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>

Bench bench_open(void) {
  GError *error = NULL;
  Bench bench = {0};
  bench.offscreen = spore_offscreen_new(&error);
  g_assert_no_error(error);
  bench.renderer = spore_renderer_new(bench.offscreen, &error);
  g_assert_no_error(error);
  return bench;
}

void bench_close(Bench *bench) {
  spore_renderer_free(bench->renderer);
  spore_offscreen_free(bench->offscreen);
}

static SporeVec3 organ_point(double radius, double polar, double turn) {
  double r = radius * (1 + 0.08 * sin(3 * turn) * sin(polar) * sin(2 * polar));
  return spore_vec3(r * sin(polar) * cos(turn), r * cos(polar), 0.8 * r * sin(polar) * sin(turn));
}

SporeTriangleMesh make_organ(double radius) {
  enum { RINGS = 40, SECTORS = 64 };
  SporeTriangleMesh mesh = {0};
  g_assert_true(spore_triangle_mesh_allocate(&mesh, RINGS * SECTORS + 2, 2 * RINGS * SECTORS, NULL));
  const guint32 last = RINGS * SECTORS + 1;
  spore_vec3_store(mesh.vertices, organ_point(radius, 0, 0));
  spore_vec3_store(mesh.vertices + 3 * last, organ_point(radius, G_PI, 0));
  guint32 *out = mesh.triangles;
  for (guint32 ring = 0; ring < RINGS; ring++)
    for (guint32 sector = 0; sector < SECTORS; sector++) {
      guint32 a = 1 + ring * SECTORS + sector, next = 1 + ring * SECTORS + (sector + 1) % SECTORS;
      spore_vec3_store(mesh.vertices + 3 * a,
                       organ_point(radius, G_PI * (ring + 1) / (RINGS + 1), 2 * G_PI * sector / SECTORS));
      const guint32 cap[3] = {0, next, a};
      const guint32 quad[6] = {a, next, a + SECTORS, next, next + SECTORS, a + SECTORS};
      const guint32 end[3] = {a, next, last};
      if (ring == 0) memcpy(out, cap, sizeof cap), out += 3;
      if (ring + 1 < RINGS) memcpy(out, quad, sizeof quad), out += 6;
      else memcpy(out, end, sizeof end), out += 3;
    }
  g_assert_cmpint(out - mesh.triangles, ==, 3 * (gssize)mesh.triangle_count);
  return mesh;
}

SporeCamera straight_camera(double distance) { return (SporeCamera){.distance = distance, .field_of_view = 0.7}; }

Picture draw_picture(SporeRenderer *renderer, const SporeCamera *camera, int width, int height, gboolean antialias,
                     gboolean grid) {
  GError *error = NULL;
  Picture picture = {width, height, g_malloc((gsize)width * (gsize)height * 4)};
  const SporeRenderOptions options = {.width = width, .height = height, .antialias = antialias, .grid = grid};
  spore_renderer_draw(renderer, camera, &options, picture.pixels, (gsize)width * 4, &error);
  g_assert_no_error(error);
  return picture;
}

void picture_clear(Picture *picture) { g_free(picture->pixels); }

void picture_pixel(const Picture *picture, int x, int y, int rgb[3]) {
  guint32 pixel;
  memcpy(&pixel, picture->pixels + 4 * ((gsize)y * (gsize)picture->width + (gsize)x), 4);
  rgb[0] = (int)(pixel >> 16 & 255), rgb[1] = (int)(pixel >> 8 & 255), rgb[2] = (int)(pixel & 255);
}

Picture picture_read(const char *file) {
  png_image image = {.version = PNG_IMAGE_VERSION};
  Picture picture = {0};
  if (!png_image_begin_read_from_file(&image, file)) return picture;
  image.format = G_BYTE_ORDER == G_LITTLE_ENDIAN ? PNG_FORMAT_BGRA : PNG_FORMAT_ARGB;
  picture = (Picture){(int)image.width, (int)image.height, g_malloc(PNG_IMAGE_SIZE(image))};
  if (!png_image_finish_read(&image, NULL, picture.pixels, 0, NULL)) g_clear_pointer(&picture.pixels, g_free);
  return picture;
}

static int compare_ints(const void *a, const void *b) { return *(const int *)a - *(const int *)b; }

PictureDifference picture_compare(const Picture *a, const Picture *b) {
  g_assert_cmpint(a->width, ==, b->width);
  g_assert_cmpint(a->height, ==, b->height);
  gsize count = (gsize)a->width * (gsize)a->height;
  int *differences = g_new0(int, count);
  double sum = 0;
  for (int y = 0; y < a->height; y++)
    for (int x = 0; x < a->width; x++) {
      int p[3], q[3], *worst = &differences[(gsize)y * (gsize)a->width + (gsize)x];
      picture_pixel(a, x, y, p);
      picture_pixel(b, x, y, q);
      for (int i = 0; i < 3; i++) *worst = MAX(*worst, abs(p[i] - q[i]));
      sum += *worst;
    }
  qsort(differences, count, sizeof *differences, compare_ints);
  PictureDifference difference = {sum / (double)count, differences[count * 99 / 100]};
  g_free(differences);
  return difference;
}
