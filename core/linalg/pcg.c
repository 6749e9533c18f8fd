/* Preconditioned conjugate gradients. */
#include "core/linalg/pcg.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static double dot(size_t n, const double *a, const double *b) {
  /* Four sums hide the latency of the adder; they are always added up in the same order. */
  double s[4] = {0, 0, 0, 0};
  size_t i = 0;
  for (; i + 4 <= n; i += 4)
    for (size_t k = 0; k < 4; k++) s[k] += a[i + k] * b[i + k];
  for (; i < n; i++) s[0] += a[i] * b[i];
  return (s[0] + s[1]) + (s[2] + s[3]);
}

bool spore_patience_ends(const SporePatience *patience, size_t iterations, double residual, double tolerance) {
  if (patience->least == 0 || iterations < patience->least) return false;
  if (iterations >= patience->least + patience->more || !(residual < 1)) return true;
  double all = (double)iterations * log(tolerance) / log(residual);
  return all > (double)(iterations + patience->more);
}

static SporeLinearResult broken(size_t n, double *x, size_t iterations) {
  memset(x, 0, n * sizeof *x);
  return (SporeLinearResult){SPORE_LINEAR_BREAKDOWN, iterations, INFINITY};
}

SporeLinearResult spore_pcg(const SporeLinearOperator *operator, const double * b, double tolerance, size_t iterations,
                            double *x, double *scratch) {
  assert(operator->multiply && operator->precondition);
  assert(tolerance >= 0);
  assert(x != b || operator->count == 0);
  size_t n = operator->count;
  double *r = scratch, *z = scratch + n, *p = scratch + 2 * n, *ap = scratch + 3 * n;
  memset(x, 0, n * sizeof *x);
  memcpy(r, b, n * sizeof *r);
  operator->precondition(operator->data, r, z);
  double rz = dot(n, r, z), start = rz;
  if (!isfinite(rz)) return broken(n, x, 0);
  if (rz == 0) return (SporeLinearResult){SPORE_LINEAR_CONVERGED, 0, 0};
  if (rz < 0) return (SporeLinearResult){SPORE_LINEAR_INDEFINITE, 0, 1};
  memcpy(p, z, n * sizeof *p);
  SporeLinearResult result = {SPORE_LINEAR_TOO_MANY, 0, 1};
  while (result.iterations < iterations) {
    if (spore_cancel_asked(operator->cancel)) return broken(n, x, result.iterations);
    operator->multiply(operator->data, p, ap);
    double curvature = dot(n, p, ap);
    if (!isfinite(curvature)) return broken(n, x, result.iterations);
    if (curvature <= 0) {
      if (result.iterations == 0) memcpy(x, p, n * sizeof *x);
      result.status = SPORE_LINEAR_INDEFINITE;
      return result;
    }
    double alpha = rz / curvature;
    for (size_t i = 0; i < n; i++) x[i] += alpha * p[i];
    for (size_t i = 0; i < n; i++) r[i] -= alpha * ap[i];
    operator->precondition(operator->data, r, z);
    double next = dot(n, r, z);
    result.iterations++;
    if (!isfinite(next)) return broken(n, x, result.iterations);
    if (next < 0) {
      result.status = SPORE_LINEAR_INDEFINITE;
      return result;
    }
    result.residual = sqrt(next / start);
    if (result.residual <= tolerance) {
      result.status = SPORE_LINEAR_CONVERGED;
      return result;
    }
    if (spore_patience_ends(&operator->patience, result.iterations, result.residual, tolerance)) return result;
    double beta = next / rz;
    rz = next;
    for (size_t i = 0; i < n; i++) p[i] = z[i] + beta * p[i];
  }
  return result;
}
