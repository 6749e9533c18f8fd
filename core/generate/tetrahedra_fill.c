/* Cavities of a sound surface: its parts that are turned inside out. */
#include <math.h>

#include "core/base/memory.h"
#include "core/generate/tetrahedra_parts.h"
#include "core/mesh/common.h"

#define LEAST_WELD 1e-12 /* of the diagonal */

/* The smallest vertex that is known to be joined to i. */
static uint32_t root_of(uint32_t *joined, uint32_t i) {
  while (joined[i] != i) i = joined[i] = joined[joined[i]];
  return i;
}

bool spore_tetrahedra_fill(SporeTriangleMesh *surface, double *filled, SporeError *error) {
  uint32_t *joined = SPORE_NEW_ARRAY(uint32_t, surface->vertex_count);
  double *volume = SPORE_NEW_ARRAY(double, surface->vertex_count);
  bool done = (joined && volume) || spore_mesh_no_memory(error);
  for (size_t i = 0; done && i < surface->vertex_count; i++) joined[i] = (uint32_t)i;
  for (size_t i = 0; done && i < 3 * surface->triangle_count; i++) {
    uint32_t a = root_of(joined, surface->triangles[i]), b = root_of(joined, surface->triangles[i / 3 * 3]);
    joined[a > b ? a : b] = a > b ? b : a;
  }
  for (size_t t = 0; done && t < surface->triangle_count; t++) {
    const uint32_t *corner = surface->triangles + 3 * t;
    volume[root_of(joined, corner[0])] +=
        spore_vec3_dot(spore_mesh_vertex(surface->vertices, corner[0]),
                       spore_vec3_cross(spore_mesh_vertex(surface->vertices, corner[1]),
                                        spore_mesh_vertex(surface->vertices, corner[2])));
  }
  size_t kept = 0;
  *filled = 0;
  for (size_t i = 0; done && i < surface->vertex_count; i++) *filled -= fmin(volume[i], 0) / 6;
  for (size_t t = 0; done && t < surface->triangle_count; t++) {
    const uint32_t *corner = surface->triangles + 3 * t;
    if (volume[root_of(joined, corner[0])] < 0) continue;
    for (int k = 0; k < 3; k++) surface->triangles[3 * kept + (size_t)k] = corner[k];
    kept++;
  }
  if (done && kept && kept < surface->triangle_count) {
    surface->triangle_count = kept;
    done = spore_triangle_mesh_weld(surface, LEAST_WELD, error); /* drops vertices without triangles */
  }
  spore_free(joined);
  spore_free(volume);
  return done;
}
