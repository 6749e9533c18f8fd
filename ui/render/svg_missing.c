/* Builds without gdk-pixbuf draw no SVG, and say so. */
#include <glib/gi18n.h>

#include "core/scene/error.h"
#include "ui/render/svg.h"

static gboolean refuse(GError **error) {
  return spore_error_raise(error, SPORE_ERROR_UNSUPPORTED, NULL,
                           _("this build draws no SVG; expected one with gdk-pixbuf"));
}

gboolean spore_svg_draw_over(const char *svg, guint8 *pixels, int width, int height, gsize stride, GError **error) {
  return refuse(error);
}

char *spore_svg_to_png(const char *svg, gsize *size, GError **error) {
  refuse(error);
  return NULL;
}
