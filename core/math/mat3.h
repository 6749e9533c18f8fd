/* 3x3 matrices, row-major, by value. */
#ifndef SPORE_MATH_MAT3_H
#define SPORE_MATH_MAT3_H

#include <assert.h>
#include <stdbool.h>

#include "core/math/vec3.h"

/* Row i, column j is m[3 i + j]. */
typedef struct SporeMat3 {
  double m[9];
} SporeMat3;

/* The matrix with a, b, c on its diagonal. */
static inline SporeMat3 spore_mat3_diagonal(double a, double b, double c) {
  return (SporeMat3){{a, 0, 0, 0, b, 0, 0, 0, c}};
}
/* The matrix that changes nothing. */
static inline SporeMat3 spore_mat3_identity(void) { return spore_mat3_diagonal(1, 1, 1); }
/* a b^T */
static inline SporeMat3 spore_mat3_outer(SporeVec3 a, SporeVec3 b) {
  return (SporeMat3){
      {a.x * b.x, a.x * b.y, a.x * b.z, a.y * b.x, a.y * b.y, a.y * b.z, a.z * b.x, a.z * b.y, a.z * b.z}};
}
/* [a]x, so that [a]x b = a x b */
static inline SporeMat3 spore_mat3_skew(SporeVec3 a) { return (SporeMat3){{0, -a.z, a.y, a.z, 0, -a.x, -a.y, a.x, 0}}; }
/* a v */
static inline SporeVec3 spore_mat3_apply(SporeMat3 a, SporeVec3 v) {
  return (SporeVec3){a.m[0] * v.x + a.m[1] * v.y + a.m[2] * v.z, a.m[3] * v.x + a.m[4] * v.y + a.m[5] * v.z,
                     a.m[6] * v.x + a.m[7] * v.y + a.m[8] * v.z};
}
/* a^T */
static inline SporeMat3 spore_mat3_transpose(SporeMat3 a) {
  return (SporeMat3){{a.m[0], a.m[3], a.m[6], a.m[1], a.m[4], a.m[7], a.m[2], a.m[5], a.m[8]}};
}
/* a b */
static inline SporeMat3 spore_mat3_multiply(SporeMat3 a, SporeMat3 b) {
  SporeMat3 c;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      c.m[3 * i + j] = a.m[3 * i] * b.m[j] + a.m[3 * i + 1] * b.m[3 + j] + a.m[3 * i + 2] * b.m[6 + j];
  return c;
}
/* a + b */
static inline SporeMat3 spore_mat3_add(SporeMat3 a, SporeMat3 b) {
  for (int i = 0; i < 9; i++) a.m[i] += b.m[i];
  return a;
}
/* a - b */
static inline SporeMat3 spore_mat3_sub(SporeMat3 a, SporeMat3 b) {
  for (int i = 0; i < 9; i++) a.m[i] -= b.m[i];
  return a;
}
/* s a */
static inline SporeMat3 spore_mat3_scale(double s, SporeMat3 a) {
  for (int i = 0; i < 9; i++) a.m[i] *= s;
  return a;
}
/* Sum of the diagonal. */
static inline double spore_mat3_trace(SporeMat3 a) { return a.m[0] + a.m[4] + a.m[8]; }
/* Determinant: the volume that the columns span, signed. */
static inline double spore_mat3_determinant(SporeMat3 a) {
  return a.m[0] * (a.m[4] * a.m[8] - a.m[5] * a.m[7]) - a.m[1] * (a.m[3] * a.m[8] - a.m[5] * a.m[6]) +
         a.m[2] * (a.m[3] * a.m[7] - a.m[4] * a.m[6]);
}
/* Column j, from 0. */
static inline SporeVec3 spore_mat3_column(SporeMat3 a, int j) {
  assert(j >= 0 && j < 3);
  return (SporeVec3){a.m[j], a.m[3 + j], a.m[6 + j]};
}
/* The matrix of these columns. */
static inline SporeMat3 spore_mat3_from_columns(SporeVec3 a, SporeVec3 b, SporeVec3 c) {
  return (SporeMat3){{a.x, b.x, c.x, a.y, b.y, c.y, a.z, b.z, c.z}};
}
/* Inverse; false, *inverse untouched, when |det| <= 1e-14 of the product of the row lengths (singular at that scale).
 */
bool spore_mat3_invert(SporeMat3 a, SporeMat3 *inverse);
/* Eigenvalues (ascending) and orthonormal eigenvectors (columns, right-handed) of a symmetric matrix, cyclic Jacobi. */
void spore_mat3_eigen_symmetric(SporeMat3 a, double values[3], SporeMat3 *vectors);
/* Nearest rotation R (det +1) to F, with S = R^T F symmetric. Defined for inverted and singular F too: the sign
 * and the missing axes then go to the least stretched directions. */
void spore_mat3_polar(SporeMat3 f, SporeMat3 *rotation, SporeMat3 *stretch);

#endif
