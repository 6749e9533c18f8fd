/* Depths in a surface at very many places that lie close together. */
#ifndef SPORE_MESH_DEPTH_CELLS_H
#define SPORE_MESH_DEPTH_CELLS_H

#include "core/mesh/bvh.h"

/* Cubes of space with the triangles that can be nearest to a place in them; opaque. A cube is filled when the second
 * place in it is asked about. */
typedef struct SporeDepthCells SporeDepthCells;

/* side: m, of a cube, above 0; an eighth to a quarter of the depths asked about is quick. The hierarchy must outlive
 * the cells. NULL: no memory. */
SporeDepthCells *spore_depth_cells_create(const SporeBvh *bvh, double side);
/* Frees the cells; NULL is allowed. */
void spore_depth_cells_free(SporeDepthCells *cells);
/* The same depth as spore_bvh_depth_beside gives, to the bit, whatever was asked before. Where memory ends, or too many
 * triangles are near, the hierarchy is asked. Changes the cells: one thread at a time. */
SporeBvhKnown spore_depth_cells_beside(SporeDepthCells *cells, SporeVec3 p, const SporeBvhKnown *known);

#endif
