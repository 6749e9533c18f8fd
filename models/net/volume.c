#include "models/net/volume.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/math/vector.h"

bool spore_volume_create(SporeVolume *volume, const SporeTriangleMesh *mesh) {
  assert(mesh->triangle_count > 0);
  *volume = (SporeVolume){.mesh = mesh};
  volume->blocks = SPORE_NEW_ARRAY(uint32_t, 6 * mesh->triangle_count);
  volume->gradient = SPORE_NEW_ARRAY(double, 3 * mesh->vertex_count);
  if (!volume->blocks || !volume->gradient) return false;
  volume->rest = spore_volume_at(volume, mesh->vertices);
  return true;
}

void spore_volume_clear(SporeVolume *volume) {
  spore_free(volume->blocks);
  spore_free(volume->gradient);
  *volume = (SporeVolume){0};
}

bool spore_volume_pattern(const SporeVolume *volume, SporeBlockPattern *pattern) {
  const SporeTriangleMesh *mesh = volume->mesh;
  pattern->direction = true;
  for (size_t h = 0; h < 3 * mesh->triangle_count; h++)
    if (!spore_block_pattern_add(pattern, mesh->triangles[h], mesh->triangles[h - h % 3 + (h + 1) % 3])) return false;
  return true;
}

void spore_volume_find_blocks(SporeVolume *volume, const SporeBlockMatrix *matrix) {
  assert(matrix->block_count >= volume->mesh->vertex_count);
  const SporeTriangleMesh *mesh = volume->mesh;
  for (size_t h = 0; h < 3 * mesh->triangle_count; h++) {
    uint32_t a = mesh->triangles[h], b = mesh->triangles[h - h % 3 + (h + 1) % 3];
    volume->blocks[2 * h] = (uint32_t)spore_block_matrix_find(matrix, a, b);
    volume->blocks[2 * h + 1] = (uint32_t)spore_block_matrix_find(matrix, b, a);
  }
}

/* Corners of a triangle, from the first vertex, so that no digits are lost far from the origin. */
static void corners_at(const SporeVolume *volume, const double *q, size_t t, SporeVec3 corner[3]) {
  assert(t < volume->mesh->triangle_count);
  SporeVec3 origin = spore_vec3_load(q);
  for (size_t k = 0; k < 3; k++)
    corner[k] = spore_vec3_sub(spore_vec3_load(q + 3 * (size_t)volume->mesh->triangles[3 * t + k]), origin);
}

double spore_volume_at(const SporeVolume *volume, const double *q) {
  double sum = 0;
  for (size_t t = 0; t < volume->mesh->triangle_count; t++) {
    SporeVec3 corner[3];
    corners_at(volume, q, t, corner);
    sum += spore_vec3_dot(corner[0], spore_vec3_cross(corner[1], corner[2]));
  }
  return sum / 6;
}

static double pressure(const SporeVolume *volume, double at) {
  assert(volume->rest != 0);
  return -volume->stiffness * (at - volume->rest) / fabs(volume->rest);
}

/* The volume, and 6 dV/dq into the scratch: twice each triangle's area along its normal, to each of its corners. */
static double find_gradient(const SporeVolume *volume, const double *q) {
  double sum = 0;
  memset(volume->gradient, 0, 3 * volume->mesh->vertex_count * sizeof(double));
  for (size_t t = 0; t < volume->mesh->triangle_count; t++) {
    SporeVec3 corner[3];
    corners_at(volume, q, t, corner);
    SporeVec3 area = spore_vec3_cross(spore_vec3_sub(corner[1], corner[0]), spore_vec3_sub(corner[2], corner[0]));
    sum += spore_vec3_dot(corner[0], area);
    for (size_t k = 0; k < 3; k++)
      spore_vec3_accumulate(volume->gradient + 3 * (size_t)volume->mesh->triangles[3 * t + k], area);
  }
  return sum / 6;
}

void spore_volume_force(const SporeVolume *volume, const double *q, double *f) {
  assert(f != q);
  if (!(volume->stiffness > 0)) return;
  double push = pressure(volume, find_gradient(volume, q)) / 6;
  spore_vector_add_scaled(3 * volume->mesh->vertex_count, f, push, volume->gradient);
}

double spore_volume_potential(const SporeVolume *volume, const double *q) {
  if (!(volume->stiffness > 0)) return 0;
  double change = spore_volume_at(volume, q) - volume->rest;
  return 0.5 * volume->stiffness * change * change / fabs(volume->rest);
}

/* V changes with a and b along c: d2V / da db = -[c]x / 6 of each triangle (a, b, c). */
static void add_curvature(const SporeVolume *volume, const double *q, double scale, SporeBlockMatrix *matrix) {
  for (size_t t = 0; t < volume->mesh->triangle_count; t++) {
    SporeVec3 corner[3];
    corners_at(volume, q, t, corner);
    for (size_t k = 0; k < 3; k++) {
      SporeMat3 skew = spore_mat3_scale(scale / 6, spore_mat3_skew(corner[(k + 2) % 3]));
      double *there = matrix->values + 9 * (size_t)volume->blocks[6 * t + 2 * k];
      double *back = matrix->values + 9 * (size_t)volume->blocks[6 * t + 2 * k + 1];
      for (int e = 0; e < 9; e++) there[e] -= skew.m[e], back[e] += skew.m[e];
    }
  }
}

void spore_volume_jacobian(const SporeVolume *volume, const SporeTangent *at, SporeBlockMatrix *matrix) {
  assert(matrix->direction);
  assert(matrix->block_count >= volume->mesh->vertex_count);
  if (!(volume->stiffness > 0) || !(at->stiffness_scale > 0)) return;
  size_t count = 3 * volume->mesh->vertex_count;
  double at_q = find_gradient(volume, at->q);
  double scale = sqrt(at->stiffness_scale * volume->stiffness / fabs(volume->rest)) / 6;
  memset(matrix->direction, 0, 3 * matrix->block_count * sizeof *matrix->direction);
  spore_vector_add_scaled(count, matrix->direction, scale, volume->gradient);
  matrix->directed = true;
  if (at->whole) add_curvature(volume, at->q, -at->stiffness_scale * pressure(volume, at_q), matrix);
}
