/* Tetrahedra that scissors cut while they run.
 *
 * A blade opens the faces between two tetrahedra whose middles lie on both sides of its way. The cut runs along faces,
 * and no element changes its shape: no element is ever worse than in the mesh, and volume and mass stay. A tetrahedron
 * keeps at least one neighbour, so that no loose tetrahedra arise. Open faces may divide the tetrahedra around a node
 * into parts that no longer hang together through closed faces. Each part but the largest then gets a node of its own
 * from a reserve, with the same place and velocity, and with the share of the mass of its tetrahedra: momentum stays
 * too. Where the tetrahedra around a node still hang together, the node is at the end of the cut and stays one. */
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
/* Splits nodes where tetrahedra were divided since the last call; sets the masses of all nodes concerned, and the new
 * nodes in q and v. Returns how many nodes were made; they follow one another. */
size_t spore_tetrahedra_cut_part(SporeTetrahedraCut *cut, SporeTetrahedra *tetrahedra, double *masses, double *q,
                                 double *v);
/* Undoes all cuts; sets the masses of the nodes that are not spares. */
void spore_tetrahedra_cut_mend(SporeTetrahedraCut *cut, SporeTetrahedra *tetrahedra, double *masses);
bool spore_tetrahedra_cut_pattern(const SporeTetrahedraCut *cut, SporeBlockPattern *pattern);

#endif
