/* Textures: a picture that a body's visual unit lays over its mesh, and the places of the picture at the corners of the
 * mesh's triangles. Read and checked here; decoded where pictures are drawn. */
#ifndef SPORE_SCENE_TEXTURE_H
#define SPORE_SCENE_TEXTURE_H

#include "core/mesh/mesh.h"
#include "core/scene/document.h"

#define SPORE_TEXTURE_SIDE_MAXIMUM 8192               /* pixels */
#define SPORE_TEXTURE_BYTES_MAXIMUM ((gsize)64 << 20) /* of its file */

/* Width and height in pixels, 1 to SPORE_TEXTURE_SIDE_MAXIMUM, that a PNG says at its beginning; its pixels are not
 * decoded. place begins the message. FALSE with a GError: no PNG, one that is too large, or one that is cut off. */
gboolean spore_texture_size(const char *place, GBytes *content, int *width, int *height, GError **error);

/* Places in the picture, count x 2 floats from its upper left corner (0 0) to its lower right one (1 1), as a file:
 * a line spore-places 1, then u and v of a corner a line, three lines a triangle in the order of the mesh. g_free. */
char *spore_texture_places_format(const float *places, gsize count, gsize *size);
/* Reads such a file for `count` corners. Finite numbers up to 1e6. spore_free; NULL with a GError that names the line.
 */
float *spore_texture_places_parse(const char *place, const char *text, gsize size, gsize count, GError **error);

/* A body's texture. */
typedef struct SporeTexture {
  GBytes *picture; /* content of the PNG, of an allowed size */
  float *places;   /* triangle_count x 3 x 2 of the mesh that the visual unit names */
} SporeTexture;
/* The texture of a visual unit. FALSE without an error: it has none; with one: its files are missing or wrong, or do
 * not fit the mesh. *texture: spore_texture_clear. */
gboolean spore_texture_read(SporeDocument *document, const SporeObject *visual, SporeTexture *texture, GError **error);
void spore_texture_clear(SporeTexture *texture);

/* Places for another form of a mesh: welded, turned, decimated, or a part of it. Each corner of `to` has the place of
 * the nearest point of `from`; corners of one triangle are taken from its own side of a seam. from_places:
 * from->triangle_count x 3 x 2; result: to->triangle_count x 3 x 2, spore_free. NULL: no memory. */
float *spore_texture_places_transfer(const SporeTriangleMesh *from, const float *from_places,
                                     const SporeTriangleMesh *to, SporeError *error);

#endif
