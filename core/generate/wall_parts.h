/* The parts of making walls. */
#ifndef SPORE_GENERATE_WALL_PARTS_H
#define SPORE_GENERATE_WALL_PARTS_H

#include "core/mesh/bvh.h"

/* Moves the vertices of an inner surface so that its triangles, and not they alone, lie `thickness` below the outer one
 * (m): onto the edges that it has below concave ridges of that, as in dual contouring (Ju, Losasso, Schaefer and Warren
 * 2002). No triangle turns over, and none goes through another. step (m): of the lattice that it was found in. False:
 * no memory. */
bool spore_wall_fit(const SporeBvh *bvh, double thickness, double step, SporeTriangleMesh *inner);

#endif
