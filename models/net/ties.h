/* What is removed from a net together when it is cut or tears.
 *
 * The net hangs together by the edges of its triangles. A triangle that lost an edge is removed. An edge whose
 * triangles are all removed is removed too. A shear or bending spring is removed when no node is left that edges tie to
 * both of its ends. So no spring holds together what the drawn surface shows as parted. */
#ifndef SPORE_MODELS_NET_TIES_H
#define SPORE_MODELS_NET_TIES_H

#include "models/net/springs.h"

enum { SPORE_NET_EDGES, SPORE_NET_SHEAR, SPORE_NET_BENDING, SPORE_NET_KINDS };

typedef struct SporeNetStrained {
  uint32_t a, b; /* an edge that is strained too much, or that lies under a shear spring that is */
  double strain;
} SporeNetStrained;

typedef struct SporeNetTies {
  SporeSprings *springs;         /* SPORE_NET_KINDS, borrowed */
  const SporeTriangleMesh *mesh; /* borrowed */
  SporeSpringsWhole whole[SPORE_NET_KINDS];
  uint32_t *left; /* slot x lane of edges, at the lower node: triangles that it has left */
  bool *gone;     /* triangle */
  bool *frayed;   /* node: a triangle at it is gone */
  bool *lost;     /* node: scratch of an operation: it lost an edge */
  /* Scratch of a tear. */
  size_t strained_count;
  SporeNetStrained *strained; /* room for all edges and shear springs */
  uint32_t *most;             /* node: of those at it the one strained most, from 1 */
} SporeNetTies;

/* False: no memory; clear them then. */
bool spore_net_ties_create(SporeNetTies *ties, SporeSprings *springs, const SporeTriangleMesh *mesh);
void spore_net_ties_clear(SporeNetTies *ties);
/* All as created. */
void spore_net_ties_mend(SporeNetTies *ties);

/* Cuts what crosses the triangle at q. Adds the edges that went to `cuts`, as of `body`; returns how many springs did.
 */
size_t spore_net_ties_cut(SporeNetTies *ties, const double *q, const SporeVec3 triangle[3], uint32_t body,
                          SporeCuts *cuts);
/* Tears the net at q, where edges or shear springs are longer than at rest by more than this part of their length: at
 * each end of a tear the edge of the greatest strain, or, where no tear grows, the edge of the greatest strain of the
 * whole net. */
size_t spore_net_ties_tear(SporeNetTies *ties, const double *q, double strain, uint32_t body, SporeCuts *cuts);
SporeTie spore_net_ties_between(const SporeNetTies *ties, uint32_t a, uint32_t b);

/* For the two functions above. The first removes an edge; the second, called when all such edges are removed, removes
 * what goes with them. Both return how many springs were removed. */
size_t spore_net_ties_part(SporeNetTies *ties, uint32_t a, uint32_t b, uint32_t body, SporeCuts *cuts);
size_t spore_net_ties_settle(SporeNetTies *ties, uint32_t body, SporeCuts *cuts);

#endif
