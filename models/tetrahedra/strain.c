/* How far tetrahedra are stretched. */
#include <assert.h>
#include <math.h>

#include "models/common/stretch.h"
#include "models/tetrahedra/tetrahedra.h"

static void find_gradient(const SporeTetrahedronBatch *batch, size_t lane, const double *q, SporeVec3 f[3]) {
  SporeVec3 origin = spore_vec3_load(q + 3 * (size_t)batch->node[0][lane]);
  for (int j = 0; j < 3; j++) f[j] = (SporeVec3){0, 0, 0};
  for (int k = 0; k < 3; k++) {
    SporeVec3 edge = spore_vec3_sub(spore_vec3_load(q + 3 * (size_t)batch->node[k + 1][lane]), origin);
    for (int j = 0; j < 3; j++) f[j] = spore_vec3_add_scaled(f[j], batch->inverse[3 * k + j][lane], edge);
  }
}

double spore_tetrahedra_strain(const SporeTetrahedra *tetrahedra, const double *q) {
  assert(tetrahedra->batch_count > 0);
  double most = 0;
  for (size_t n = 0; n < tetrahedra->batch_count; n++) {
    for (size_t lane = 0; lane < tetrahedra->lanes[n]; lane++) {
      SporeVec3 f[3];
      find_gradient(&tetrahedra->batches[n], lane, q, f);
      most = spore_stretch_square(f, most);
    }
  }
  return sqrt(most) - 1;
}
