#include "core/math/mat3.h"

#include <assert.h>
#include <float.h>

static double largest_entry(SporeMat3 a) {
  double largest = 0;
  for (int i = 0; i < 9; i++) largest = fmax(largest, fabs(a.m[i]));
  return largest;
}

static bool is_finite(SporeMat3 a) {
  for (int i = 0; i < 9; i++)
    if (!isfinite(a.m[i])) return false;
  return true;
}

bool spore_mat3_invert(SporeMat3 a, SporeMat3 *inverse) {
  if (!is_finite(a)) return false;
  /* Rows are brought to unit length first, so that neither tiny nor huge matrices leave the range of double. */
  SporeVec3 row[3];
  double scale[3];
  for (int i = 0; i < 3; i++) {
    row[i] = spore_vec3_load(a.m + 3 * i);
    double largest = fmax(fabs(row[i].x), fmax(fabs(row[i].y), fabs(row[i].z)));
    if (largest == 0) return false;
    row[i] = (SporeVec3){row[i].x / largest, row[i].y / largest, row[i].z / largest};
    double length = spore_vec3_length(row[i]);
    row[i] = spore_vec3_scale(1 / length, row[i]);
    scale[i] = length * largest;
  }
  SporeVec3 c0 = spore_vec3_cross(row[1], row[2]);
  double determinant = spore_vec3_dot(row[0], c0);
  if (fabs(determinant) <= 1e-14) return false;
  SporeVec3 c1 = spore_vec3_cross(row[2], row[0]), c2 = spore_vec3_cross(row[0], row[1]);
  SporeMat3 unit = spore_mat3_from_columns(c0, c1, c2);
  for (int i = 0; i < 9; i++) inverse->m[i] = unit.m[i] / determinant / scale[i % 3];
  return true;
}

/* Cosine and sine of the rotation that diagonalises [[app, apq], [apq, aqq]] (Golub and Van Loan, 8.5.2). */
static void jacobi_rotation(double app, double apq, double aqq, double *c, double *s) {
  double tau = (aqq - app) / (2 * apq);
  double t = (tau >= 0 ? 1 : -1) / (fabs(tau) + sqrt(1 + tau * tau));
  if (fabs(tau) > 1e150) t = 0.5 / tau;
  *c = 1 / sqrt(1 + t * t);
  *s = t * *c;
}

/* Columns p and q of a: (c p - s q, s p + c q). */
static void rotate_columns(SporeMat3 *a, int p, int q, double c, double s) {
  assert(p >= 0 && p < q && q < 3);
  for (int i = 0; i < 3; i++) {
    double ap = a->m[3 * i + p], aq = a->m[3 * i + q];
    a->m[3 * i + p] = c * ap - s * aq;
    a->m[3 * i + q] = s * ap + c * aq;
  }
}

static void rotate_rows(SporeMat3 *a, int p, int q, double c, double s) {
  assert(p >= 0 && p < q && q < 3);
  for (int j = 0; j < 3; j++) {
    double ap = a->m[3 * p + j], aq = a->m[3 * q + j];
    a->m[3 * p + j] = c * ap - s * aq;
    a->m[3 * q + j] = s * ap + c * aq;
  }
}

static const int PAIRS[3][2] = {{0, 1}, {0, 2}, {1, 2}};

#define SWEEPS 30 /* convergence is quadratic: four to six are enough for any finite matrix */

