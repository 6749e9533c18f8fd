/* Checks the JSON of a glTF file before a library expands it. */
#ifndef SPORE_IO_GLTF_CHECK_H
#define SPORE_IO_GLTF_CHECK_H

#include <glib.h>

#include "core/scene/error.h"

/* Reads the text alone and takes a few bytes of memory for each node, mesh and accessor. Refuses what assimp accepts
 * though glTF 2.0 does not: offsets below 0, strides other than 4 to 252, nodes with two parents (60 of them, nested,
 * stand for 2^60), and more vertices or triangles than SPORE_MESH_MAXIMUM, counted for each node that shows them. */
gboolean spore_gltf_check(const char *place, const char *text, gsize size, GError **error);

#endif
