/* Edges of a tetrahedral mesh are drawn together, one vertex less each. */
#ifndef SPORE_GENERATE_COMMON_COLLAPSE_H
#define SPORE_GENERATE_COMMON_COLLAPSE_H

#include "core/generate/common/skin.h"
#include "core/generate/common/stars.h"

#define SPORE_COLLAPSE_CELLS 160 /* around a vertex, at most */
#define SPORE_COLLAPSE_FACES 128
#define SPORE_COLLAPSE_POINTS 4096

typedef struct SporeCollapse {
  SporeStars *stars;
  SporeSkin *skin;
  SporeSkinPoints *points;
  const SporeBvh *surface; /* that the skin is to be near, or NULL */
  double floor;            /* least quality that cells may come to */
  double limit;            /* by which the skin may be off its points */
  bool *touched;           /* cells around vertices that changed: their stars are no longer what they were */
  uint32_t *mark, *ring_mark, stamp;
  /* of the edge in hand */
  uint32_t dying[SPORE_COLLAPSE_CELLS], changed[2 * SPORE_COLLAPSE_CELLS], face[SPORE_COLLAPSE_FACES];
  size_t dying_count, changed_count, face_count;
  uint32_t host[SPORE_COLLAPSE_POINTS], best_host[SPORE_COLLAPSE_POINTS]; /* of the points of all its faces in turn */
} SporeCollapse;

bool spore_collapse_create(SporeCollapse *collapse, SporeError *error);
void spore_collapse_clear(SporeCollapse *collapse);

/* Draws the edge a-b together where that keeps what the mesh and its labels hang together like, cells above `floor` and
 * the skin within `limit` of its points and of the surface: at the end, or on the way between them, at which it is
 * nearest. A cell that goes has UINT32_MAX as its first corner. False: nothing changed. */
bool spore_collapse_edge(SporeCollapse *collapse, uint32_t a, uint32_t b);

#endif
