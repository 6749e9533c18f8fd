/* Vectors and 3x3 matrices, one a lane; for kernel files. */
#ifndef SPORE_MATH_SIMD_MATRIX_H
#define SPORE_MATH_SIMD_MATRIX_H

#include "core/math/simd.h"

/* 3x3 matrices, one a lane, row-major. */
typedef struct SporeVd33 {
  SporeVd m[9];
} SporeVd33;

#define SPORE_UNROLL _Pragma("GCC unroll 9")

SPORE_INLINE SporeVd33 spore_vd33_multiply(const SporeVd33 *a, const SporeVd33 *b) {
  SporeVd33 c;
  SPORE_UNROLL for (int i = 0; i < 3; i++) SPORE_UNROLL for (int j = 0; j < 3; j++) c.m[3 * i + j] =
      a->m[3 * i] * b->m[j] + a->m[3 * i + 1] * b->m[3 + j] + a->m[3 * i + 2] * b->m[6 + j];
  return c;
}

SPORE_INLINE SporeVd33 spore_vd33_cofactor(const SporeVd33 *a) {
  SporeVd33 c;
  SPORE_UNROLL for (int i = 0; i < 3; i++) SPORE_UNROLL for (int j = 0; j < 3; j++) {
    int r1 = 3 * ((i + 1) % 3), r2 = 3 * ((i + 2) % 3), c1 = (j + 1) % 3, c2 = (j + 2) % 3;
    c.m[3 * i + j] = a->m[r1 + c1] * a->m[r2 + c2] - a->m[r1 + c2] * a->m[r2 + c1];
  }
  return c;
}

SPORE_INLINE SporeVd spore_vd33_product(const SporeVd33 *a, const SporeVd33 *b) { /* a : b */
  SporeVd rows[3];
  SPORE_UNROLL for (int i = 0; i < 3; i++) rows[i] =
      a->m[3 * i] * b->m[3 * i] + a->m[3 * i + 1] * b->m[3 * i + 1] + a->m[3 * i + 2] * b->m[3 * i + 2];
  return rows[0] + rows[1] + rows[2];
}