void spore_mat3_eigen_symmetric(SporeMat3 a, double values[3], SporeMat3 *vectors) {
  SporeMat3 v = spore_mat3_identity();
  double unit = largest_entry(a);
  bool usable = is_finite(a) && unit > 0;
  if (usable)
    for (int i = 0; i < 9; i++) a.m[i] /= unit;
  for (int sweep = 0; usable && sweep < SWEEPS; sweep++) {
    double off = fabs(a.m[1]) + fabs(a.m[2]) + fabs(a.m[5]);
    if (off <= 1e-17) break; /* of the largest entry: below what the entries themselves are known to */
    for (int k = 0; k < 3; k++) {
      int p = PAIRS[k][0], q = PAIRS[k][1];
      double apq = a.m[3 * p + q], c, s;
      if (fabs(apq) <= DBL_MIN) continue;
      jacobi_rotation(a.m[4 * p], apq, a.m[4 * q], &c, &s);
      rotate_columns(&a, p, q, c, s);
      rotate_rows(&a, p, q, c, s);
      a.m[3 * p + q] = a.m[3 * q + p] = 0;
      rotate_columns(&v, p, q, c, s);
    }
  }
  int order[3] = {0, 1, 2};
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2 - i; j++)
      if (a.m[4 * order[j]] > a.m[4 * order[j + 1]]) {
        int swapped = order[j];
        order[j] = order[j + 1], order[j + 1] = swapped;
      }
  for (int i = 0; i < 3; i++) values[i] = a.m[4 * order[i]] * (usable ? unit : 1);
  SporeVec3 v0 = spore_mat3_column(v, order[0]), v1 = spore_mat3_column(v, order[1]);
  *vectors = spore_mat3_from_columns(v0, v1, spore_vec3_cross(v0, v1));
}

/* Turns f into f V with orthogonal columns, longest first, by one-sided Jacobi rotations (Hestenes 1958): unlike the
 * eigenvectors of F^T F, it keeps small stretches accurate. V is a rotation. */
static void orthogonalise_columns(SporeMat3 *f, SporeMat3 *v) {
  *v = spore_mat3_identity();
  for (int sweep = 0; sweep < SWEEPS; sweep++) {
    bool rotated = false;
    for (int k = 0; k < 3; k++) {
      int p = PAIRS[k][0], q = PAIRS[k][1];
      SporeVec3 fp = spore_mat3_column(*f, p), fq = spore_mat3_column(*f, q);
      double pp = spore_vec3_dot(fp, fp), qq = spore_vec3_dot(fq, fq), pq = spore_vec3_dot(fp, fq), c, s;
      if (pq * pq <= 1e-32 * pp * qq || fabs(pq) <= DBL_MIN) continue;
      jacobi_rotation(pp, pq, qq, &c, &s);
      rotate_columns(f, p, q, c, s);
      rotate_columns(v, p, q, c, s);
      rotated = true;
    }
    if (!rotated) break;
  }
  /* A swap with a change of sign is a rotation too. */
  for (int k = 0; k < 3; k++) {
    int p = k == 1 ? 1 : 0, q = p + 1;
    SporeVec3 fp = spore_mat3_column(*f, p), fq = spore_mat3_column(*f, q);
    if (spore_vec3_dot(fp, fp) >= spore_vec3_dot(fq, fq)) continue;
    rotate_columns(f, p, q, 0, 1);
    rotate_columns(v, p, q, 0, 1);
  }
}

/* b turned by the smallest rotation that takes unit vector `from` to unit vector `to`. */
static SporeVec3 turn_along(SporeVec3 from, SporeVec3 to, SporeVec3 b) {
  SporeVec3 axis = spore_vec3_cross(from, to);
  double cosine = spore_vec3_dot(from, to);
  if (cosine < -0.999999) { /* half a turn about any axis across `from` */
    SporeVec3 across = fabs(from.x) < 0.6 ? (SporeVec3){1, 0, 0} : (SporeVec3){0, 1, 0};
    axis = spore_vec3_normalise(spore_vec3_cross(from, across), (SporeVec3){0, 0, 1});
    return spore_vec3_sub(spore_vec3_scale(2 * spore_vec3_dot(axis, b), axis), b);
  }
  SporeVec3 turned = spore_vec3_add(spore_vec3_scale(cosine, b), spore_vec3_cross(axis, b));
  return spore_vec3_add_scaled(turned, spore_vec3_dot(axis, b) / (1 + cosine), axis);
}

static SporeVec3 part_across(SporeVec3 a, SporeVec3 unit) {
  return spore_vec3_add_scaled(a, -spore_vec3_dot(a, unit), unit);
}

