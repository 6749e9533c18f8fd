/* Which nodes of a triangle mesh a net ties together. */
#ifndef SPORE_MODELS_NET_SPRING_PAIRS_H
#define SPORE_MODELS_NET_SPRING_PAIRS_H

#include "core/mesh/mesh.h"

/* Pairs of vertices, smaller << 32 | larger, ascending, none twice. Start from zero. */
typedef struct SporePairs {
  size_t count, capacity;
  uint64_t *keys;
} SporePairs;

/* False: no memory. Which pairs come out does not depend on the order of vertices or triangles. */
bool spore_pairs_structural(SporePairs *pairs, const SporeTriangleMesh *mesh); /* edges */
/* Corners opposite the common edge of two triangles, edges excepted. */
bool spore_pairs_shear(SporePairs *pairs, const SporeTriangleMesh *mesh, const SporePairs *structural);
/* Neighbours of a vertex that lie opposite each other, within 41 degrees of straight; pairs tied already excepted. */
bool spore_pairs_bending(SporePairs *pairs, const SporeTriangleMesh *mesh, const SporePairs *structural,
                         const SporePairs *shear);
void spore_pairs_clear(SporePairs *pairs);

#endif
