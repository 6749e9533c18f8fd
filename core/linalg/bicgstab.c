/* Stabilised biconjugate gradients. */
#include "core/linalg/bicgstab.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/math/vector.h"

static SporeLinearResult ended(SporeLinearStatus status, size_t iterations, double residual) {
  return (SporeLinearResult){status, iterations, residual};
}

/* sqrt(r.P^-1 r / b.P^-1 b), infinite where P or the numbers gave way. */
static double relative(double rz, double start) { return rz >= 0 && isfinite(rz) ? sqrt(rz / start) : INFINITY; }

/* For each vector w of residual kind, as r, there is wz = P^-1 w. r and z become s, then the next r. */
SporeLinearResult spore_bicgstab(const SporeLinearOperator *operator, const double * b, double tolerance,
                                 size_t iterations, double *x, double *scratch) {
  assert(operator->multiply && operator->precondition);
  assert(tolerance >= 0);
  assert(x != b || operator->count == 0);
  size_t n = operator->count;
  double *r = scratch, *z = r + n, *p = z + n, *v = p + n, *vz = v + n, *t = vz + n, *tz = t + n, *shadow = tz + n;
  memset(x, 0, n * sizeof *x);
  memcpy(r, b, n * sizeof *r);
  memcpy(shadow, b, n * sizeof *shadow);
  operator->precondition(operator->data, r, z);
  double start = spore_vector_dot(n, r, z), rho = start;
  if (start == 0) return ended(SPORE_LINEAR_CONVERGED, 0, 0);
  if (!(start > 0) || !isfinite(start)) return ended(SPORE_LINEAR_BREAKDOWN, 0, INFINITY);
  memcpy(p, z, n * sizeof *p);
  for (size_t iteration = 1; iteration <= iterations; iteration++) {
    if (spore_cancel_asked(operator->cancel)) {
      memset(x, 0, n * sizeof *x);
      return ended(SPORE_LINEAR_BREAKDOWN, iteration, INFINITY);
    }
    operator->multiply(operator->data, p, v);
    operator->precondition(operator->data, v, vz);
    double alpha = rho / spore_vector_dot(n, shadow, vz);
    if (!isfinite(alpha)) return ended(SPORE_LINEAR_BREAKDOWN, iteration, INFINITY);
    spore_vector_add_scaled(n, x, alpha, p);
    spore_vector_add_scaled(n, r, -alpha, v);
    spore_vector_add_scaled(n, z, -alpha, vz);
    double residual = relative(spore_vector_dot(n, r, z), start);
    if (residual <= tolerance) return ended(SPORE_LINEAR_CONVERGED, iteration, residual);
    operator->multiply(operator->data, z, t);
    operator->precondition(operator->data, t, tz);
    double omega = spore_vector_dot(n, t, z) / spore_vector_dot(n, t, tz);
    if (!isfinite(omega) || omega == 0) return ended(SPORE_LINEAR_BREAKDOWN, iteration, INFINITY);
    spore_vector_add_scaled(n, x, omega, z);
    spore_vector_add_scaled(n, r, -omega, t);
    spore_vector_add_scaled(n, z, -omega, tz);
    residual = relative(spore_vector_dot(n, r, z), start);
    if (residual <= tolerance) return ended(SPORE_LINEAR_CONVERGED, iteration, residual);
    if (spore_patience_ends(&operator->patience, iteration, residual, tolerance))
      return ended(SPORE_LINEAR_TOO_MANY, iteration, residual);
    double next = spore_vector_dot(n, shadow, z), beta = next / rho * (alpha / omega);
    if (!isfinite(beta)) return ended(SPORE_LINEAR_BREAKDOWN, iteration, INFINITY);
    rho = next;
    spore_vector_add_scaled(n, p, -omega, vz);
    spore_vector_scale_add(n, p, beta, z);
  }
  return ended(SPORE_LINEAR_TOO_MANY, iterations, INFINITY);
}
