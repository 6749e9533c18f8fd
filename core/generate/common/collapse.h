/* Edge collapses of a tetrahedral mesh. Each removes one vertex. */
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
  const SporeBvh *surface; /* the surface that the skin must be near, or NULL */
  double floor;            /* least quality of the changed cells */
  double limit;            /* largest distance of the skin from its points */
  const size_t *kept;      /* by label: the fewest cells of each; NULL: any number */
  size_t *left;            /* by label: cells there are */
  bool *touched;           /* cells around changed vertices: their stars are no longer valid */
  uint32_t *mark, *ring_mark, stamp;
  /* of the present edge */
  uint32_t dying[SPORE_COLLAPSE_CELLS], changed[2 * SPORE_COLLAPSE_CELLS], face[SPORE_COLLAPSE_FACES];
  size_t dying_count, changed_count, face_count;
  uint32_t host[SPORE_COLLAPSE_POINTS], best_host[SPORE_COLLAPSE_POINTS]; /* of the points of all its faces in turn */
} SporeCollapse;

bool spore_collapse_create(SporeCollapse *collapse, SporeError *error);
void spore_collapse_clear(SporeCollapse *collapse);

/* Collapses the edge a-b if the topology of the mesh and its labels is kept, cells stay above `floor`, and the skin
 * stays within `limit` of its points and of the surface. The vertex goes to an end or to the middle, wherever the skin
 * is nearest. A removed cell has UINT32_MAX as its first corner. False: nothing changed. */
bool spore_collapse_edge(SporeCollapse *collapse, uint32_t a, uint32_t b);

#endif
