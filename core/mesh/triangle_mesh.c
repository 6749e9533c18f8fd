#include <assert.h>
#include <string.h>

#include "core/base/text.h"
#include "core/mesh/common.h"

bool spore_triangle_mesh_allocate(SporeTriangleMesh *mesh, size_t vertices, size_t triangles, SporeError *error) {
  *mesh = (SporeTriangleMesh){0};
  if (vertices > SPORE_MESH_MAXIMUM) return spore_mesh_too_large(error, vertices);
  if (triangles > SPORE_MESH_MAXIMUM) return spore_mesh_too_large(error, triangles);
  *mesh = (SporeTriangleMesh){vertices, triangles, SPORE_NEW_ARRAY(double, 3 * vertices),
                              SPORE_NEW_ARRAY(uint32_t, 3 * triangles)};
  if (mesh->vertices && mesh->triangles) return true;
  spore_triangle_mesh_clear(mesh);
  return spore_mesh_no_memory(error);
}

bool spore_triangle_mesh_copy(SporeTriangleMesh *to, const SporeTriangleMesh *from, SporeError *error) {
  assert(to != from);
  if (!spore_triangle_mesh_allocate(to, from->vertex_count, from->triangle_count, error)) return false;
  if (from->vertex_count) memcpy(to->vertices, from->vertices, 3 * from->vertex_count * sizeof(double));
  if (from->triangle_count) memcpy(to->triangles, from->triangles, 3 * from->triangle_count * sizeof(uint32_t));
  to->reoriented = from->reoriented;
  return true;
}

void spore_triangle_mesh_clear(SporeTriangleMesh *mesh) {
  spore_free(mesh->vertices);
  spore_free(mesh->triangles);
  *mesh = (SporeTriangleMesh){0};
}

bool spore_triangle_mesh_validate(const SporeTriangleMesh *mesh, SporeError *error) {
  if (mesh->vertex_count > SPORE_MESH_MAXIMUM) return spore_mesh_too_large(error, mesh->vertex_count);
  if (mesh->triangle_count > SPORE_MESH_MAXIMUM) return spore_mesh_too_large(error, mesh->triangle_count);
  if (!mesh->vertex_count || !mesh->triangle_count)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("the mesh has %zu vertices and %zu triangles; at least one triangle was expected; choose "
                             "a file that holds a surface"),
                           mesh->vertex_count, mesh->triangle_count);
  return spore_mesh_check_points(mesh->vertices, mesh->vertex_count, 3, _("vertex"), error) &&
         spore_mesh_check_indices(mesh->triangles, mesh->triangle_count, 3, mesh->vertex_count, _("triangle"), error);
}

void spore_triangle_mesh_normals(const double *vertices, size_t vertex_count, const uint32_t *triangles,
                                 size_t triangle_count, double *normals) {
  assert(triangle_count == 0 || (vertices && triangles));
  memset(normals, 0, 3 * vertex_count * sizeof *normals);
  for (size_t t = 0; t < triangle_count; t++) {
    const uint32_t *v = triangles + 3 * t;
    SporeVec3 area = spore_mesh_area_vector(spore_mesh_vertex(vertices, v[0]), spore_mesh_vertex(vertices, v[1]),
                                            spore_mesh_vertex(vertices, v[2]));
    for (int k = 0; k < 3; k++) spore_vec3_accumulate(normals + 3 * (size_t)v[k], area);
  }
  for (size_t i = 0; i < vertex_count; i++)
    spore_vec3_store(normals + 3 * i, spore_vec3_normalise(spore_vec3_load(normals + 3 * i), spore_vec3(0, 0, 1)));
}

double spore_triangle_mesh_share_area(const SporeTriangleMesh *mesh, double *areas) {
  assert(areas);
  double total = 0;
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    const uint32_t *n = mesh->triangles + 3 * t;
    double area = spore_vec3_length(spore_mesh_area_vector(spore_mesh_vertex(mesh->vertices, n[0]),
                                                           spore_mesh_vertex(mesh->vertices, n[1]),
                                                           spore_mesh_vertex(mesh->vertices, n[2])));
    for (int k = 0; k < 3; k++) areas[n[k]] += area / 3;
    total += area;
  }
  return total;
}
