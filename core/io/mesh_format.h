/* Recognises the mesh format of a file's content. */
#ifndef SPORE_IO_MESH_FORMAT_H
#define SPORE_IO_MESH_FORMAT_H

#include <glib.h>

#include "core/scene/error.h"

typedef enum SporeMeshFormat {
  SPORE_MESH_STL,
  SPORE_MESH_OBJ,
  SPORE_MESH_PLY,
  SPORE_MESH_OFF,
  SPORE_MESH_GLTF,
  SPORE_MESH_GLB,
  SPORE_MESH_VTK,
  SPORE_MESH_VTP, /* the XML format of VTK */
  SPORE_MESH_FORMAT_COUNT
} SporeMeshFormat;

extern const char *const spore_mesh_format_names[SPORE_MESH_FORMAT_COUNT]; /* "STL", ... */

/* Looks at the content. `file` only helps to say what is wrong with unknown content or content that was cut short. */
gboolean spore_mesh_format_find(const char *place, const char *file, const void *content, gsize size,
                                SporeMeshFormat *format, GError **error);

/* Bytes of the mesh itself: less than `size` for a binary STL with other bytes behind its facets. */
gsize spore_mesh_format_extent(SporeMeshFormat format, const void *content, gsize size);

#endif
