/* Corotated linear elasticity: the law, and its kernels. */
#include "models/tetrahedra/lanes.h"

#define SPORE_MATERIAL corotation
#define SPORE_LAW_TURNS 1

typedef struct Law {
  double mu;
  SporeBulk bulk;
} Law;

SPORE_INLINE Law law_of(SporeElasticity elasticity) {
  return (Law){elasticity.mu, spore_bulk(elasticity.lambda, 0, 0, spore_bulk_local(elasticity.lambda, elasticity.mu))};
}

/* t = tr S - 3, T = R */
SPORE_INLINE SporeVd law_volume(Law law, const SporePoint *at) { return at->rotation.sum - 3; }
SPORE_INLINE SporeVd33 law_spread(Law law, const SporePoint *at) { return at->rotation.r; }

SPORE_INLINE SporeVd33 law_stress(Law law, const SporePoint *at, SporeVd pressure) {
  SporeVd33 stress;
  SporeVd factor = pressure - 2 * law.mu;
  SPORE_UNROLL for (int k = 0; k < 9; k++) stress.m[k] = 2 * law.mu * at->f.m[k] + factor * at->rotation.r.m[k];
  return stress;
}

SPORE_INLINE SporeVd law_density(Law law, const SporePoint *at) {
  SporeVd33 strain = at->f;
  SPORE_UNROLL for (int k = 0; k < 9; k++) strain.m[k] -= at->rotation.r.m[k];
  return law.mu * spore_vd33_product(&strain, &strain);
}

/* The stiffness of F is 2 mu I + lambda vec(R) vec(R)^T + sum over the three twists of c_k vec(Q_k) vec(Q_k)^T, where
 * Q_k = R [s_k]x / sqrt 2, s_k an eigenvector of S, and c_k = (pressure - 2 mu) 2 / (the other two stretches).
 * 2 mu + c_k is the eigenvalue of that twist; unless the stiffness is to be whole, it is clamped to be no less than 0.
 */
SPORE_INLINE void law_add_stiffness(Law law, SporeVd weight, const SporeVd33 *inverse, const SporePoint *at,
                                    SporeVd pressure, double bulk, bool whole, SporeElementBlocks *blocks) {
  SporeVd33 stretch = spore_rotation_stretch(&at->rotation, &at->f);
  SporeVdEigen eigen = spore_vd33_eigen(&stretch);
  SporeVd factor = pressure - 2 * law.mu;
  SporeVd3 gradient[3], along[3], twisted[3][3];
  SPORE_UNROLL for (int a = 0; a < 3; a++) {
    gradient[a] = spore_vd33_row(inverse, a);
    along[a] = spore_vd33_apply(&at->rotation.r, gradient[a]);
  }
  SporeVd coefficient[3];
  SPORE_UNROLL for (int k = 0; k < 3; k++) {
    SporeVd others = spore_vd_max(eigen.value[(k + 1) % 3] + eigen.value[(k + 2) % 3], spore_vd_all(1e-6));
    SporeVd twist = factor / others;
    coefficient[k] = weight * (whole ? twist : spore_vd_max(twist, spore_vd_all(-law.mu)));
    SporeVd3 axis = spore_vd33_apply(&at->rotation.r, eigen.axis[k]);
    SPORE_UNROLL for (int a = 0; a < 3; a++) twisted[k][a] = spore_vd3_cross(axis, along[a]);
  }
  int n = 0;
  SPORE_UNROLL for (int a = 0; a < 3; a++) {
    SporeVd3 left[4] = {spore_vd3_scale(weight * bulk, along[a]), spore_vd3_scale(coefficient[0], twisted[0][a]),
                        spore_vd3_scale(coefficient[1], twisted[1][a]), spore_vd3_scale(coefficient[2], twisted[2][a])};
    SPORE_UNROLL for (int b = a; b < 3; b++, n++) {
      SporeVd same = weight * (2 * law.mu) * spore_vd3_dot(gradient[a], gradient[b]);
      spore_vd33_add_outer(&blocks->m[n], left[0], along[b]);
      SPORE_UNROLL for (int k = 0; k < 3; k++) spore_vd33_add_outer(&blocks->m[n], left[k + 1], twisted[k][b]);
      SPORE_UNROLL for (int i = 0; i < 9; i += 4) blocks->m[n].m[i] += same;
    }
  }
}

#include "models/tetrahedra/loops.h"
