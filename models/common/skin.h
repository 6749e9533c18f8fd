/* The slot skin of a model whose first nodes are the vertices of a surface. */
#ifndef SPORE_MODELS_COMMON_SKIN_H
#define SPORE_MODELS_COMMON_SKIN_H

#include <assert.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/mesh/mesh.h"

static inline bool spore_surface_skin(const SporeTriangleMesh *mesh, uint32_t **triangles, size_t *count) {
  assert(mesh->triangle_count == 0 || mesh->triangles);
  *count = mesh->triangle_count;
  *triangles = SPORE_NEW_ARRAY(uint32_t, 3 * mesh->triangle_count);
  if (*triangles) memcpy(*triangles, mesh->triangles, 3 * mesh->triangle_count * sizeof **triangles);
  return *triangles != NULL;
}

#endif
