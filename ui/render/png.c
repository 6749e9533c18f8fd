/* Writes a picture as a PNG file. */
#include <errno.h>
#include <fcntl.h>
#include <glib/gi18n.h>
#include <glib/gstdio.h>
#include <png.h>
#include <string.h>
#include <unistd.h>

#include "ui/render/renderer.h"

static gboolean file_failed(GError **error, const char *file) {
  int code = errno;
  return spore_error_raise(error, SPORE_ERROR_FILE, file,
                           _("the picture cannot be written (%s); a folder that may be written to and has room was "
                             "expected; choose another place"),
                           g_strerror(code));
}

/* libpng's own handlers print messages. Ours only return, and errno holds the cause. */
static void G_GNUC_NORETURN png_failed(png_structp png, png_const_charp message) { png_longjmp(png, 1); }

static void png_warned(png_structp png, png_const_charp message) {}

static gboolean encode(FILE *stream, const guint8 *pixels, int width, int height, gsize stride, guint8 *row) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, png_failed, png_warned);
  png_infop info = png ? png_create_info_struct(png) : NULL;
  if (!info || setjmp(png_jmpbuf(png))) {
    png_destroy_write_struct(&png, &info);
    return FALSE;
  }
  png_init_io(png, stream);
  png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  for (int y = 0; y < height; y++) {
    for (int x = 0; x < width; x++) {
      guint32 pixel;
      memcpy(&pixel, pixels + (gsize)y * stride + 4 * (gsize)x, 4);
      row[3 * x] = (guint8)(pixel >> 16), row[3 * x + 1] = (guint8)(pixel >> 8), row[3 * x + 2] = (guint8)pixel;
    }
    png_write_row(png, row);
  }
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return TRUE;
}

static gboolean write_stream(int descriptor, const guint8 *pixels, int width, int height, gsize stride) {
  FILE *stream = fdopen(descriptor, "wb");
  if (!stream) {
    close(descriptor);
    return FALSE;
  }
  guint8 *row = g_malloc((gsize)width * 3);
  errno = 0;
  gboolean good = encode(stream, pixels, width, height, stride, row) && fflush(stream) == 0 && fsync(descriptor) == 0;
  int code = errno;
  g_free(row);
  if (fclose(stream) != 0 && good) return FALSE;
  errno = code ? code : EIO;
  return good;
}

gboolean spore_png_write(const char *file, const guint8 *pixels, int width, int height, gsize stride, GError **error) {
  g_return_val_if_fail(width > 0 && height > 0 && stride >= 4 * (gsize)width, FALSE);
  if (g_file_test(file, G_FILE_TEST_EXISTS) && !g_file_test(file, G_FILE_TEST_IS_REGULAR))
    return spore_error_raise(error, SPORE_ERROR_FILE, file,
                             _("this is no regular file; a picture to write was expected; choose another place"));
  char *temporary = g_strdup_printf("%s.XXXXXX", file);
  int descriptor = g_mkstemp_full(temporary, O_RDWR | O_CLOEXEC, 0666);
  gboolean good = descriptor >= 0;
  if (good) {
    good = write_stream(descriptor, pixels, width, height, stride) && g_rename(temporary, file) == 0;
    int code = errno;
    if (!good) g_unlink(temporary);
    errno = code;
  }
  if (!good) file_failed(error, file);
  g_free(temporary);
  return good;
}
