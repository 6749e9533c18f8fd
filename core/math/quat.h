/* Unit quaternions (w, x, y, z) for orientations, and poses. */
#ifndef SPORE_MATH_QUAT_H
#define SPORE_MATH_QUAT_H

#include "core/math/mat3.h"

/* A quaternion w + x i + y j + z k. */
typedef struct SporeQuat {
  double w, x, y, z;
} SporeQuat;

/* No rotation. */
static inline SporeQuat spore_quat_identity(void) { return (SporeQuat){1, 0, 0, 0}; }
/* From four numbers, w x y z. */
static inline SporeQuat spore_quat_load(const double *p) { return (SporeQuat){p[0], p[1], p[2], p[3]}; }
/* To four numbers, w x y z. */
static inline void spore_quat_store(double *p, SporeQuat q) { p[0] = q.w, p[1] = q.x, p[2] = q.y, p[3] = q.z; }
/* The rotation b, followed by a. */
static inline SporeQuat spore_quat_multiply(SporeQuat a, SporeQuat b) {
  return (SporeQuat){a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                     a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
/* The rotation the other way. */
static inline SporeQuat spore_quat_conjugate(SporeQuat q) { return (SporeQuat){q.w, -q.x, -q.y, -q.z}; }
/* Identity where q has no length or is not finite; untouched where it is of unit length to rounding. */
SporeQuat spore_quat_normalise(SporeQuat q);
/* v, rotated; q of unit length. */
static inline SporeVec3 spore_quat_rotate(SporeQuat q, SporeVec3 v) {
  SporeVec3 axis = {q.x, q.y, q.z};
  SporeVec3 twice = spore_vec3_scale(2, spore_vec3_cross(axis, v));
  return spore_vec3_add(spore_vec3_add_scaled(v, q.w, twice), spore_vec3_cross(axis, twice));
}
/* The rotation as a matrix; q of unit length. */
SporeMat3 spore_quat_to_mat3(SporeQuat q);
/* The rotation of an orthonormal matrix with determinant 1; rounding errors of it are evened out. */
SporeQuat spore_quat_from_mat3(SporeMat3 r);
/* The smallest rotation that takes one unit vector to the other. */
SporeQuat spore_quat_between(SporeVec3 from, SporeVec3 to);
/* Rotation by the vector's length (rad) about its direction. */
SporeQuat spore_quat_from_rotation_vector(SporeVec3 v);
/* The inverse: length in [0, pi]. */
SporeVec3 spore_quat_to_rotation_vector(SporeQuat q);

/* Position (m) and orientation of a frame. */
typedef struct SporePose {
  SporeVec3 position;
  SporeQuat orientation;
} SporePose;

/* The frame of the world. */
static inline SporePose spore_pose_identity(void) { return (SporePose){{0, 0, 0}, {1, 0, 0, 0}}; }
/* From its 7 numbers: position, then orientation (w x y z). */
static inline SporePose spore_pose_load(const double *q) {
  return (SporePose){spore_vec3_load(q), spore_quat_load(q + 3)};
}
/* A point of the frame, as a point of the world. */
static inline SporeVec3 spore_pose_apply(SporePose p, SporeVec3 v) {
  return spore_vec3_add(p.position, spore_quat_rotate(p.orientation, v));
}
/* The point that apply takes to v. */
static inline SporeVec3 spore_pose_apply_inverse(SporePose p, SporeVec3 v) {
  return spore_quat_rotate(spore_quat_conjugate(p.orientation), spore_vec3_sub(v, p.position));
}

#endif
