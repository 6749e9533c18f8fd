/* See svg.h; gdk-pixbuf finds the loader when the first drawing is made. */
#include "ui/render/svg.h"

#include <gdk-pixbuf/gdk-pixbuf.h>
#include <glib/gi18n.h>
#include <string.h>

#include "core/scene/error.h"

#define PNG_SCALE 2

typedef struct Size {
  int width, height; /* 0: PNG_SCALE times the drawing's own */
} Size;

static void set_size(GdkPixbufLoader *loader, int width, int height, gpointer data) {
  const Size *size = data;
  if (size->width > 0) gdk_pixbuf_loader_set_size(loader, size->width, size->height);
  else gdk_pixbuf_loader_set_size(loader, PNG_SCALE * width, PNG_SCALE * height);
}

static GdkPixbuf *draw(const char *svg, Size size, GError **error) {
  g_autoptr(GdkPixbufLoader) loader = gdk_pixbuf_loader_new_with_type("svg", NULL);
  GdkPixbuf *picture = NULL;
  if (loader) {
    g_signal_connect(loader, "size-prepared", G_CALLBACK(set_size), &size);
    gboolean whole = gdk_pixbuf_loader_write(loader, (const guchar *)svg, strlen(svg), NULL);
    whole = gdk_pixbuf_loader_close(loader, NULL) && whole;
    picture = whole ? gdk_pixbuf_loader_get_pixbuf(loader) : NULL;
  }
  if (picture) return g_object_ref(picture);
  spore_error_raise(error, SPORE_ERROR_UNSUPPORTED, NULL,
                    _("this machine draws no SVG; expected gdk-pixbuf's loader of it; install librsvg2-common"));
  return NULL;
}

char *spore_svg_to_png(const char *svg, gsize *size, GError **error) {
  char *bytes = NULL;
  g_autoptr(GdkPixbuf) picture = draw(svg, (Size){0, 0}, error);
  if (picture) gdk_pixbuf_save_to_buffer(picture, &bytes, size, "png", error, NULL);
  return bytes;
}

static guint32 mix(guint32 below, const guchar *above, int alpha) {
  guint32 mixed = 0;
  for (int k = 0; k < 3; k++) {
    int shift = 16 - 8 * k, is = (int)(below >> shift & 255);
    mixed |= (guint32)((is * (255 - alpha) + above[k] * alpha + 127) / 255) << shift;
  }
  return mixed;
}

gboolean spore_svg_draw_over(const char *svg, guint8 *pixels, int width, int height, gsize stride, GError **error) {
  g_autoptr(GdkPixbuf) picture = draw(svg, (Size){width, height}, error);
  if (!picture) return FALSE;
  const guchar *from = gdk_pixbuf_read_pixels(picture);
  gsize channels = (gsize)gdk_pixbuf_get_n_channels(picture), row = (gsize)gdk_pixbuf_get_rowstride(picture);
  width = MIN(width, gdk_pixbuf_get_width(picture)), height = MIN(height, gdk_pixbuf_get_height(picture));
  for (gsize y = 0; y < (gsize)height; y++)
    for (gsize x = 0; x < (gsize)width; x++) {
      const guchar *above = from + y * row + x * channels;
      guint32 pixel;
      memcpy(&pixel, pixels + y * stride + 4 * x, sizeof pixel);
      pixel = mix(pixel, above, channels == 4 ? above[3] : 255);
      memcpy(pixels + y * stride + 4 * x, &pixel, sizeof pixel);
    }
  return TRUE;
}
