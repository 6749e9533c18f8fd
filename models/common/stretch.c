/* How far a deformation stretches. */
#include "models/common/stretch.h"

#include <assert.h>
#include <math.h>

#include "core/math/mat3.h"

/* C = F^T F, whose eigenvalues are the squares of the stretches. */
static SporeMat3 squares(const SporeVec3 f[3]) {
  SporeMat3 c;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) c.m[3 * i + j] = spore_vec3_dot(f[i], f[j]);
  return c;
}

/* No eigenvalue of a symmetric matrix is larger: their mean, and how far they lie from it in the mean square. */
static double bound(const SporeMat3 *c) {
  double mean = spore_mat3_trace(*c) / 3, apart = 0;
  for (int k = 0; k < 9; k++) {
    double entry = c->m[k] - (k % 4 == 0 ? mean : 0);
    apart += entry * entry;
  }
  return mean + sqrt(apart * 2 / 3);
}

double spore_stretch_square(const SporeVec3 f[3], double most) {
  assert(most >= 0);
  SporeMat3 c = squares(f), vectors;
  double values[3];
  if (!(bound(&c) > most)) return most;
  spore_mat3_eigen_symmetric(c, values, &vectors);
  return fmax(most, values[2]);
}
