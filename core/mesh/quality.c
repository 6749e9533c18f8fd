/* Quality of tetrahedra: dihedral angles and radius ratio. */
#include <math.h>

#include "core/mesh/common.h"

#define DEGREES (180 / M_PI)
#define RATIO_DEGREES 150 /* divided by the radius ratio: a ratio of 15 counts as much as an angle of 10 degrees */

/* Outward face normals with the length of twice the area. */
static void face_normals(const SporeVec3 p[4], SporeVec3 normal[4]) {
  static const uint8_t faces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  for (int f = 0; f < 4; f++)
    normal[f] = spore_vec3_cross(spore_vec3_sub(p[faces[f][1]], p[faces[f][0]]),
                                 spore_vec3_sub(p[faces[f][2]], p[faces[f][0]]));
}

/* Least dihedral angle (rad); a face without area: 0. The six angles are compared by their sines and cosines, and only
 * the least angle is computed. */
static double least_dihedral(const SporeVec3 normal[4]) {
  double least_sine = 0, least_cosine = -1;
  for (int i = 0; i < 4; i++)
    for (int j = i + 1; j < 4; j++) {
      double sine = spore_vec3_length(spore_vec3_cross(normal[i], normal[j]));
      double cosine = 0 - spore_vec3_dot(normal[i], normal[j]);
      if (cosine * least_sine > sine * least_cosine || (sine == 0 && cosine == 0))
        least_sine = sine, least_cosine = cosine;
    }
  return atan2(least_sine, least_cosine);
}

/* Circumradius over three inradii. With a, b, c the sides from one corner:
 * R = |a^2 (b x c) + b^2 (c x a) + c^2 (a x b)| / (2 |a . (b x c)|), r = 3 V / area. */
static double radius_ratio(const SporeVec3 p[4], const SporeVec3 normal[4], double volume) {
  SporeVec3 a = spore_vec3_sub(p[1], p[0]), b = spore_vec3_sub(p[2], p[0]), c = spore_vec3_sub(p[3], p[0]);
  SporeVec3 sum = spore_vec3_scale(spore_vec3_dot(a, a), spore_vec3_cross(b, c));
  sum = spore_vec3_add_scaled(sum, spore_vec3_dot(b, b), spore_vec3_cross(c, a));
  sum = spore_vec3_add_scaled(sum, spore_vec3_dot(c, c), spore_vec3_cross(a, b));
  double area = 0;
  for (int f = 0; f < 4; f++) area += 0.5 * spore_vec3_length(normal[f]);
  if (!(volume > 0)) return HUGE_VAL;
  return spore_vec3_length(sum) / (12 * volume) * area / (9 * volume);
}

double spore_tetrahedron_quality(const SporeVec3 corner[4]) {
  SporeVec3 normal[4];
  double volume = spore_vec3_volume(corner[0], corner[1], corner[2], corner[3]) / 6;
  if (!(volume > 0)) return -1;
  face_normals(corner, normal);
  return fmin(least_dihedral(normal) * DEGREES, RATIO_DEGREES / radius_ratio(corner, normal, volume));
}

void spore_tetrahedral_mesh_quality(const SporeTetrahedralMesh *mesh, SporeTetrahedraQuality *quality) {
  *quality = (SporeTetrahedraQuality){.min_dihedral_deg = mesh->tetrahedron_count ? 180 : 0};
  for (size_t t = 0; t < mesh->tetrahedron_count; t++) {
    SporeVec3 p[4], normal[4];
    for (int k = 0; k < 4; k++) p[k] = spore_mesh_vertex(mesh->vertices, mesh->tetrahedra[4 * t + k]);
    face_normals(p, normal);
    double volume = spore_vec3_dot(normal[3], spore_vec3_sub(p[0], p[3])) / 6;
    double dihedral = least_dihedral(normal) * DEGREES;
    quality->volume += volume;
    quality->min_dihedral_deg = fmin(quality->min_dihedral_deg, dihedral);
    quality->mean_dihedral_deg += dihedral / (double)mesh->tetrahedron_count;
    quality->worst_radius_ratio = fmax(quality->worst_radius_ratio, radius_ratio(p, normal, volume));
  }
}
