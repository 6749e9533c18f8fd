/* Makes a PNG of a picture. */
#include <glib/gi18n.h>
#include <png.h>
#include <string.h>

#include "core/io/scene_xml.h"
#include "ui/render/renderer.h"

/* libpng's own handlers print messages. Ours only return. */
static void G_GNUC_NORETURN png_failed(png_structp png, png_const_charp message) { png_longjmp(png, 1); }

static void png_warned(png_structp png, png_const_charp message) {}

static void append(png_structp png, png_bytep data, size_t size) {
  g_byte_array_append(png_get_io_ptr(png), data, (guint)size);
}

static void flushed(png_structp png) {}

static gboolean encode(GByteArray *bytes, const guint8 *pixels, int width, int height, gsize stride, guint8 *row) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, png_failed, png_warned);
  png_infop info = png ? png_create_info_struct(png) : NULL;
  if (!info || setjmp(png_jmpbuf(png))) {
    png_destroy_write_struct(&png, &info);
    return FALSE;
  }
  png_set_write_fn(png, bytes, append, flushed);
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

GBytes *spore_png_encode(const guint8 *pixels, int width, int height, gsize stride, GError **error) {
  g_return_val_if_fail(width > 0 && height > 0 && stride >= 4 * (gsize)width, NULL);
  g_autoptr(GByteArray) bytes = g_byte_array_new();
  g_autofree guint8 *row = g_malloc((gsize)width * 3);
  if (encode(bytes, pixels, width, height, stride, row)) return g_byte_array_free_to_bytes(g_steal_pointer(&bytes));
  spore_error_raise(error, SPORE_ERROR_MEMORY, "PNG", _("not enough memory for the picture; make it smaller"));
  return NULL;
}

gboolean spore_png_write(const char *file, const guint8 *pixels, int width, int height, gsize stride, GError **error) {
  if (g_file_test(file, G_FILE_TEST_EXISTS) && !g_file_test(file, G_FILE_TEST_IS_REGULAR))
    return spore_error_raise(error, SPORE_ERROR_FILE, file,
                             _("this is no regular file; a picture to write was expected; choose another place"));
  g_autoptr(GBytes) bytes = spore_png_encode(pixels, width, height, stride, error);
  return bytes && spore_write_file(file, g_bytes_get_data(bytes, NULL), g_bytes_get_size(bytes), error);
}
