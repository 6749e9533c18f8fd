/* The stable neo-Hookean law in the form that models/tetrahedra/loops.h describes; for kernel files. */
#ifndef SPORE_MODELS_TETRAHEDRA_NEO_HOOKEAN_LAW_H
#define SPORE_MODELS_TETRAHEDRA_NEO_HOOKEAN_LAW_H

#include <math.h>

#include "models/tetrahedra/axes.h"

typedef struct Law {
  double m;
  SporeBulk bulk;
} Law;

SPORE_INLINE Law law_of(SporeElasticity elasticity) {
  double m = 4.0 / 3 * elasticity.mu, more = 5.0 / 6 * elasticity.mu, l = elasticity.lambda + more;
  double local = spore_bulk_local(elasticity.lambda, elasticity.mu) + more;
  return (Law){m, spore_bulk(l, 1 + 0.75 * m / l, 1, local)};
}

/* t = J, T = cof F */
SPORE_INLINE SporeVd law_volume(Law law, const SporePoint *at) {
  return at->f.m[0] * at->c.m[0] + at->f.m[1] * at->c.m[1] + at->f.m[2] * at->c.m[2];
}
SPORE_INLINE SporeVd33 law_spread(Law law, const SporePoint *at) { return at->c; }

SPORE_INLINE SporeVd33 law_stress(Law law, const SporePoint *at, SporeVd pressure) {
  SporeVd33 stress;
  SporeVd of_f = law.m - law.m / (spore_vd33_product(&at->f, &at->f) + 1);
  SPORE_UNROLL for (int k = 0; k < 9; k++) stress.m[k] = of_f * at->f.m[k] + pressure * at->c.m[k];
  return stress;
}

SPORE_INLINE SporeVd law_density(Law law, const SporePoint *at) {
  SporeVd stretch = spore_vd33_product(&at->f, &at->f) - 3, logarithm;
  for (int i = 0; i < SPORE_WIDTH; i++) logarithm[i] = log1p(0.25 * stretch[i]);
  return 0.5 * law.m * (stretch - logarithm);
}

/* With a = m (1 - 1/(I + 1)) and the pressure b = l (J - alpha), twist and flip are a + b s_k and a - b s_k. */
SPORE_INLINE void law_add_stiffness(Law law, SporeVd weight, const SporeVd33 *inverse, const SporePoint *at,
                                    SporeVd pressure, double bulk, bool whole, SporeElementBlocks *blocks) {
  SporeAxesStiffness stiffness;
  SporeVd33 hessian;
  SporeVdEigen eigen = spore_axes_of(at, &stiffness);
  const SporeVd *s = eigen.value;
  SporeVd inverse_square = 1 / (s[0] * s[0] + s[1] * s[1] + s[2] * s[2] + 1);
  SporeVd a = law.m - law.m * inverse_square, b = pressure, c = 2 * law.m * inverse_square * inverse_square;
  SPORE_UNROLL for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    SporeVd area = s[j] * s[k], next = s[i] * s[k];
    hessian.m[4 * i] = a + c * s[i] * s[i] + bulk * area * area;
    hessian.m[3 * i + j] = hessian.m[3 * j + i] = c * s[i] * s[j] + bulk * area * next + b * s[k];
    spore_axes_set_shear(&stiffness, i, a + b * s[i], a - b * s[i], whole);
  }
  spore_axes_set_stretch(&stiffness, &hessian, whole);
  spore_axes_add(&stiffness, weight, inverse, blocks);
}

#endif
