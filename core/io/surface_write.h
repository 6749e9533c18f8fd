/* Surfaces of several bodies as files of meshes that most programs open, in metres. */
#ifndef SPORE_IO_SURFACE_WRITE_H
#define SPORE_IO_SURFACE_WRITE_H

#include <glib.h>

#include "core/mesh/mesh.h"

/* A surface and what it is called. */
typedef struct SporeNamedSurface {
  const char *name;       /* a name of a body; borrowed */
  double colour[3];       /* sRGB, 0..1 */
  double wetness;         /* 0..1 */
  SporeTriangleMesh mesh; /* owned: spore_triangle_mesh_clear */
} SporeNamedSurface;

/* OBJ: an object of its name for each surface, in double precision, with a material of the same name in the file
 * `materials`. g_free. */
char *spore_obj_format_scene(const SporeNamedSurface *surfaces, gsize count, const char *materials, gsize *size);
/* The materials of that OBJ (.mtl): colours in sRGB. g_free. */
char *spore_mtl_format(const SporeNamedSurface *surfaces, gsize count, gsize *size);
/* Binary PLY: one mesh, with the colour of its surface at each vertex. g_byte_array_unref. */
GByteArray *spore_ply_format(const SporeNamedSurface *surfaces, gsize count);
/* Binary STL: one mesh. g_byte_array_unref. */
GByteArray *spore_stl_format(const SporeNamedSurface *surfaces, gsize count);

#endif
