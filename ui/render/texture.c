/* Textures: PNGs decoded into pictures on the graphics device. */
#include <glib/gi18n.h>
#include <png.h>

#include "core/base/memory.h"
#include "core/math/colour.h"
#include "core/scene/texture.h"
#include "ui/render/passes.h"

#define CHANNELS 4

/* The pixels, red green blue alpha as in sRGB, upper row first; spore_free. */
static guint8 *decode(const char *place, GBytes *content, int *width, int *height, GError **error) {
  gsize size;
  const void *bytes = g_bytes_get_data(content, &size);
  if (!spore_texture_size(place, content, width, height, error)) return NULL;
  png_image image = {.version = PNG_IMAGE_VERSION};
  if (png_image_begin_read_from_memory(&image, bytes, size)) {
    image.format = PNG_FORMAT_RGBA;
    guint8 *pixels = spore_allocate((gsize)*width * (gsize)*height, CHANNELS);
    if (pixels && png_image_finish_read(&image, NULL, pixels, 0, NULL)) return pixels;
    png_image_free(&image);
    spore_free(pixels);
    if (!pixels) {
      spore_error_raise(error, SPORE_ERROR_MEMORY, place, _("not enough memory for the picture; make it smaller"));
      return NULL;
    }
  }
  spore_error_raise(error, SPORE_ERROR_INPUT, place,
                    _("the picture cannot be decoded (%s); expected a sound PNG; convert it again"), image.message);
  return NULL;
}

static void take_mean(SporeTextureImage *image, const guint8 *pixels, gsize count) {
  float linear[256];
  double sum[3] = {0};
  for (int i = 0; i < 256; i++) linear[i] = (float)spore_linear_light(i / 255.0);
  for (gsize i = 0; i < count; i++)
    for (gsize k = 0; k < 3; k++) sum[k] += linear[pixels[CHANNELS * i + k]];
  for (int k = 0; k < 3; k++) image->mean[k] = (float)(sum[k] / (double)count);
}

static SporeTextureImage *upload(const guint8 *pixels, int width, int height) {
  SporeTextureImage *image = g_new0(SporeTextureImage, 1);
  take_mean(image, pixels, (gsize)width * (gsize)height);
  glGenTextures(1, &image->id);
  glActiveTexture(GL_TEXTURE0 + SPORE_UNIT_TEXTURE);
  glBindTexture(GL_TEXTURE_2D, image->id);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glGenerateMipmap(GL_TEXTURE_2D);
  return image;
}

SporeTextureImage *spore_texture_image_new(const char *place, GBytes *png, GError **error) {
  int width, height;
  GLint largest;
  guint8 *pixels = decode(place, png, &width, &height, error);
  if (!pixels) return NULL;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  SporeTextureImage *image = width <= largest && height <= largest ? upload(pixels, width, height) : NULL;
  if (!image)
    spore_error_raise(error, SPORE_ERROR_UNSUPPORTED, place,
                      _("the picture has %d x %d pixels; this machine draws textures of at most %d a side; make it "
                        "smaller"),
                      width, height, (int)largest);
  spore_free(pixels);
  return image;
}

void spore_texture_image_free(SporeTextureImage *image) {
  if (!image) return;
  glDeleteTextures(1, &image->id);
  g_free(image);
}
