/* What of a net goes together when it is cut or tears.
 *
 * Edges of its triangles carry it. A triangle that lost an edge is gone; an edge whose triangles are all gone goes too;
 * and a shear or bending spring goes when there is no node left that edges tie to both of its ends. So no spring holds
 * what is not seen to hang together. */
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
/* Tears, at q, where edges or shear springs are longer by more than this part of their length at rest: what is strained
 * most at each end of a tear, or, where none grows, of the whole net. */
size_t spore_net_ties_tear(SporeNetTies *ties, const double *q, double strain, uint32_t body, SporeCuts *cuts);
SporeTie spore_net_ties_between(const SporeNetTies *ties, uint32_t a, uint32_t b);

/* For the two above: takes an edge away; and, when all are, what goes with them. How many springs. */
size_t spore_net_ties_part(SporeNetTies *ties, uint32_t a, uint32_t b, uint32_t body, SporeCuts *cuts);
size_t spore_net_ties_settle(SporeNetTies *ties, uint32_t body, SporeCuts *cuts);

#endif
