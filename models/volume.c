#include "models/volume.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"

bool spore_volume_create(SporeVolume *volume, const SporeTriangleMesh *mesh) {
  *volume = (SporeVolume){.mesh = mesh};
  volume->rest = spore_volume_at(volume, mesh->vertices);
  volume->blocks = SPORE_NEW_ARRAY(uint32_t, 6 * mesh->triangle_count);
  return volume->blocks != NULL;
}

void spore_volume_clear(SporeVolume *volume) {
  spore_free(volume->blocks);
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
  const SporeTriangleMesh *mesh = volume->mesh;
  for (size_t h = 0; h < 3 * mesh->triangle_count; h++) {
    uint32_t a = mesh->triangles[h], b = mesh->triangles[h - h % 3 + (h + 1) % 3];
    volume->blocks[2 * h] = (uint32_t)spore_block_matrix_find(matrix, a, b);
    volume->blocks[2 * h + 1] = (uint32_t)spore_block_matrix_find(matrix, b, a);
  }
}

/* Corners of a triangle, from the first vertex, so that no digits are lost far from the origin. */
static void corners_at(const SporeVolume *volume, const double *q, size_t t, SporeVec3 corner[3]) {
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

static double pressure_at(const SporeVolume *volume, const double *q) {
  return -volume->stiffness * (spore_volume_at(volume, q) - volume->rest) / fabs(volume->rest);
}

/* to += scale dV/dq: a third of each triangle's area along its normal, to each of its corners. */
static void add_gradient(const SporeVolume *volume, const double *q, double scale, double *to) {
  for (size_t t = 0; t < volume->mesh->triangle_count; t++) {
    SporeVec3 corner[3];
    corners_at(volume, q, t, corner);
    SporeVec3 area = spore_vec3_cross(spore_vec3_sub(corner[1], corner[0]), spore_vec3_sub(corner[2], corner[0]));
    for (size_t k = 0; k < 3; k++)
      spore_vec3_accumulate(to + 3 * (size_t)volume->mesh->triangles[3 * t + k], spore_vec3_scale(scale / 6, area));
  }
}

void spore_volume_force(const SporeVolume *volume, const double *q, double *f) {
  if (volume->stiffness > 0) add_gradient(volume, q, pressure_at(volume, q), f);
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
  if (!(volume->stiffness > 0) || !(at->stiffness_scale > 0)) return;
  memset(matrix->direction, 0, 3 * matrix->block_count * sizeof *matrix->direction);
  add_gradient(volume, at->q, sqrt(at->stiffness_scale * volume->stiffness / fabs(volume->rest)), matrix->direction);
  matrix->directed = true;
  if (at->whole) add_curvature(volume, at->q, -at->stiffness_scale * pressure_at(volume, at->q), matrix);
}
