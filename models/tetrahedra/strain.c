/* How far tetrahedra are stretched. */
#include <assert.h>
#include <math.h>

#include "core/math/mat3.h"
#include "models/tetrahedra/tetrahedra.h"

/* C = F^T F, whose eigenvalues are the squares of the stretches. */
static SporeMat3 squares(const SporeTetrahedronBatch *batch, size_t lane, const double *q) {
  SporeVec3 origin = spore_vec3_load(q + 3 * (size_t)batch->node[0][lane]), f[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  for (int k = 0; k < 3; k++) {
    SporeVec3 edge = spore_vec3_sub(spore_vec3_load(q + 3 * (size_t)batch->node[k + 1][lane]), origin);
    for (int j = 0; j < 3; j++) f[j] = spore_vec3_add_scaled(f[j], batch->inverse[3 * k + j][lane], edge);
  }
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

/* The eigenvalues are found of those elements alone that may be stretched more than all before. */
double spore_tetrahedra_strain(const SporeTetrahedra *tetrahedra, const double *q) {
  assert(tetrahedra->batch_count > 0);
  double most = 0;
  for (size_t n = 0; n < tetrahedra->batch_count; n++) {
    for (size_t lane = 0; lane < tetrahedra->lanes[n]; lane++) {
      SporeMat3 c = squares(&tetrahedra->batches[n], lane, q), vectors;
      double values[3];
      if (!(bound(&c) > most)) continue;
      spore_mat3_eigen_symmetric(c, values, &vectors);
      most = fmax(most, values[2]);
    }
  }
  return sqrt(most) - 1;
}
