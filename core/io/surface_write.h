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
  double opacity;         /* 0..1 */
  SporeTriangleMesh mesh; /* owned */
  GBytes *picture;        /* PNG that lies over it (core/scene/texture.h), owned; NULL: none */
  float *places;          /* then of the corners of its triangles in the picture, x 3 x 2; g_free */
} SporeNamedSurface;
void spore_named_surface_clear(SporeNamedSurface *surface);

/* OBJ: an object of its name for each surface, in double precision, with a material of the same name in the file
 * `materials`, and its places in its picture. g_free. */
char *spore_obj_format_scene(const SporeNamedSurface *surfaces, gsize count, const char *materials, gsize *size);
/* The materials of that OBJ (.mtl): colours in sRGB, and opacity where it is less than 1. pictures: for each surface
 * the name of the file that its picture is in, or NULL. g_free. */
char *spore_mtl_format(const SporeNamedSurface *surfaces, gsize count, char *const *pictures, gsize *size);
/* Binary PLY: one mesh, with the colour of its surface at each vertex. g_byte_array_unref. */
GByteArray *spore_ply_format(const SporeNamedSurface *surfaces, gsize count);
/* Binary STL: one mesh. g_byte_array_unref. */
GByteArray *spore_stl_format(const SporeNamedSurface *surfaces, gsize count);

#endif
