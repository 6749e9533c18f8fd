/* Does a PLY file hold what its header promises? */
#ifndef SPORE_IO_PLY_CHECK_H
#define SPORE_IO_PLY_CHECK_H

#include <glib.h>

#include "core/scene/error.h"

/* Walks over every element: assimp reads a file that was cut short as one with fewer faces, or dies of it. Refuses
 * that, and faces that name a vertex that is not there. */
gboolean spore_ply_check(const char *place, const char *content, gsize size, GError **error);

#endif
