/* Makes a PNG of an SVG document, by gdk-pixbuf and its loader of SVG, where there are both. */
#include "app/cli/svg_picture.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/scene/error.h"

#ifdef SPORE_HAVE_PIXBUF
#include <gdk-pixbuf/gdk-pixbuf.h>

#define SCALE 2

static void set_size(GdkPixbufLoader *loader, int width, int height, gpointer data) {
  gdk_pixbuf_loader_set_size(loader, SCALE * width, SCALE * height);
}

static GdkPixbuf *draw(const char *svg) {
  g_autoptr(GdkPixbufLoader) loader = gdk_pixbuf_loader_new_with_type("svg", NULL);
  if (!loader) return NULL;
  g_signal_connect(loader, "size-prepared", G_CALLBACK(set_size), NULL);
  gboolean whole = gdk_pixbuf_loader_write(loader, (const guchar *)svg, strlen(svg), NULL);
  whole = gdk_pixbuf_loader_close(loader, NULL) && whole;
  GdkPixbuf *picture = whole ? gdk_pixbuf_loader_get_pixbuf(loader) : NULL;
  return picture ? g_object_ref(picture) : NULL;
}

char *spore_cli_png_of_svg(const char *svg, gsize *size, GError **error) {
  char *bytes = NULL;
  g_autoptr(GdkPixbuf) picture = draw(svg);
  if (picture && gdk_pixbuf_save_to_buffer(picture, &bytes, size, "png", NULL, NULL)) return bytes;
  spore_error_raise(
      error, SPORE_ERROR_UNSUPPORTED, NULL,
      _("this machine draws no SVG; expected gdk-pixbuf's loader of it (librsvg2-common); install that, or "
        "write --svg"));
  return NULL;
}

#else

char *spore_cli_png_of_svg(const char *svg, gsize *size, GError **error) {
  spore_error_raise(error, SPORE_ERROR_UNSUPPORTED, NULL,
                    _("this build makes no PNG of a plot; expected one with gdk-pixbuf; write --svg and convert that"));
  return NULL;
}

#endif
