/* A drawing as a picture. */
#ifndef SPORE_APP_CLI_SVG_PICTURE_H
#define SPORE_APP_CLI_SVG_PICTURE_H

#include <glib.h>

/* The drawing as PNG, two pixels for each of its own; g_free. NULL with a GError: this build, or this machine, cannot
 * draw SVG. */
char *spore_cli_png_of_svg(const char *svg, gsize *size, GError **error);

#endif
