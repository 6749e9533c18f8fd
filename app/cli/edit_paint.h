/* spore edit --paint: regions painted dab by dab. */
#ifndef SPORE_APP_CLI_EDIT_PAINT_H
#define SPORE_APP_CLI_EDIT_PAINT_H

#include "core/scene/document.h"

/* text: PATH=X,Y,Z,RADIUS: paints the region of that path with one dab more. Where there is none, it is made of the dab
 * alone, in what holds the path. Adds the path (g_free) to `changed`. FALSE with a GError. */
gboolean spore_cli_paint(SporeDocument *document, const char *text, GPtrArray *changed, GError **error);

#endif
