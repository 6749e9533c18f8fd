/* Distances to a surface, and rays through it. */
#include <assert.h>
#include <math.h>

#include "core/mesh/bvh_node.h"

/* Ericson 2005, Real-Time Collision Detection, 5.1.5: by Voronoi regions. */
SporeVec3 spore_triangle_nearest(SporeVec3 p, const double *corners) {
  SporeVec3 a = spore_vec3_load(corners), b = spore_vec3_load(corners + 3), c = spore_vec3_load(corners + 6);
  SporeVec3 ab = spore_vec3_sub(b, a), ac = spore_vec3_sub(c, a), ap = spore_vec3_sub(p, a);
  double d1 = spore_vec3_dot(ab, ap), d2 = spore_vec3_dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  SporeVec3 bp = spore_vec3_sub(p, b);
  double d3 = spore_vec3_dot(ab, bp), d4 = spore_vec3_dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return spore_vec3_add_scaled(a, d1 > d3 ? d1 / (d1 - d3) : 0, ab);
  SporeVec3 cp = spore_vec3_sub(p, c);
  double d5 = spore_vec3_dot(ab, cp), d6 = spore_vec3_dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return spore_vec3_add_scaled(a, d2 > d6 ? d2 / (d2 - d6) : 0, ac);
  double va = d3 * d6 - d5 * d4, along = d4 - d3, back = d5 - d6;
  if (va <= 0 && along >= 0 && back >= 0)
    return spore_vec3_add_scaled(b, along + back > 0 ? along / (along + back) : 0, spore_vec3_sub(c, b));
  double sum = va + vb + vc;
  if (!(sum > 0)) return a;
  return spore_vec3_add_scaled(spore_vec3_add_scaled(a, vb / sum, ab), vc / sum, ac);
}

static double box_distance_squared(const SporeBvhNode *node, const double p[3]) {
  double sum = 0;
  for (int k = 0; k < 3; k++) {
    double below = node->lower[k] - p[k], above = p[k] - node->upper[k];
    double d = below > above ? below : above;
    d = d > 0 ? d : 0;
    sum += d * d;
  }
  return sum;
}

double spore_bvh_distance_below(const SporeBvh *bvh, SporeVec3 p, double below, SporeVec3 *nearest,
                                uint32_t *triangle) {
  assert(below >= 0);
  struct {
    uint32_t node;
    double distance_squared;
  } stack[SPORE_BVH_DEPTH];
  int waiting = 0;
  double x[3] = {p.x, p.y, p.z}, best = below * below;
  SporeVec3 best_point = p;
  uint32_t best_triangle = 0, index = 0;
  for (;;) {
    const SporeBvhNode *node = bvh->nodes + index;
    if (!node->count) { /* the nearer child first */
      uint32_t l = index + 1, r = node->first;
      double dl = box_distance_squared(bvh->nodes + l, x), dr = box_distance_squared(bvh->nodes + r, x);
      uint32_t later = dl <= dr ? r : l;
      double nearer = dl <= dr ? dl : dr, farther = dl <= dr ? dr : dl;
      if (farther < best) stack[waiting].node = later, stack[waiting++].distance_squared = farther;
      if (nearer < best) {
        index = dl <= dr ? l : r;
        continue;
      }
    }
    for (uint32_t i = node->first; i < node->first + node->count; i++) {
      SporeVec3 q = spore_triangle_nearest(p, bvh->corners + 9 * (size_t)i), gap = spore_vec3_sub(p, q);
      double d = spore_vec3_dot(gap, gap);
      if (d < best) best = d, best_point = q, best_triangle = bvh->triangles[i];
    }
    while (waiting && stack[waiting - 1].distance_squared >= best) waiting--;
    if (!waiting) break;
    index = stack[--waiting].node;
  }
  if (nearest) *nearest = best_point;
  if (triangle) *triangle = best_triangle;
  return sqrt(best);
}

double spore_bvh_distance(const SporeBvh *bvh, SporeVec3 p, SporeVec3 *nearest, uint32_t *triangle) {
  return spore_bvh_distance_below(bvh, p, HUGE_VAL, nearest, triangle);
}

