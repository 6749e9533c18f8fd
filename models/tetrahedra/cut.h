/* Tetrahedra that scissors part while they run.
 *
 * A blade opens the faces between two tetrahedra whose middles lie on both sides of its way: the cut runs along faces,
 * no element changes its shape, so that none is ever worse than the mesh's own, and volume and mass stay what they are.
 * A tetrahedron keeps at least one neighbour: no crumbs come loose. Where the faces opened part the tetrahedra around a
 * node, so that one cannot go around from one to the other through faces that are closed, each part but the largest
 * gets a node of its own, made from a reserve, at the same place with the same velocity, and its tetrahedra's share of
 * the mass: momentum stays too. Where faces are open but the tetrahedra around a node hang together still, it is the
 * end of the cut. */
#ifndef SPORE_MODELS_TETRAHEDRA_CUT_H
#define SPORE_MODELS_TETRAHEDRA_CUT_H

#include "models/tetrahedra/elements.h"

typedef struct SporeTetrahedraCut {
  size_t count;                   /* of tetrahedra; 0: cannot be cut */
  size_t node_count, spare_count; /* of the whole mesh; that can be made */
  size_t made;                    /* so far */
  const uint32_t *whole;          /* tetrahedron x 4: its nodes in the whole mesh, borrowed */
  uint32_t *corner;               /* as whole: its nodes now */
  uint32_t *neighbour;            /* tetrahedron x 4: the one across the face against that corner */
  uint8_t *open;                  /* tetrahedron: bit k: the face against corner k is cut */
  uint32_t *fan_start, *fan;      /* node of the whole mesh: its tetrahedra */
  uint32_t *lane;                 /* tetrahedron: where it lies in the batches */
  uint32_t *from;                 /* spare_count: the node that it was made from */
  double *mass;                   /* tetrahedron: of each corner, kg */
  double *middle;                 /* tetrahedron x 3, scratch */
  uint32_t *part;                 /* longest fan, scratch */
  uint8_t *touched;               /* node of the whole mesh: a face there was opened since it was looked at */
  bool full;                      /* more nodes were needed than could be made */
} SporeTetrahedraCut;

/* For elements of four nodes, which are borrowed. False: no memory; to be cleared all the same. */
bool spore_tetrahedra_cut_create(SporeTetrahedraCut *cut, const SporeTetrahedronNodes *nodes,
                                 const SporeTetrahedra *tetrahedra, double density, size_t spare_count);
void spore_tetrahedra_cut_clear(SporeTetrahedraCut *cut);
/* Opens the faces that a blade goes through whose way is the triangle, 9 doubles, at q; returns their number. */
size_t spore_tetrahedra_cut_open(SporeTetrahedraCut *cut, const double *q, const double *triangle);
/* Makes nodes where tetrahedra were parted since; sets masses of all nodes concerned, and the new ones in q and v.
 * Returns how many: they follow one another. */
size_t spore_tetrahedra_cut_part(SporeTetrahedraCut *cut, SporeTetrahedra *tetrahedra, double *masses, double *q,
                                 double *v);
/* Whole again; of the masses those of nodes that are no spares. */
void spore_tetrahedra_cut_mend(SporeTetrahedraCut *cut, SporeTetrahedra *tetrahedra, double *masses);
bool spore_tetrahedra_cut_pattern(const SporeTetrahedraCut *cut, SporeBlockPattern *pattern);

#endif
