/* The elements of a tetrahedral mesh: their nodes, masses, rest shapes in lanes, and places in the model's matrix. */
#ifndef SPORE_MODELS_TETRAHEDRA_ELEMENTS_H
#define SPORE_MODELS_TETRAHEDRA_ELEMENTS_H

#include "core/mesh/mesh.h"
#include "core/body/region.h"
#include "models/tetrahedra/tetrahedra.h"

/* A mesh and the nodes of its elements: the vertices, and for quadratic elements (ten nodes) the middles of the edges
 * behind the vertices, in the order of spore_edges_of_tetrahedra. */
typedef struct SporeTetrahedronNodes {
  SporeTetrahedralMesh mesh;
  size_t count, per_element;   /* nodes; 4 or 10 */
  double *rest;                /* count x 3, m */
  uint32_t *nodes;             /* mesh.tetrahedron_count x per_element: corners, then middles as in tetrahedra.h */
  SporeRegionFactors *factors; /* mesh.tetrahedron_count; NULL: the body has no regions */
} SporeTetrahedronNodes;

/* Refuses no tetrahedra, coordinates that are no numbers, corners that do not exist, and elements without a volume. */
bool spore_tetrahedra_check_mesh(const SporeTetrahedralMesh *mesh, SporeError *error);
/* Copies the mesh, which has been checked. regions: NULL: none. False: no memory; to be cleared all the same. */
bool spore_tetrahedron_nodes_create(SporeTetrahedronNodes *nodes, const SporeTetrahedralMesh *mesh, bool middles,
                                    const SporeRegions *regions);
void spore_tetrahedron_nodes_clear(SporeTetrahedronNodes *nodes);
/* The same elements, each with nodes of its own: element t has the nodes per_element t and on. False: no memory; to be
 * cleared all the same. */
bool spore_tetrahedron_nodes_part(SporeTetrahedronNodes *apart, const SporeTetrahedronNodes *whole);
static inline SporeRegionFactors spore_tetrahedron_factors(const SporeTetrahedronNodes *nodes, size_t tetrahedron) {
  return nodes->factors ? nodes->factors[tetrahedron] : (SporeRegionFactors){1, 1};
}
/* masses += density times each element's volume and its factor: a quarter to each corner, or where there are middles
 * 1/36 to each corner and 4/27 to each middle (Hinton, Rock and Zienkiewicz 1976, "A note on mass lumping and related
 * processes in the finite element method"). */
void spore_tetrahedron_nodes_add_mass(const SporeTetrahedronNodes *nodes, double density, double *masses);
/* Pairs of nodes that an element joins. False: no memory. */
bool spore_tetrahedron_nodes_pattern(const SporeTetrahedronNodes *nodes, SporeBlockPattern *pattern);

/* False: no memory; to be cleared all the same. */
bool spore_tetrahedra_create(SporeTetrahedra *tetrahedra, const SporeTetrahedronNodes *nodes);
void spore_tetrahedra_clear(SporeTetrahedra *tetrahedra);
/* Looks up each element's blocks once, in a matrix of the pattern. */
void spore_tetrahedra_find_blocks(SporeTetrahedra *tetrahedra, const SporeBlockMatrix *matrix);

#endif
