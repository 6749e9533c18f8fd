/* Mirror planes of a solid: finding them, and folding points at them. */
#include <math.h>

#include "core/generate/common/common.h"
#include "core/math/mat3.h"

#define TOLERANCE 1e-6 /* of the diagonal */

static double height(const SporeSymmetry *symmetry, size_t plane, SporeVec3 p) {
  return spore_vec3_dot(spore_vec3_sub(p, symmetry->point), symmetry->normal[plane]);
}

SporeVec3 spore_symmetry_fold(const SporeSymmetry *symmetry, SporeVec3 p) {
  for (size_t k = 0; k < symmetry->count; k++)
    if (height(symmetry, k, p) < 0) p = spore_symmetry_mirror(symmetry, 1u << k, p);
  return p;
}

SporeVec3 spore_symmetry_bind(const SporeSymmetry *symmetry, unsigned planes, SporeVec3 p) {
  for (size_t k = 0; k < symmetry->count; k++)
    if (planes >> k & 1) p = spore_vec3_add_scaled(p, -height(symmetry, k, p), symmetry->normal[k]);
  return p;
}

SporeVec3 spore_symmetry_mirror(const SporeSymmetry *symmetry, unsigned planes, SporeVec3 p) {
  for (size_t k = 0; k < symmetry->count; k++)
    if (planes >> k & 1) p = spore_vec3_add_scaled(p, -2 * height(symmetry, k, p), symmetry->normal[k]);
  return p;
}

static SporeVec3 corner(const SporeTriangleMesh *mesh, size_t triangle, int k) {
  return spore_vec3_load(mesh->vertices + 3 * (size_t)mesh->triangles[3 * triangle + (size_t)k]);
}

/* Centroid of the surface and the second moments about it, weighted by area. */
static void find_moments(const SporeTriangleMesh *mesh, SporeVec3 *middle, SporeMat3 *moments) {
  double area = 0, sum[3] = {0}, squares[9] = {0};
  SporeVec3 origin = corner(mesh, 0, 0);
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    SporeVec3 p[3];
    for (int k = 0; k < 3; k++) p[k] = spore_vec3_sub(corner(mesh, t, k), origin);
    double a = spore_vec3_length(spore_vec3_cross(spore_vec3_sub(p[1], p[0]), spore_vec3_sub(p[2], p[0])));
    area += a;
    /* The midpoints of the three edges integrate squares exactly. */
    for (int k = 0; k < 3; k++) {
      double m[3];
      spore_vec3_store(m, spore_vec3_scale(0.5, spore_vec3_add(p[k], p[(k + 1) % 3])));
      for (int r = 0; r < 3; r++) {
        sum[r] += a / 3 * m[r];
        for (int c = 0; c < 3; c++) squares[3 * r + c] += a / 3 * m[r] * m[c];
      }
    }
  }
  for (int r = 0; r < 3; r++) sum[r] /= area;
  for (int k = 0; k < 9; k++) moments->m[k] = squares[k] / area - sum[k / 3] * sum[k % 3];
  *middle = spore_vec3_add(origin, spore_vec3_load(sum));
}

static bool on_surface(const SporeBvh *bvh, SporeVec3 p, double tolerance) {
  return spore_bvh_distance(bvh, p, NULL, NULL) <= tolerance;
}

/* Whether the images of the triangles' corners and centroids lie on the surface. */
static bool maps_onto_itself(const SporeSymmetry *one, const SporeTriangleMesh *mesh, const SporeBvh *bvh,
                             double tolerance) {
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    SporeVec3 middle = spore_vec3(0, 0, 0);
    for (int k = 0; k < 3; k++) {
      if (!on_surface(bvh, spore_symmetry_mirror(one, 1, corner(mesh, t, k)), tolerance)) return false;
      middle = spore_vec3_add_scaled(middle, 1. / 3, corner(mesh, t, k));
    }
    if (!on_surface(bvh, spore_symmetry_mirror(one, 1, middle), tolerance)) return false;
  }
  return true;
}

void spore_symmetry_find(SporeSymmetry *symmetry, const SporeTriangleMesh *mesh, const SporeBvh *bvh, double diagonal) {
  SporeMat3 moments, axes;
  double values[3];
  *symmetry = (SporeSymmetry){0};
  find_moments(mesh, &symmetry->point, &moments);
  spore_mat3_eigen_symmetric(moments, values, &axes);
  for (int k = 0; k < 6 && symmetry->count < SPORE_MIRRORS_MOST; k++) {
    SporeVec3 normal = k < 3 ? spore_vec3(k == 0, k == 1, k == 2) : spore_mat3_column(axes, k - 3);
    SporeSymmetry one = {1, symmetry->point, {normal}};
    bool square = true;
    for (size_t i = 0; i < symmetry->count; i++)
      square &= fabs(spore_vec3_dot(normal, symmetry->normal[i])) < TOLERANCE;
    if (square && maps_onto_itself(&one, mesh, bvh, TOLERANCE * diagonal)) symmetry->normal[symmetry->count++] = normal;
  }
}
