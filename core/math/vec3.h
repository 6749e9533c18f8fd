/* Vectors of three doubles, by value. */
#ifndef SPORE_MATH_VEC3_H
#define SPORE_MATH_VEC3_H

#include <math.h>
#include <stdbool.h>

/* A point, direction or force; units are those of what it is used for. */
typedef struct SporeVec3 {
  double x, y, z;
} SporeVec3;

/* The vector of these components. */
static inline SporeVec3 spore_vec3(double x, double y, double z) { return (SporeVec3){x, y, z}; }
/* From three numbers of an array. */
static inline SporeVec3 spore_vec3_load(const double *p) { return (SporeVec3){p[0], p[1], p[2]}; }
/* To three numbers of an array. */
static inline void spore_vec3_store(double *p, SporeVec3 a) { p[0] = a.x, p[1] = a.y, p[2] = a.z; }
/* Adds a to three numbers of an array. */
static inline void spore_vec3_accumulate(double *p, SporeVec3 a) { p[0] += a.x, p[1] += a.y, p[2] += a.z; }
/* a + b */
static inline SporeVec3 spore_vec3_add(SporeVec3 a, SporeVec3 b) {
  return (SporeVec3){a.x + b.x, a.y + b.y, a.z + b.z};
}
/* a - b */
static inline SporeVec3 spore_vec3_sub(SporeVec3 a, SporeVec3 b) {
  return (SporeVec3){a.x - b.x, a.y - b.y, a.z - b.z};
}
/* s a */
static inline SporeVec3 spore_vec3_scale(double s, SporeVec3 a) { return (SporeVec3){s * a.x, s * a.y, s * a.z}; }
/* a + s b */
static inline SporeVec3 spore_vec3_add_scaled(SporeVec3 a, double s, SporeVec3 b) {
  return (SporeVec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
/* a . b */
static inline double spore_vec3_dot(SporeVec3 a, SporeVec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
/* a x b */
static inline SporeVec3 spore_vec3_cross(SporeVec3 a, SporeVec3 b) {
  return (SporeVec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/* |a| */
static inline double spore_vec3_length(SporeVec3 a) { return sqrt(spore_vec3_dot(a, a)); }
/* |a - b| */
static inline double spore_vec3_distance(SporeVec3 a, SporeVec3 b) { return spore_vec3_length(spore_vec3_sub(a, b)); }
/* No component is infinite or not a number. */
static inline bool spore_vec3_is_finite(SporeVec3 a) { return isfinite(a.x) && isfinite(a.y) && isfinite(a.z); }
/* Unit vector; `fallback` where a is too short to have a direction. */
static inline SporeVec3 spore_vec3_normalise(SporeVec3 a, SporeVec3 fallback) {
  double length = spore_vec3_length(a);
  return length > 1e-300 ? spore_vec3_scale(1 / length, a) : fallback;
}
/* One of the unit vectors across a unit vector. */
static inline SporeVec3 spore_vec3_any_across(SporeVec3 unit) {
  SporeVec3 axis = fabs(unit.x) < 0.6 ? spore_vec3(1, 0, 0) : spore_vec3(0, 1, 0);
  return spore_vec3_normalise(spore_vec3_cross(unit, axis), axis);
}
/* A vector across the unit vector `from`, turned by the least rotation that takes `from` to the unit vector `to`; as it
 * was where `to` is opposite to `from` and there are many. It keeps its length, and comes out across `to`. */
static inline SporeVec3 spore_vec3_transport(SporeVec3 across, SporeVec3 from, SporeVec3 to) {
  SporeVec3 axis = spore_vec3_cross(from, to);
  double cosine = spore_vec3_dot(from, to);
  if (cosine < -1 + 1e-12) return across;
  SporeVec3 turned = spore_vec3_add(spore_vec3_scale(cosine, across), spore_vec3_cross(axis, across));
  return spore_vec3_add_scaled(turned, spore_vec3_dot(axis, across) / (1 + cosine), axis);
}

/* Six times the signed volume of a tetrahedron. */
static inline double spore_vec3_volume(SporeVec3 a, SporeVec3 b, SporeVec3 c, SporeVec3 d) {
  return spore_vec3_dot(spore_vec3_cross(spore_vec3_sub(b, a), spore_vec3_sub(c, a)), spore_vec3_sub(d, a));
}

/* Of a segment, by which its end lies off a plane that it is in. */
#define SPORE_VEC3_FLAT 1e-10
/* Whether the segment from p to r goes through the triangle, and not just to its plane, as far as that can be told in
 * rounded numbers; the same from either end. */
static inline bool spore_vec3_crosses(SporeVec3 p, SporeVec3 r, SporeVec3 a, SporeVec3 b, SporeVec3 c) {
  double before = spore_vec3_volume(a, b, c, p), behind = spore_vec3_volume(a, b, c, r);
  if (!(before * behind < 0)) return false;
  double area = spore_vec3_length(spore_vec3_cross(spore_vec3_sub(b, a), spore_vec3_sub(c, a)));
  if (fmin(fabs(before), fabs(behind)) <= SPORE_VEC3_FLAT * area * spore_vec3_distance(p, r)) return false;
  double u = spore_vec3_volume(p, r, a, b), v = spore_vec3_volume(p, r, b, c), w = spore_vec3_volume(p, r, c, a);
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

#endif
