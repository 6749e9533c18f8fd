/* Stiffness of an isotropic material in the axes of F = U diag(s) V^T; for kernel files.
 *
 * With p_i the derivatives of the energy density by the stretches, the stiffness consists of the derivatives of p_i by
 * the stretches, and of the shears in the plane across axis k, between the other two axes i and j: twists, with the
 * eigenvalue (p_i + p_j)/(s_i + s_j), and flips, with (p_i - p_j)/(s_i - s_j) (Smith, De Goes and Kim 2019, "Analytic
 * eigensystems for isotropic distortion energies"). Negative eigenvalues are left out, unless the stiffness is to be
 * whole. */
#ifndef SPORE_MODELS_TETRAHEDRA_AXES_H
#define SPORE_MODELS_TETRAHEDRA_AXES_H

#include "models/tetrahedra/lanes.h"

typedef struct SporeAxesStiffness {
  SporeVd33 u, v;    /* axes in columns */
  SporeVd33 stretch; /* of s_i and s_j */
  SporeVd same[3];   /* of a shear in plane k with itself, and with its transpose */
  SporeVd transpose[3];
} SporeAxesStiffness;

SPORE_INLINE SporeVd spore_positive(SporeVd a) { return spore_vd_max(a, spore_vd_all(0)); }

SPORE_INLINE SporeVd33 spore_without_negative(const SporeVd33 *a) {
  SporeVdEigen eigen = spore_vd33_eigen(a);
  SporeVd33 b = {0};
  SPORE_UNROLL for (int k = 0; k < 3; k++)
      spore_vd33_add_outer(&b, spore_vd3_scale(spore_positive(eigen.value[k]), eigen.axis[k]), eigen.axis[k]);
  return b;
}

/* Stretches and axes at a point with its rotation. */
SPORE_INLINE SporeVdEigen spore_axes_of(const SporePoint *at, SporeAxesStiffness *stiffness) {
  SporeVd33 symmetric = spore_rotation_stretch(&at->rotation, &at->f);
  SporeVdEigen eigen = spore_vd33_eigen(&symmetric);
  SPORE_UNROLL for (int i = 0; i < 3; i++) {
    SporeVd3 v = eigen.axis[i], u = spore_vd33_apply(&at->rotation.r, v);
    stiffness->v.m[i] = v.x, stiffness->v.m[3 + i] = v.y, stiffness->v.m[6 + i] = v.z;
    stiffness->u.m[i] = u.x, stiffness->u.m[3 + i] = u.y, stiffness->u.m[6 + i] = u.z;
  }
  return eigen;
}

SPORE_INLINE void spore_axes_set_stretch(SporeAxesStiffness *stiffness, const SporeVd33 *hessian, bool whole) {
  stiffness->stretch = whole ? *hessian : spore_without_negative(hessian);
}

SPORE_INLINE void spore_axes_set_shear(SporeAxesStiffness *stiffness, int k, SporeVd twist, SporeVd flip, bool whole) {
  if (!whole) twist = spore_positive(twist), flip = spore_positive(flip);
  stiffness->same[k] = 0.5 * (flip + twist), stiffness->transpose[k] = 0.5 * (flip - twist);
}

/* What corner b's gradient h does to corner a's, g, both along the axes V. */
SPORE_INLINE SporeVd33 spore_axes_block(const SporeAxesStiffness *stiffness, SporeVd3 g, SporeVd3 h) {
  const SporeVd left[3] = {g.x, g.y, g.z}, right[3] = {h.x, h.y, h.z};
  SporeVd33 block;
  SPORE_UNROLL for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    block.m[4 * i] = stiffness->stretch.m[4 * i] * left[i] * right[i] + stiffness->same[k] * left[j] * right[j] +
                     stiffness->same[j] * left[k] * right[k];
    block.m[3 * i + j] =
        stiffness->stretch.m[3 * i + j] * left[i] * right[j] + stiffness->transpose[k] * left[j] * right[i];
    block.m[3 * j + i] =
        stiffness->stretch.m[3 * i + j] * left[j] * right[i] + stiffness->transpose[k] * left[i] * right[j];
  }
  return block;
}

/* blocks += weight times it, for the corners' gradients: rows of `inverse`. */
SPORE_INLINE void spore_axes_add(const SporeAxesStiffness *stiffness, SporeVd weight, const SporeVd33 *inverse,
                                 SporeElementBlocks *blocks) {
  SporeVd33 across = spore_vd33_transpose(&stiffness->v), back = spore_vd33_transpose(&stiffness->u);
  SporeVd3 along[3];
  SPORE_UNROLL for (int a = 0; a < 3; a++) along[a] = spore_vd33_apply(&across, spore_vd33_row(inverse, a));
  int n = 0;
  SPORE_UNROLL for (int a = 0; a < 3; a++) SPORE_UNROLL for (int b = a; b < 3; b++, n++) {
    SporeVd33 block = spore_axes_block(stiffness, spore_vd3_scale(weight, along[a]), along[b]);
    SporeVd33 half = spore_vd33_multiply(&stiffness->u, &block), turned = spore_vd33_multiply(&half, &back);
    SPORE_UNROLL for (int k = 0; k < 9; k++) blocks->m[n].m[k] += turned.m[k];
  }
}

#endif
