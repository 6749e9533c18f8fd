/* OFF, read and written by SPORE itself. */
#ifndef SPORE_IO_OFF_H
#define SPORE_IO_OFF_H

#include <glib.h>

#include "core/mesh/mesh.h"
#include "core/scene/error.h"

/* The text begins as OFF does. */
gboolean spore_off_is(const char *text, gsize size);
/* As in the file: neither validated beyond its indices, nor welded. *mesh is empty before; on FALSE it stays so. */
gboolean spore_off_parse(const char *place, const char *text, gsize size, SporeTriangleMesh *mesh, GError **error);

#endif
