/* Drawings in SVG as pixels, by gdk-pixbuf and its loader of SVG, where there are both. */
#ifndef SPORE_UI_RENDER_SVG_H
#define SPORE_UI_RENDER_SVG_H

#include <glib.h>

/* Draws over a picture of that size, whose rows of `stride` bytes are as of spore_renderer_read; the drawing is made as
 * large as the picture. FALSE with a GError, and nothing is drawn: this build, or this machine, cannot. */
gboolean spore_svg_draw_over(const char *svg, guint8 *pixels, int width, int height, gsize stride, GError **error);
/* The drawing as PNG, two pixels for each of its own; g_free. NULL with a GError: likewise. */
char *spore_svg_to_png(const char *svg, gsize *size, GError **error);

#endif
