/* Openings and cavities of a surface: the faces that close its holes, and its parts that are oriented inward. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/tetrahedra/private.h"
#include "core/mesh/common.h"

#define APART 0.1 /* of the tolerance: a face nearer to the surface than this closes no hole */

static bool closes(const SporeTetrahedraWork *work, const SporeTriangleMesh *boundary, size_t triangle) {
  SporeVec3 middle = {0, 0, 0};
  for (size_t k = 0; k < 3; k++)
    middle = spore_vec3_add_scaled(middle, 1.0 / 3,
                                   spore_mesh_vertex(boundary->vertices, boundary->triangles[3 * triangle + k]));
  return spore_bvh_distance(work->tree, middle, NULL, NULL) > APART * work->options.tolerance &&
         fabs(spore_bvh_winding(work->tree, middle) - 0.5) < SPORE_TETRAHEDRA_CLOSING;
}

/* Joins the given surface and the faces of the boundary that close holes. The boundary's vertices follow the surface's
 * vertices. */
static bool join(SporeTetrahedraWork *work, const SporeTriangleMesh *boundary, SporeError *error) {
  const SporeTriangleMesh *surface = &work->surface;
  SporeTriangleMesh joined = {0};
  if (!spore_triangle_mesh_allocate(&joined, surface->vertex_count + boundary->vertex_count,
                                    surface->triangle_count + boundary->triangle_count, error))
    return false;
  memcpy(joined.vertices, surface->vertices, 3 * surface->vertex_count * sizeof(double));
  memcpy(joined.vertices + 3 * surface->vertex_count, boundary->vertices, 3 * boundary->vertex_count * sizeof(double));
  memcpy(joined.triangles, surface->triangles, 3 * surface->triangle_count * sizeof(uint32_t));
  joined.triangle_count = surface->triangle_count;
  for (size_t t = 0; t < boundary->triangle_count; t++) {
    if (!closes(work, boundary, t)) continue;
    for (size_t k = 0; k < 3; k++)
      joined.triangles[3 * joined.triangle_count + k] =
          boundary->triangles[3 * t + k] + (uint32_t)surface->vertex_count;
    joined.triangle_count++;
  }
  work->closed = spore_bvh_create(&joined, error);
  spore_triangle_mesh_clear(&joined);
  return work->closed != NULL;
}

bool spore_tetrahedra_close(SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh, SporeError *error) {
  SporeTriangleMesh boundary = {.vertex_count = mesh->vertex_count, .vertices = mesh->vertices};
  if (!work->open) return true;
  bool done = (spore_tetrahedral_mesh_boundary(mesh, &boundary.triangles, &boundary.triangle_count) ||
               spore_mesh_no_memory(error)) &&
              join(work, &boundary, error);
  spore_free(boundary.triangles);
  return done;
}

#define LEAST_WELD 1e-12 /* of the diagonal */

/* The root of i: the smallest vertex known so far to be connected to i (union-find). */
static uint32_t root_of(uint32_t *joined, uint32_t i) {
  while (joined[i] != i) i = joined[i] = joined[joined[i]];
  return i;
}

bool spore_tetrahedra_fill(SporeTriangleMesh *surface, uint32_t *tags, double *filled, SporeError *error) {
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
    if (tags) tags[kept] = tags[t];
    kept++;
  }
  if (done && kept && kept < surface->triangle_count) {
    surface->triangle_count = kept;
    done = spore_triangle_mesh_weld_tagged(surface, LEAST_WELD, tags, error); /* drops vertices without triangles */
  }
  spore_free(joined);
  spore_free(volume);
  return done;
}
