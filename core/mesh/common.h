/* What the files of this room share. */
#ifndef SPORE_MESH_COMMON_H
#define SPORE_MESH_COMMON_H

#include "core/base/memory.h"
#include "core/mesh/mesh.h"

#define SPORE_MESH_COORDINATE_MAXIMUM 1e9 /* m */
#define SPORE_MESH_FLAT 1e-12             /* of the squared longest side: a triangle of no more area is degenerate */

/* Both fill *error and return false. */
bool spore_mesh_no_memory(SporeError *error);
bool spore_mesh_too_large(SporeError *error, size_t count);

/* Finite and within SPORE_MESH_COORDINATE_MAXIMUM, `stride` doubles apart. */
bool spore_mesh_check_points(const double *points, size_t count, size_t stride, const char *noun, SporeError *error);
/* `corners` indices an element, each below vertex_count. */
bool spore_mesh_check_indices(const uint32_t *indices, size_t count, size_t corners, size_t vertex_count,
                              const char *noun, SporeError *error);

/* Axis-aligned bounds of points, `stride` doubles apart; returns the length of the diagonal. count > 0. */
double spore_mesh_bounds(const double *points, size_t count, size_t stride, double lower[3], double upper[3]);
/* That length alone. */
double spore_mesh_diagonal(const double *points, size_t count, size_t stride);

static inline SporeVec3 spore_mesh_vertex(const double *vertices, uint32_t index) {
  return spore_vec3_load(vertices + 3 * (size_t)index);
}

/* Half of the cross product of two sides: normal with the length of the area. */
static inline SporeVec3 spore_mesh_area_vector(SporeVec3 a, SporeVec3 b, SporeVec3 c) {
  return spore_vec3_scale(0.5, spore_vec3_cross(spore_vec3_sub(b, a), spore_vec3_sub(c, a)));
}

#endif
