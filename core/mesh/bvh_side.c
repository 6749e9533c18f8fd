/* On which side of a surface a point lies. In a closed surface that is told exactly, and sooner than by the winding
 * number's sum, by the crossings of a ray with the surface. */
#include <math.h>
#include <string.h>

#include "core/mesh/bvh_node.h"
#include "core/mesh/edge_marks.h"

#define UNSURE 1e-13 /* of the terms of a sum: a sum nearer to 0 may have either sign by rounding */

/* A ray along an axis, up or down, from a point. */
typedef struct Ray {
  double p[3];
  int along, across, aside; /* axes, right-handed */
  bool up;
} Ray;

typedef enum Sign { BELOW = -1, NEITHER = 0, ABOVE = 1 } Sign;

static Sign sign_of(double sum, double terms) {
  return fabs(sum) <= UNSURE * terms ? NEITHER : sum > 0 ? ABOVE : BELOW;
}

/* Twice the signed area between the origin and the edge from a to b, in the plane across the ray. */
static double area(const Ray *ray, const double *a, const double *b, Sign *sign) {
  double left = a[ray->across] * b[ray->aside], right = a[ray->aside] * b[ray->across];
  *sign = sign_of(left - right, fabs(left) + fabs(right));
  return left - right;
}

/* How often the ray leaves through the triangle less how often it enters: 1, 0 or -1. *sure becomes false where
 * rounding may decide. */
static int crossing(const Ray *ray, const double *corners, bool *sure) {
  double c[3][3], areas[3], height = 0, heights = 0;
  Sign sign[3];
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) c[i][k] = corners[3 * i + k] - ray->p[k];
  for (int i = 0; i < 3; i++) areas[i] = area(ray, c[(i + 1) % 3], c[(i + 2) % 3], &sign[i]);
  bool above = sign[0] == ABOVE || sign[1] == ABOVE || sign[2] == ABOVE,
       below = sign[0] == BELOW || sign[1] == BELOW || sign[2] == BELOW;
  if (above && below) return 0;
  for (int i = 0; i < 3; i++) {
    double term = areas[i] * c[i][ray->along];
    height += term, heights += fabs(term);
  }
  Sign ahead = sign_of(below ? -height : height, heights);
  if (ahead == (ray->up ? BELOW : ABOVE) && sign[0] && sign[1] && sign[2]) return 0;
  if (!sign[0] || !sign[1] || !sign[2] || !ahead) return *sure = false, 0;
  return above == ray->up ? 1 : -1;
}

/* The ray from p that leaves the box soonest. False: p is not in the box. */
static bool choose_ray(const SporeBvhNode *box, SporeVec3 p, Ray *ray) {
  double nearest = HUGE_VAL;
  *ray = (Ray){.p = {p.x, p.y, p.z}};
  for (int k = 0; k < 3; k++) {
    double below = ray->p[k] - box->lower[k], above = box->upper[k] - ray->p[k];
    if (!(below >= 0 && above >= 0)) return false;
    if (fmin(below, above) >= nearest) continue;
    nearest = fmin(below, above);
    ray->along = k, ray->up = above < below;
  }
  ray->across = (ray->along + 1) % 3, ray->aside = (ray->along + 2) % 3;
  return true;
}

static bool meets(const Ray *ray, const SporeBvhNode *box) {
  double across = ray->p[ray->across], aside = ray->p[ray->aside], along = ray->p[ray->along];
  return across >= box->lower[ray->across] && across <= box->upper[ray->across] && aside >= box->lower[ray->aside] &&
         aside <= box->upper[ray->aside] &&
         (ray->up ? along <= box->upper[ray->along] : along >= box->lower[ray->along]);
}

/* The winding number of a closed surface. *sure: as for crossing. */
static int count_crossings(const SporeBvh *bvh, const Ray *ray, bool *sure) {
  uint32_t stack[SPORE_BVH_DEPTH];
  int waiting = 0, sum = 0;
  stack[waiting++] = 0;
  while (waiting && *sure) {
    uint32_t index = stack[--waiting];
    const SporeBvhNode *node = bvh->nodes + index;
    if (!meets(ray, node)) continue;
    for (uint32_t i = node->first; i < node->first + node->count; i++)
      sum += crossing(ray, bvh->corners + 9 * (size_t)i, sure);
    if (node->count) continue;
    stack[waiting++] = node->first;
    stack[waiting++] = index + 1;
  }
  return sum;
}

bool spore_bvh_inside(const SporeBvh *bvh, SporeVec3 p) {
  Ray ray;
  bool sure = true;
  if (!bvh->closed) return spore_bvh_winding(bvh, p) > 0.5;
  if (!choose_ray(bvh->nodes, p, &ray)) return false;
  int winding = count_crossings(bvh, &ray, &sure);
  return sure ? winding > 0 : spore_bvh_winding(bvh, p) > 0.5;
}

static uint64_t mark_of(const double *place) {
  uint64_t mark = 0;
  for (int k = 0; k < 3; k++) {
    double x = place[k] + 0.0; /* -0 is 0 */
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    mark = spore_mark_mix(mark + UINT64_C(0x9e3779b97f4a7c15) + bits);
  }
  return mark;
}

bool spore_bvh_is_closed(const SporeBvh *bvh) {
  uint64_t sum = 0;
  for (size_t t = 0; t < bvh->triangle_count; t++) {
    uint64_t mark[3];
    for (size_t k = 0; k < 3; k++) mark[k] = mark_of(bvh->corners + 9 * t + 3 * k);
    for (int k = 0; k < 3; k++) sum += spore_edge_mark(mark[k], mark[(k + 1) % 3]);
  }
  return !sum;
}
