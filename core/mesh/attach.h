/* Attaches each vertex of a surface to a place of the curve inside of it. */
#ifndef SPORE_MESH_ATTACH_H
#define SPORE_MESH_ATTACH_H

#include "core/mesh/mesh.h"

/* place: for each vertex the point of the curve (as close to each other as places are to be told apart) that is nearest
 * for how thick the curve is there, of least distance^2 - radius^2. Where loops of the curve come near each other that
 * is not always its own loop: what its edges tear from the largest part of its piece of the surface takes, from
 * neighbour to neighbour, the nearest place downhill. *torn: share of the edges, at last, whose ends go with places
 * farther apart along the curve than four times their distance from it and twice the edge. False: no memory. */
bool spore_curve_attach(const SporeCurve *curve, const SporeTriangleMesh *mesh, uint32_t *place, double *torn);

#endif
