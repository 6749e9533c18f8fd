/* Writing pictures: whole or not at all. */
#include <glib/gstdio.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "tests/render/scenery.h"

enum { WIDTH = 37, HEIGHT = 23, STRIDE = 4 * WIDTH + 12 };

static void fill(guint8 *pixels) {
  for (int y = 0; y < HEIGHT; y++)
    for (int x = 0; x < WIDTH; x++) {
      guint32 pixel = (guint32)(x * 6) << 16 | (guint32)(y * 11) << 8 | (guint32)((x * y) & 255);
      memcpy(pixels + y * STRIDE + 4 * x, &pixel, 4);
    }
}

static guint count_files(const char *folder) {
  GDir *dir = g_dir_open(folder, 0, NULL);
  guint count = 0;
  while (g_dir_read_name(dir)) count++;
  g_dir_close(dir);
  return count;
}

static void test_round_trip(void) {
  g_autofree char *folder = g_dir_make_tmp("spore-png-XXXXXX", NULL), *file = g_build_filename(folder, "a.png", NULL);
  guint8 pixels[HEIGHT * STRIDE] = {0};
  GError *error = NULL;
  fill(pixels);
  spore_png_write(file, pixels, WIDTH, HEIGHT, STRIDE, &error);
  g_assert_no_error(error);
  spore_png_write(file, pixels, WIDTH, HEIGHT, STRIDE, &error); /* again, over it */
  g_assert_no_error(error);
  Picture picture = picture_read(file);
  g_assert_cmpint(picture.width, ==, WIDTH);
  g_assert_cmpint(picture.height, ==, HEIGHT);
  for (int y = 0; y < HEIGHT; y++)
    for (int x = 0; x < WIDTH; x++) {
      int rgb[3];
      picture_pixel(&picture, x, y, rgb);
      g_assert_cmpint(rgb[0], ==, x * 6);
      g_assert_cmpint(rgb[1], ==, y * 11);
      g_assert_cmpint(rgb[2], ==, (x * y) & 255);
    }
  g_assert_cmpuint(count_files(folder), ==, 1);
  picture_clear(&picture);
  g_unlink(file);
  g_rmdir(folder);
}

static void expect_refused(const char *file) {
  guint8 pixels[HEIGHT * STRIDE] = {0};
  GError *error = NULL;
  g_assert_false(spore_png_write(file, pixels, WIDTH, HEIGHT, STRIDE, &error));
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_FILE);
  g_assert_true(g_str_has_prefix(error->message, file));
  g_error_free(error);
}

static void test_no_such_folder(void) { expect_refused("/nonexistent/folder/picture.png"); }

static void test_folder_in_the_way(void) {
  g_autofree char *folder = g_dir_make_tmp("spore-png-XXXXXX", NULL), *file = g_build_filename(folder, "a.png", NULL);
  g_assert_cmpint(g_mkdir(file, 0700), ==, 0);
  expect_refused(file);
  g_assert_cmpuint(count_files(folder), ==, 1); /* no temporary file is left */
  g_rmdir(file);
  g_rmdir(folder);
}

/* A limit on the size of files stands for the full disk. What was there before stays. */
static void test_full_disk(void) {
  g_autofree char *folder = g_dir_make_tmp("spore-png-XXXXXX", NULL), *file = g_build_filename(folder, "a.png", NULL);
  g_assert_true(g_file_set_contents(file, "before", -1, NULL));
  struct rlimit before, limit;
  getrlimit(RLIMIT_FSIZE, &before);
  limit = before;
  limit.rlim_cur = 20;
  void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &limit);
  expect_refused(file);
  setrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, handler);
  g_autofree char *content = NULL;
  g_assert_true(g_file_get_contents(file, &content, NULL, NULL));
  g_assert_cmpstr(content, ==, "before");
  g_assert_cmpuint(count_files(folder), ==, 1);
  g_unlink(file);
  g_rmdir(folder);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/render/png/round-trip", test_round_trip);
  g_test_add_func("/render/png/no-such-folder", test_no_such_folder);
  g_test_add_func("/render/png/folder-in-the-way", test_folder_in_the_way);
  g_test_add_func("/render/png/full-disk", test_full_disk);
  return g_test_run();
}
