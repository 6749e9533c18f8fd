/* St Venant-Kirchhoff elasticity: the law, and its kernels. */
#include "models/tetrahedra/axes.h"

#define SPORE_MATERIAL saint_venant_kirchhoff
#define SPORE_LAW_TURNS 0

typedef struct Law {
  double mu;
  SporeBulk bulk;
} Law;

SPORE_INLINE Law law_of(SporeElasticity elasticity) {
  return (Law){elasticity.mu, spore_bulk(elasticity.lambda, 0, 0, spore_bulk_local(elasticity.lambda, elasticity.mu))};
}

/* E, Green's strain */
SPORE_INLINE SporeVd33 strain_of(const SporeVd33 *f) {
  SporeVd33 strain;
  SPORE_UNROLL for (int i = 0; i < 3; i++) SPORE_UNROLL for (int j = i; j < 3; j++) {
    SporeVd entry = f->m[i] * f->m[j] + f->m[3 + i] * f->m[3 + j] + f->m[6 + i] * f->m[6 + j];
    strain.m[3 * i + j] = strain.m[3 * j + i] = 0.5 * (i == j ? entry - 1 : entry);
  }
  return strain;
}

/* t = tr E, T = F */
SPORE_INLINE SporeVd law_volume(Law law, const SporePoint *at) {
  return 0.5 * (spore_vd33_product(&at->f, &at->f) - 3);
}
SPORE_INLINE SporeVd33 law_spread(Law law, const SporePoint *at) { return at->f; }

SPORE_INLINE SporeVd33 law_stress(Law law, const SporePoint *at, SporeVd pressure) {
  SporeVd33 second = strain_of(&at->f);
  SPORE_UNROLL for (int k = 0; k < 9; k++) second.m[k] *= 2 * law.mu;
  SPORE_UNROLL for (int k = 0; k < 9; k += 4) second.m[k] += pressure;
  return spore_vd33_multiply(&at->f, &second);
}

SPORE_INLINE SporeVd law_density(Law law, const SporePoint *at) {
  SporeVd33 strain = strain_of(&at->f);
  return law.mu * spore_vd33_product(&strain, &strain);
}

/* p_i = s_i (pressure + mu (s_i^2 - 1)), whose quotients come out without a division. */
SPORE_INLINE void law_add_stiffness(Law law, SporeVd weight, const SporeVd33 *inverse, const SporePoint *at,
                                    SporeVd pressure, double bulk, bool whole, SporeElementBlocks *blocks) {
  SporeAxesStiffness stiffness;
  SporeVd33 hessian;
  SporeVdEigen eigen = spore_axes_of(at, &stiffness);
  const SporeVd *s = eigen.value;
  SPORE_UNROLL for (int k = 0; k < 3; k++) {
    int i = (k + 1) % 3, j = (k + 2) % 3;
    SporeVd squares = pressure + law.mu * (s[i] * s[i] + s[j] * s[j] - 1), product = s[i] * s[j];
    hessian.m[4 * k] = pressure + law.mu * (3 * s[k] * s[k] - 1) + bulk * s[k] * s[k];
    hessian.m[3 * i + j] = hessian.m[3 * j + i] = bulk * product;
    spore_axes_set_shear(&stiffness, k, squares - law.mu * product, squares + law.mu * product, whole);
  }
  spore_axes_set_stretch(&stiffness, &hessian, whole);
  spore_axes_add(&stiffness, weight, inverse, blocks);
}

#include "models/tetrahedra/loops.h"
