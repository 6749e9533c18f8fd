/* The faces that bound cells of one label, and for each face the sample points of a surface that are nearest to it.
 * They give the distance of a mesh from its source surface where the mesh changes. */
#ifndef SPORE_GENERATE_COMMON_SKIN_H
#define SPORE_GENERATE_COMMON_SKIN_H

#include "core/generate/common/common.h"

#define SPORE_SKIN_SIDES 4 /* labels that meet at a vertex, at most: more are not distinguished */

typedef struct SporeSkin {
  size_t face_count;
  uint32_t *corners; /* face_count x 3, outward from sides[2 f] */
  uint32_t *sides;   /* face_count x 2: labels inside and across; 0: nothing */
  size_t *first;     /* vertex_count + 1: into faces */
  uint32_t *faces;   /* of each vertex */
  size_t *first_point;
  uint32_t *points; /* of each face: first_point[f] to first_point[f + 1] */
} SporeSkin;

/* Valid until the mesh's cells change. If the host face of a point is gone, the nearest face at the host's vertices
 * becomes its host. */
bool spore_skin_create(SporeSkin *skin, const SporeTetrahedralMesh *mesh, SporeSkinPoints *points, SporeError *error);
void spore_skin_clear(SporeSkin *skin);

/* The labels that meet at a vertex, or at the edge from it to `other` (UINT32_MAX: at the vertex), ascending.
 * Returns their number; if more than SPORE_SKIN_SIDES, one more than that. 0: the vertex or the edge lies inside. */
int spore_skin_sides(const SporeSkin *skin, uint32_t v, uint32_t other, uint32_t labels[SPORE_SKIN_SIDES]);

#endif
