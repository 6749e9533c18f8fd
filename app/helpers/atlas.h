/* One picture (PNG) of several, and of plain colours, for a mesh of several materials: each has a cell of it. Libc,
 * libm, libpng and, where there is one, libjpeg alone. */
#ifndef SPORE_HELPERS_ATLAS_H
#define SPORE_HELPERS_ATLAS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Pixels at most, so that the file stays below SPORE_TEXTURE_BYTES_MAXIMUM whatever the pictures show, and a side. */
#define SPORE_ATLAS_PIXELS_MAXIMUM 22000000
#define SPORE_ATLAS_SIDE_MAXIMUM 8192

/* A picture, PNG or JPEG. */
typedef struct SporeAtlasPicture {
  const void *content;
  size_t size;
  bool lost;        /* out: it cannot be decoded, or is too large; its looks are plain colours */
  bool smaller;     /* out: it was halved, once or more, to fit */
  int64_t sides[2]; /* for the work alone, as halvings */
  int halvings;
} SporeAtlasPicture;

/* What some of the triangles wear. */
typedef struct SporeAtlasLook {
  size_t picture;             /* number of the picture, from 1; 0: none */
  float colour[3];            /* sRGB, 0 to 1; what the picture is multiplied by (in light), or shown alone */
  double low[2], high[2];     /* the places used, from the upper left corner; the picture repeats beyond 0 to 1 */
  double scale[2], offset[2]; /* out: a place in the atlas is that of the picture times scale, and offset */
} SporeAtlasLook;

/* *png: malloc'ed. Cells have margins in which the picture goes on, and lie on a grid, so that the picture may be drawn
 * at up to a 32th of its size before cells mix. False: there are too many looks, or there is no memory. */
bool spore_atlas_make(SporeAtlasPicture *pictures, size_t picture_count, SporeAtlasLook *looks, size_t look_count,
                      void **png, size_t *png_size);

#endif