size_t spore_bvh_near(const SporeBvh *bvh, SporeVec3 p, double within, SporeBvhNear *near, size_t most) {
  assert(within >= 0);
  uint32_t stack[SPORE_BVH_DEPTH];
  int waiting = 0;
  size_t count = 0;
  double x[3] = {p.x, p.y, p.z};
  stack[waiting++] = 0;
  while (waiting) {
    uint32_t index = stack[--waiting];
    const SporeBvhNode *node = bvh->nodes + index;
    if (box_distance_squared(node, x) > within * within) continue;
    for (uint32_t i = node->first; i < node->first + node->count; i++) {
      double distance = spore_vec3_distance(p, spore_triangle_nearest(p, bvh->corners + 9 * (size_t)i));
      if (distance > within) continue;
      if (count == most) return most + 1;
      near[count++] = (SporeBvhNear){distance, i};
    }
    if (node->count) continue;
    stack[waiting++] = node->first;
    stack[waiting++] = index + 1;
  }
  return count;
}

/* Nearest and farthest parameter of the ray inside the box; false: the ray misses the box. */
static bool ray_box(const SporeBvhNode *node, const double p[3], const double d[3], double limit, double *enter) {
  double low = 0, high = limit;
  for (int k = 0; k < 3; k++) {
    if (d[k] == 0) {
      if (p[k] < node->lower[k] || p[k] > node->upper[k]) return false;
      continue;
    }
    double a = (node->lower[k] - p[k]) / d[k], b = (node->upper[k] - p[k]) / d[k];
    low = fmax(low, fmin(a, b));
    high = fmin(high, fmax(a, b));
  }
  *enter = low;
  return low <= high * (1 + 1e-12);
}

/* Moeller and Trumbore 1997, both sides. Returns the parameter, or a negative number. */
static double ray_triangle(SporeVec3 p, SporeVec3 d, const double *corners) {
  SporeVec3 a = spore_vec3_load(corners), ab = spore_vec3_sub(spore_vec3_load(corners + 3), a);
  SporeVec3 ac = spore_vec3_sub(spore_vec3_load(corners + 6), a), h = spore_vec3_cross(d, ac);
  double det = spore_vec3_dot(ab, h);
  if (det == 0) return -1;
  SporeVec3 s = spore_vec3_sub(p, a), q = spore_vec3_cross(s, ab);
  double u = spore_vec3_dot(s, h) / det, v = spore_vec3_dot(d, q) / det;
  if (!(u >= 0 && v >= 0 && u + v <= 1)) return -1;
  return spore_vec3_dot(ac, q) / det;
}

bool spore_bvh_ray(const SporeBvh *bvh, SporeVec3 p, SporeVec3 d, double *t, uint32_t *triangle) {
  uint32_t stack[SPORE_BVH_DEPTH], best_triangle = UINT32_MAX;
  int waiting = 0;
  double x[3] = {p.x, p.y, p.z}, dx[3] = {d.x, d.y, d.z}, best = HUGE_VAL, enter;
  stack[waiting++] = 0;
  while (waiting) {
    uint32_t index = stack[--waiting];
    const SporeBvhNode *node = bvh->nodes + index;
    if (!ray_box(node, x, dx, best, &enter)) continue;
    for (uint32_t i = node->first; i < node->first + node->count; i++) {
      double hit = ray_triangle(p, d, bvh->corners + 9 * (size_t)i);
      if (hit >= 0 && hit < best) best = hit, best_triangle = bvh->triangles[i];
    }
    if (node->count) continue;
    double left = HUGE_VAL, right = HUGE_VAL;
    bool in_left = ray_box(node + 1, x, dx, best, &left),
         in_right = ray_box(bvh->nodes + node->first, x, dx, best, &right);
    uint32_t later = left <= right ? node->first : index + 1, sooner = left <= right ? index + 1 : node->first;
    if (left <= right ? in_right : in_left) stack[waiting++] = later;
    if (left <= right ? in_left : in_right) stack[waiting++] = sooner;
  }
  if (best_triangle == UINT32_MAX) return false;
  if (t) *t = best;
  if (triangle) *triangle = best_triangle;
  return true;
}
