/* Quaternions to matrices, rotation vectors and back. */
#include "core/math/quat.h"

#include <float.h>

SporeQuat spore_quat_normalise(SporeQuat q) {
  double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  if (fabs(square - 1) <= 4 * DBL_EPSILON) return q;
  double largest = fmax(fmax(fabs(q.w), fabs(q.x)), fmax(fabs(q.y), fabs(q.z)));
  if (!(largest > 0) || !isfinite(q.w + q.x + q.y + q.z)) return spore_quat_identity();
  q = (SporeQuat){q.w / largest, q.x / largest, q.y / largest, q.z / largest};
  double scale = 1 / sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return (SporeQuat){scale * q.w, scale * q.x, scale * q.y, scale * q.z};
}

SporeMat3 spore_quat_to_mat3(SporeQuat q) {
  double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  double xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z, wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  return (SporeMat3){{1 - 2 * (yy + zz), 2 * (xy - wz), 2 * (xz + wy), 2 * (xy + wz), 1 - 2 * (xx + zz), 2 * (yz - wx),
                      2 * (xz - wy), 2 * (yz + wx), 1 - 2 * (xx + yy)}};
}

/* Starts from the component that is largest, so that nothing is divided by a small number (Shepperd 1978). */
SporeQuat spore_quat_from_mat3(SporeMat3 r) {
  const double *m = r.m;
  double trace = m[0] + m[4] + m[8];
  SporeQuat q;
  if (trace >= m[0] && trace >= m[4] && trace >= m[8])
    q = (SporeQuat){1 + trace, m[7] - m[5], m[2] - m[6], m[3] - m[1]};
  else if (m[0] >= m[4] && m[0] >= m[8]) q = (SporeQuat){m[7] - m[5], 1 + m[0] - m[4] - m[8], m[1] + m[3], m[2] + m[6]};
  else if (m[4] >= m[8]) q = (SporeQuat){m[2] - m[6], m[1] + m[3], 1 - m[0] + m[4] - m[8], m[5] + m[7]};
  else q = (SporeQuat){m[3] - m[1], m[2] + m[6], m[5] + m[7], 1 - m[0] - m[4] + m[8]};
  return spore_quat_normalise(q);
}

SporeQuat spore_quat_from_rotation_vector(SporeVec3 v) {
  double angle = spore_vec3_length(v), half = 0.5 * angle;
  /* sin(half) / angle, by its series where the quotient would lose digits */
  double scale = angle < 1e-4 ? 0.5 - angle * angle / 48 : sin(half) / angle;
  return spore_quat_normalise((SporeQuat){cos(half), scale * v.x, scale * v.y, scale * v.z});
}

SporeVec3 spore_quat_to_rotation_vector(SporeQuat q) {
  if (q.w < 0) q = (SporeQuat){-q.w, -q.x, -q.y, -q.z};
  SporeVec3 axis = {q.x, q.y, q.z};
  double sine = spore_vec3_length(axis);
  double scale = sine < 1e-8 ? 2 : 2 * atan2(sine, q.w) / sine;
  return spore_vec3_scale(scale, axis);
}

SporeQuat spore_quat_between(SporeVec3 from, SporeVec3 to) {
  SporeVec3 axis = spore_vec3_cross(from, to);
  double w = 1 + spore_vec3_dot(from, to);
  if (w < 1e-12) {
    SporeVec3 across = spore_vec3_cross(from, fabs(from.x) < 0.5 ? (SporeVec3){1, 0, 0} : (SporeVec3){0, 1, 0});
    axis = spore_vec3_normalise(across, (SporeVec3){0, 0, 1});
    w = 0;
  }
  return spore_quat_normalise((SporeQuat){w, axis.x, axis.y, axis.z});
}
