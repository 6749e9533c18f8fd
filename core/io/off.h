/* The OFF mesh format. */
#ifndef SPORE_IO_OFF_H
#define SPORE_IO_OFF_H

#include <glib.h>

#include "core/mesh/mesh.h"
#include "core/scene/error.h"

/* Whether the text begins like OFF. */
gboolean spore_off_is(const char *text, gsize size);
/* Reads the mesh as it is in the file: only indices are checked, and nothing is welded. *mesh must be empty; it stays
 * empty on FALSE. */
gboolean spore_off_parse(const char *place, const char *text, gsize size, SporeTriangleMesh *mesh, GError **error);

#endif
