/* Checks that a PLY file holds the elements that its header announces. */
#ifndef SPORE_IO_PLY_CHECK_H
#define SPORE_IO_PLY_CHECK_H

#include <glib.h>

#include "core/scene/error.h"

/* Walks over every element. assimp reads a file that was cut short as one with fewer faces, or crashes. This check
 * refuses such a file, and faces that name a missing vertex. */
gboolean spore_ply_check(const char *place, const char *content, gsize size, GError **error);

#endif
