/* A body-centred cubic lattice: two cubic lattices, each with its nodes at the centres of the other's cubes. */
#ifndef SPORE_GENERATE_TETRAHEDRA_LATTICE_H
#define SPORE_GENERATE_TETRAHEDRA_LATTICE_H

#include "core/generate/tetrahedra/private.h"

#define SPORE_BCC_NEIGHBOURS 14 /* of a node: 6 along the axes, 8 along the diagonals */

/* A node's place in half edges: all even or all odd. Layer z holds columns x rows nodes, of the parity of z. */
typedef struct SporeBccNode {
  int32_t x, y, z;
} SporeBccNode;

/* Where the surface cuts an edge that starts at a node inside. */
typedef struct SporeBccCut {
  uint64_t key; /* node x SPORE_BCC_NEIGHBOURS + neighbour + 1; 0: free */
  double share; /* of the edge, from the node inside */
  uint32_t vertex;
} SporeBccCut;

typedef struct SporeBcc {
  double edge, lower[3], filled; /* filled: volume of cavities */
  size_t columns, rows, layers;
  int8_t *value;    /* of a node: 1 inside, -1 outside, 0 on the surface */
  uint32_t *moved;  /* of a node: its index in `places` plus 1; 0: not moved */
  uint32_t *vertex; /* of a node: its vertex of the mesh plus 1; 0: none */
  double *places;   /* place_count x 3 */
  size_t place_count, place_room;
  SporeBccCut *cuts; /* open addressing; room is a power of two */
  size_t cut_count, cut_room;
} SporeBcc;

/* The 14 steps from a node to its neighbours: the first six along the axes. */
extern const int8_t spore_bcc_steps[SPORE_BCC_NEIGHBOURS][3];

/* Makes the lattice around the solid, classifies its nodes, and moves nodes near the surface onto it (see voxels.c).
 * False: no memory, too many nodes, cancelled; *lattice is cleared. */
bool spore_bcc_create(SporeBcc *lattice, const SporeTetrahedraWork *work, double edge, SporeError *error);
void spore_bcc_clear(SporeBcc *lattice);

static inline size_t spore_bcc_index(const SporeBcc *lattice, SporeBccNode node) {
  return ((size_t)node.z * lattice->rows + (size_t)(node.y >> 1)) * lattice->columns + (size_t)(node.x >> 1);
}
static inline bool spore_bcc_has(const SporeBcc *lattice, SporeBccNode node) {
  return node.x >= 0 && node.y >= 0 && node.z >= 0 && (size_t)(node.x >> 1) < lattice->columns &&
         (size_t)(node.y >> 1) < lattice->rows && (size_t)node.z < lattice->layers;
}
static inline SporeBccNode spore_bcc_neighbour(SporeBccNode node, int n) {
  const int8_t *step = spore_bcc_steps[n];
  return (SporeBccNode){node.x + step[0], node.y + step[1], node.z + step[2]};
}
SporeVec3 spore_bcc_place(const SporeBcc *lattice, SporeBccNode node);
/* The cut of the edge from a node inside to a neighbour; NULL: no memory. */
SporeBccCut *spore_bcc_cut(SporeBcc *lattice, const SporeTetrahedraWork *work, SporeBccNode inside, int neighbour);

#endif
