/* Points that follow the vertices of a tetrahedral mesh. */
#ifndef SPORE_MODELS_TETRAHEDRA_MAP_H
#define SPORE_MODELS_TETRAHEDRA_MAP_H

#include "core/mesh/mesh.h"
#include "core/body/mapping.h"
#include "models/tetrahedra/elements.h"

/* Rows of the inverse of [b-a, c-a, d-a]: the gradients of the weights of corners 1, 2, 3 (1/m). Returns six times the
 * volume, m^3; the gradients are finite only where that is not 0. */
double spore_tetrahedron_gradients(const double *vertices, const uint32_t corners[4], SporeVec3 gradient[3]);

/* A point follows the nodes of the tetrahedron that holds it by their shape functions. A point outside follows the
 * tetrahedron at the nearest point of the boundary, extended affinely from there. Nodes in their order make an identity
 * mapping. */
bool spore_tetrahedra_map(const SporeTetrahedronNodes *nodes, const double *points, size_t count,
                          const SporeCancel *cancel, SporeMapping *mapping, SporeError *error);

#endif