SPORE_INLINE SporeVd3 spore_vd33_row(const SporeVd33 *a, int i) {
  return (SporeVd3){a->m[3 * i], a->m[3 * i + 1], a->m[3 * i + 2]};
}
SPORE_INLINE SporeVd3 spore_vd33_column(const SporeVd33 *a, int j) {
  return (SporeVd3){a->m[j], a->m[3 + j], a->m[6 + j]};
}
SPORE_INLINE SporeVd3 spore_vd33_apply(const SporeVd33 *a, SporeVd3 x) {
  return (SporeVd3){a->m[0] * x.x + a->m[1] * x.y + a->m[2] * x.z, a->m[3] * x.x + a->m[4] * x.y + a->m[5] * x.z,
                    a->m[6] * x.x + a->m[7] * x.y + a->m[8] * x.z};
}
SPORE_INLINE SporeVd3 spore_vd3_cross(SporeVd3 a, SporeVd3 b) {
  return (SporeVd3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
SPORE_INLINE SporeVd3 spore_vd3_scale(SporeVd s, SporeVd3 a) { return (SporeVd3){s * a.x, s * a.y, s * a.z}; }
SPORE_INLINE SporeVd3 spore_vd3_add(SporeVd3 a, SporeVd3 b) { return (SporeVd3){a.x + b.x, a.y + b.y, a.z + b.z}; }
SPORE_INLINE SporeVd3 spore_vd3_select(SporeVl mask, SporeVd3 a, SporeVd3 b) {
  return (SporeVd3){spore_vd_select(mask, a.x, b.x), spore_vd_select(mask, a.y, b.y), spore_vd_select(mask, a.z, b.z)};
}

/* a += b c^T */
SPORE_INLINE void spore_vd33_add_outer(SporeVd33 *a, SporeVd3 b, SporeVd3 c) {
  a->m[0] += b.x * c.x, a->m[1] += b.x * c.y, a->m[2] += b.x * c.z;
  a->m[3] += b.y * c.x, a->m[4] += b.y * c.y, a->m[5] += b.y * c.z;
  a->m[6] += b.z * c.x, a->m[7] += b.z * c.y, a->m[8] += b.z * c.z;
}

typedef struct SporeVdEigen {
  SporeVd value[3];
  SporeVd3 axis[3]; /* orthonormal */
} SporeVdEigen;

/* The root y >= cos(pi/6) of 4 y^3 - 3 y = r, 0 <= r <= 1: the cosine of a third of the angle. */
SPORE_INLINE SporeVd spore_vd_cosine_of_third(SporeVd r) {
  SporeVd y = 0.8660254037844386 + r * (0.16671 - 0.03274 * r);
  SPORE_UNROLL for (int round = 0; round < 3; round++) y -= (y * (4 * y * y - 3) - r) / (12 * y * y - 3);
  return y;
}

/* The kernel of a symmetric matrix of rank 2, from the greatest column of its adjugate; any direction of one of less.
 */
SPORE_INLINE SporeVd3 spore_vd33_kernel(const SporeVd33 *a) {
  SporeVd3 x = spore_vd33_row(a, 0), y = spore_vd33_row(a, 1), z = spore_vd33_row(a, 2);
  SporeVd3 best = spore_vd3_cross(x, y), other = spore_vd3_cross(y, z), third = spore_vd3_cross(z, x);
  SporeVd square = spore_vd3_dot(best, best), other_square = spore_vd3_dot(other, other);
  SporeVl better = other_square > square;
  best = spore_vd3_select(better, other, best), square = spore_vd_max(other_square, square);
  other_square = spore_vd3_dot(third, third);
  better = other_square > square;
  best = spore_vd3_select(better, third, best), square = spore_vd_max(other_square, square);
  SporeVl none = ~(square > 1e-200);
  SporeVd length = spore_vd_sqrt(square);
  return spore_vd3_select(none, (SporeVd3){spore_vd_all(1), spore_vd_all(0), spore_vd_all(0)},
                          spore_vd3_scale(1 / length, best));
}

/* SporeTwo axes that complete `axis` (Duff et al. 2017, "Building an orthonormal basis, revisited"). */
SPORE_INLINE void spore_vd3_complete_basis(SporeVd3 axis, SporeVd3 *second, SporeVd3 *third) {
  SporeVd sign = spore_vd_select(axis.z < 0, spore_vd_all(-1), spore_vd_all(1));
  SporeVd a = -1 / (sign + axis.z), b = axis.x * axis.y * a;
  *second = (SporeVd3){1 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x};
  *third = (SporeVd3){b, sign + axis.y * axis.y * a, -axis.y};
}

/* Of a symmetric matrix, without iteration: first the eigenvalue that lies apart from the other two, then those two in
 * the plane across its axis (Eberly 2014, "A robust eigensolver for 3x3 symmetric matrices"). */
SPORE_INLINE SporeVdEigen spore_vd33_eigen(const SporeVd33 *a) {
  SporeVd mean = (a->m[0] + a->m[4] + a->m[8]) * (1.0 / 3);
  SporeVd33 b = *a;
  b.m[0] -= mean, b.m[4] -= mean, b.m[8] -= mean;
  SporeVd size = spore_vd_sqrt(spore_vd33_product(&b, &b) * (1.0 / 6) + 1e-300), inverse = 1 / size;
  SPORE_UNROLL for (int k = 0; k < 9; k++) b.m[k] *= inverse;
  SporeVd half =
      0.5 * spore_vd3_dot(spore_vd33_row(&b, 0), spore_vd3_cross(spore_vd33_row(&b, 1), spore_vd33_row(&b, 2)));
  SporeVd sign = spore_vd_select(half < 0, spore_vd_all(-1), spore_vd_all(1));
  SporeVd apart = 2 * sign * spore_vd_cosine_of_third(spore_vd_min(spore_vd_abs(half), spore_vd_all(1)));
  SporeVdEigen eigen;
  SporeVd33 shifted = b;
  shifted.m[0] -= apart, shifted.m[4] -= apart, shifted.m[8] -= apart;
  eigen.axis[0] = spore_vd33_kernel(&shifted);
  SporeVd3 v, w;
  spore_vd3_complete_basis(eigen.axis[0], &v, &w);
  SporeVd3 bv = spore_vd33_apply(&b, v), bw = spore_vd33_apply(&b, w);
  SporeVd vv = spore_vd3_dot(v, bv), vw = spore_vd3_dot(v, bw), ww = spore_vd3_dot(w, bw), difference = ww - vv;
  SporeVd turn = spore_vd_abs(difference) + spore_vd_sqrt(difference * difference + 4 * vw * vw) + 1e-300;
  SporeVd tangent = spore_vd_select(difference < 0, -2 * vw, 2 * vw) / turn;
  SporeVd cosine = 1 / spore_vd_sqrt(1 + tangent * tangent), sine = tangent * cosine;
  eigen.axis[1] = spore_vd3_add(spore_vd3_scale(cosine, v), spore_vd3_scale(-sine, w));
  eigen.axis[2] = spore_vd3_add(spore_vd3_scale(sine, v), spore_vd3_scale(cosine, w));
  eigen.value[0] = mean + size * apart;
  eigen.value[1] = mean + size * (vv - tangent * vw);
  eigen.value[2] = mean + size * (ww + tangent * vw);
  return eigen;
}

SPORE_INLINE SporeVd33 spore_vd33_transpose(const SporeVd33 *a) {
  return (SporeVd33){{a->m[0], a->m[3], a->m[6], a->m[1], a->m[4], a->m[7], a->m[2], a->m[5], a->m[8]}};
}

#endif
