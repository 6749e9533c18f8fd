/* The vertices of a textured surface as files have them that give each vertex one place in its picture. */
#ifndef SPORE_IO_SURFACE_SPLIT_H
#define SPORE_IO_SURFACE_SPLIT_H

#include "core/io/surface_write.h"

/* A vertex of the mesh stands here once for each place in the picture that its corners have: several times on a seam.
 */
typedef struct SporeSurfaceSplit {
  gsize count;
  guint32 *vertices;  /* count: which vertex of the mesh each is */
  float *places;      /* count x 2; NULL: the surface has no picture, and each vertex of the mesh stands here once */
  guint32 *triangles; /* triangle_count x 3, in the order of the mesh */
} SporeSurfaceSplit;

/* spore_surface_split_clear. */
void spore_surface_split_init(SporeSurfaceSplit *split, const SporeNamedSurface *surface);
void spore_surface_split_clear(SporeSurfaceSplit *split);

#endif
