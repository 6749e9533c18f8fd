#include "core/mesh/common.h"

#include <assert.h>
#include <math.h>

#include "core/base/text.h"

bool spore_mesh_no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL,
                         _("there is not enough memory for this mesh; close other programs or use a coarser mesh"));
}

bool spore_mesh_too_large(SporeError *error, size_t count) {
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("%zu elements are too many; at most %u were expected; use a coarser mesh"), count,
                         SPORE_MESH_MAXIMUM);
}

bool spore_mesh_check_points(const double *points, size_t count, size_t stride, const char *noun, SporeError *error) {
  for (size_t i = 0; i < count; i++)
    for (size_t k = 0; k < 3; k++)
      if (!(fabs(points[stride * i + k]) <= SPORE_MESH_COORDINATE_MAXIMUM))
        return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                               _("%s %zu has the coordinate %g; a finite number within %g m was expected; repair the "
                                 "file or choose another unit"),
                               noun, i, points[stride * i + k], SPORE_MESH_COORDINATE_MAXIMUM);
  return true;
}

bool spore_mesh_check_indices(const uint32_t *indices, size_t count, size_t corners, size_t vertex_count,
                              const char *noun, SporeError *error) {
  assert(corners > 0);
  for (size_t i = 0; i < count * corners; i++)
    if (indices[i] >= vertex_count)
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("%s %zu uses vertex %u, but there are only %zu vertices; an index from 0 to %zu was "
                               "expected; export the mesh again"),
                             noun, i / corners, indices[i], vertex_count, vertex_count ? vertex_count - 1 : 0);
  return true;
}

double spore_mesh_bounds(const double *points, size_t count, size_t stride, double lower[3], double upper[3]) {
  assert(count > 0 && stride >= 3);
  for (int k = 0; k < 3; k++) lower[k] = upper[k] = points[k];
  for (size_t i = 1; i < count; i++)
    for (size_t k = 0; k < 3; k++) {
      lower[k] = fmin(lower[k], points[stride * i + k]);
      upper[k] = fmax(upper[k], points[stride * i + k]);
    }
  return spore_vec3_distance(spore_vec3_load(lower), spore_vec3_load(upper));
}

double spore_mesh_diagonal(const double *points, size_t count, size_t stride) {
  double lower[3], upper[3];
  return spore_mesh_bounds(points, count, stride, lower, upper);
}