/* Newton's iteration R <- (R + R^-T) / 2 (Higham 1986), which converges to the rotation of F where det F > 0: five or
 * six rounds of a few dozen flops for the mildly stretched matrices that make nearly all calls. False, nothing
 * written, where F is inverted or too flat for it. */
static bool polar_by_newton(SporeMat3 f, SporeMat3 *rotation) {
  SporeMat3 r = f;
  for (int round = 0; round < 12; round++) {
    SporeVec3 a = spore_vec3_load(r.m), b = spore_vec3_load(r.m + 3), c = spore_vec3_load(r.m + 6);
    SporeVec3 bc = spore_vec3_cross(b, c), ca = spore_vec3_cross(c, a), ab = spore_vec3_cross(a, b);
    double determinant = spore_vec3_dot(a, bc);
    if (!(determinant > 0.05 && determinant < 20)) return false;
    double half = 0.5 / determinant;
    SporeMat3 next = {{0.5 * a.x + half * bc.x, 0.5 * a.y + half * bc.y, 0.5 * a.z + half * bc.z,
                       0.5 * b.x + half * ca.x, 0.5 * b.y + half * ca.y, 0.5 * b.z + half * ca.z,
                       0.5 * c.x + half * ab.x, 0.5 * c.y + half * ab.y, 0.5 * c.z + half * ab.z}};
    double change = 0;
    for (int i = 0; i < 9; i++) change += (next.m[i] - r.m[i]) * (next.m[i] - r.m[i]);
    r = next;
    if (change < 1e-18) { /* the error left is the square of the change */
      *rotation = r;
      return true;
    }
  }
  return false;
}

void spore_mat3_polar(SporeMat3 f, SporeMat3 *rotation, SporeMat3 *stretch) {
  if (polar_by_newton(f, rotation)) {
    SporeMat3 s = spore_mat3_multiply(spore_mat3_transpose(*rotation), f);
    *stretch = spore_mat3_scale(0.5, spore_mat3_add(s, spore_mat3_transpose(s)));
    return;
  }
  double unit = largest_entry(f);
  if (!is_finite(f) || unit == 0) {
    *rotation = spore_mat3_identity();
    *stretch = f;
    return;
  }
  SporeMat3 columns = f, v;
  for (int i = 0; i < 9; i++) columns.m[i] /= unit;
  orthogonalise_columns(&columns, &v);
  SporeVec3 b0 = spore_mat3_column(columns, 0), b1 = spore_mat3_column(columns, 1), b2 = spore_mat3_column(columns, 2);
  double s0 = spore_vec3_length(b0), s1 = spore_vec3_length(b1);
  SporeVec3 u0 = spore_vec3_scale(1 / s0, b0), v0 = spore_mat3_column(v, 0), v1 = spore_mat3_column(v, 1);
  if (s1 <= 1e-15 * s0) b1 = turn_along(v0, u0, v1); /* rank 1: the missing axes turn as little as they can */
  SporeVec3 u1 = part_across(b1, u0);
  u1 = spore_vec3_scale(1 / spore_vec3_length(u1), u1);
  /* The third axis follows from handedness; where F is inverted its stretch is the negative one. */
  SporeVec3 u2 = spore_vec3_cross(u0, u1);
  double s2 = spore_vec3_dot(u2, b2);
  SporeMat3 v_transposed = spore_mat3_transpose(v);
  *rotation = spore_mat3_multiply(spore_mat3_from_columns(u0, u1, u2), v_transposed);
  SporeMat3 scaled = spore_mat3_multiply(v, spore_mat3_diagonal(s0 * unit, s1 * unit, s2 * unit));
  *stretch = spore_mat3_multiply(scaled, v_transposed);
  for (int k = 0; k < 3; k++) { /* symmetric to the last bit */
    int upper = 3 * PAIRS[k][0] + PAIRS[k][1], lower = 3 * PAIRS[k][1] + PAIRS[k][0];
    stretch->m[upper] = stretch->m[lower] = 0.5 * (stretch->m[upper] + stretch->m[lower]);
  }
}
