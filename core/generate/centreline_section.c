#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/generate/centreline_parts.h"

#define OUTLIER 1.25 /* of the median distance of a section's wall, that counts at most */

/* Whether the ray leaves through the triangle's front; what it comes to from outside lies within the organ, or is
 * turned the wrong way round. */
static bool leaves(const SporeSolid *solid, uint32_t triangle, SporeVec3 d) {
  SporeVec3 corner[3];
  for (size_t k = 0; k < 3; k++)
    corner[k] = spore_vec3_load(solid->mesh.vertices + 3 * (size_t)solid->mesh.triangles[3 * (size_t)triangle + k]);
  SporeVec3 n = spore_vec3_cross(spore_vec3_sub(corner[1], corner[0]), spore_vec3_sub(corner[2], corner[0]));
  return spore_vec3_dot(n, d) > 0;
}

double spore_section_wall(const SporeSolid *solid, SporeVec3 p, SporeVec3 d, double reach) {
  double gone = 0, beyond = 1e-3 * reach, t;
  uint32_t triangle;
  while (gone < reach && spore_bvh_ray(solid->bvh, spore_vec3_add_scaled(p, gone, d), d, &t, &triangle)) {
    gone += t;
    if (gone >= reach) return reach;
    if (leaves(solid, triangle, d) || spore_bvh_winding(solid->bvh, spore_vec3_add_scaled(p, gone + beyond, d)) < 0.5)
      return gone;
    gone += beyond;
  }
  return reach;
}

static int by_size(const void *a, const void *b) {
  double one = *(const double *)a, other = *(const double *)b;
  return (one > other) - (one < other);
}

/* Through the neck where two loops touch, rays go on into the other: none counts for more than a bit over the median.
 */
static void cut_outliers(double wall[SPORE_SECTION_RAYS]) {
  double sorted[SPORE_SECTION_RAYS];
  memcpy(sorted, wall, sizeof sorted);
  qsort(sorted, SPORE_SECTION_RAYS, sizeof *sorted, by_size);
  double most = OUTLIER * sorted[SPORE_SECTION_RAYS / 2];
  for (int i = 0; i < SPORE_SECTION_RAYS; i++) wall[i] = fmin(wall[i], most);
}

SporeVec3 spore_section_middle(const SporeSolid *solid, SporeVec3 p, SporeVec3 across, double reach) {
  SporeVec3 axis = fabs(across.x) < 0.6 ? spore_vec3(1, 0, 0) : spore_vec3(0, 1, 0);
  SporeVec3 u = spore_vec3_normalise(spore_vec3_cross(across, axis), axis), v = spore_vec3_cross(across, u);
  double wall[SPORE_SECTION_RAYS], area = 0;
  SporeVec3 ray[SPORE_SECTION_RAYS], sum = {0, 0, 0};
  for (int i = 0; i < SPORE_SECTION_RAYS; i++) {
    double angle = 2 * M_PI * i / SPORE_SECTION_RAYS;
    ray[i] = spore_vec3_add_scaled(spore_vec3_scale(cos(angle), u), sin(angle), v);
    wall[i] = spore_section_wall(solid, p, ray[i], reach);
  }
  cut_outliers(wall);
  for (int i = 0; i < SPORE_SECTION_RAYS; i++) { /* triangles from p to two neighbouring rays */
    int next = (i + 1) % SPORE_SECTION_RAYS;
    double share = wall[i] * wall[next];
    area += share;
    sum = spore_vec3_add_scaled(sum, share * wall[i] / 3, ray[i]);
    sum = spore_vec3_add_scaled(sum, share * wall[next] / 3, ray[next]);
  }
  return area > 0 ? spore_vec3_add_scaled(p, 1 / area, sum) : p;
}
