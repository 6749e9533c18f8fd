#include "core/mesh/common.h"
#include "core/mesh/half_edges.h"

bool spore_tetrahedral_mesh_pieces(const SporeTetrahedralMesh *mesh, uint32_t **pieces, size_t *count,
                                   SporeError *error) {
  uint32_t *parent = SPORE_NEW_ARRAY(uint32_t, mesh->vertex_count);
  uint32_t *number = SPORE_NEW_ARRAY(uint32_t, mesh->vertex_count); /* of a set's root, + 1 */
  *pieces = parent && number ? SPORE_NEW_ARRAY(uint32_t, mesh->tetrahedron_count) : NULL;
  *count = 0;
  if (*pieces) {
    for (size_t v = 0; v < mesh->vertex_count; v++) parent[v] = (uint32_t)v;
    for (size_t i = 0; i < 4 * mesh->tetrahedron_count; i++)
      spore_set_join(parent, mesh->tetrahedra[i - i % 4], mesh->tetrahedra[i]);
    for (size_t t = 0; t < mesh->tetrahedron_count; t++) {
      uint32_t root = spore_set_find(parent, mesh->tetrahedra[4 * t]);
      if (!number[root]) number[root] = (uint32_t)++ * count;
      (*pieces)[t] = number[root] - 1;
    }
  }
  spore_free(parent);
  spore_free(number);
  return *pieces || spore_mesh_no_memory(error);
}
