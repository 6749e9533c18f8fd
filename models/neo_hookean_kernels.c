#include <math.h>

#include "models/tetrahedra_lanes.h"

typedef struct Constants {
  double m, l, alpha;
} Constants;

SPORE_INLINE Constants constants_of(SporeElasticity elasticity) {
  double m = 4.0 / 3 * elasticity.mu, l = elasticity.lambda + 5.0 / 6 * elasticity.mu;
  return (Constants){m, l, 1 + 0.75 * m / l};
}

SPORE_INLINE SporeVd determinant_of(const SporeVd33 *f, const SporeVd33 *c) {
  return f->m[0] * c->m[0] + f->m[1] * c->m[1] + f->m[2] * c->m[2];
}

SPORE_INLINE SporeVd33 elastic_stress(Constants by, const SporeVd33 *f) {
  SporeVd33 c = spore_vd33_cofactor(f), stress;
  SporeVd of_f = by.m - by.m / (spore_vd33_product(f, f) + 1), of_c = by.l * (determinant_of(f, &c) - by.alpha);
  SPORE_UNROLL for (int k = 0; k < 9; k++) stress.m[k] = of_f * f->m[k] + of_c * c.m[k];
  return stress;
}

void SPORE_LEVEL_NAME(spore_neo_hookean_force)(const SporeTetrahedra *tetrahedra, size_t slab,
                                               SporeElasticity elasticity, const double *q, const double *shape,
                                               const double *v, double *f) {
  SporeParts parts = spore_parts_of_slab(tetrahedra, slab);
  Constants by = constants_of(elasticity);
  for (size_t n = parts.first; n < parts.end; n++) {
    SporePart part = spore_part_at(tetrahedra, n);
    SporeVd33 gradient = spore_part_gradient(&part, q), stress = elastic_stress(by, &gradient);
    if (elasticity.viscosity > 0 && shape != q) gradient = spore_part_gradient(&part, shape);
    if (elasticity.viscosity > 0) spore_part_add_viscous(&part, elasticity, &gradient, v, &stress);
    spore_part_add_forces(tetrahedra, &part, &stress, f);
  }
}

double SPORE_LEVEL_NAME(spore_neo_hookean_potential)(const SporeTetrahedra *tetrahedra, SporeElasticity elasticity,
                                                     const double *q) {
  SporeParts parts = spore_parts_of_all(tetrahedra);
  Constants by = constants_of(elasticity);
  double lanes[SPORE_LANES] = {0};
  for (size_t n = parts.first; n < parts.end; n++) {
    SporePart part = spore_part_at(tetrahedra, n);
    SporeVd33 f = spore_part_gradient(&part, q), c = spore_vd33_cofactor(&f);
    SporeVd stretch = spore_vd33_product(&f, &f) - 3, determinant = determinant_of(&f, &c), logarithm;
    for (int i = 0; i < SPORE_WIDTH; i++) logarithm[i] = log1p(0.25 * stretch[i]);
    SporeVd density =
        0.5 * by.m * (stretch - logarithm) + 0.5 * by.l * (determinant - 1) * (determinant + (1 - 2 * by.alpha));
    double *lane = lanes + part.lane;
    spore_vd_store(lane, spore_vd_load(lane) + part.volume * density);
  }
  return spore_lanes_sum(lanes);
}

/* The stiffness in the axes of F = U diag(s) V^T (Smith, De Goes and Kim 2019), without what is negative in it: of
 * stretches U e_i e_i^T V^T among each other, and of shears in the plane across axis k, the sum of which and the
 * transposed sum are twist and flip: their eigenvalues are a + b s_k and a - b s_k with a = m (1 - 1/(I + 1)) and
 * b = l (J - alpha). */
typedef struct Stiffness {
  SporeVd33 u, v;    /* axes in columns */
  SporeVd33 stretch; /* of s_i and s_j */
  SporeVd same[3];   /* of a shear in plane k with itself, and with its transpose */
  SporeVd transpose[3];
} Stiffness;

SPORE_INLINE SporeVd positive(SporeVd a) { return spore_vd_max(a, spore_vd_all(0)); }

SPORE_INLINE SporeVd33 without_negative(const SporeVd33 *a) {
  SporeVdEigen eigen = spore_vd33_eigen(a);
  SporeVd33 b = {0};
  SPORE_UNROLL for (int k = 0; k < 3; k++)
      spore_vd33_add_outer(&b, spore_vd3_scale(positive(eigen.value[k]), eigen.axis[k]), eigen.axis[k]);
  return b;
}

SPORE_INLINE Stiffness stiffness_of(Constants by, const SporeVd33 *f, const SporeRotation *rotation) {
  SporeVd33 symmetric = spore_rotation_stretch(rotation, f), hessian;
  SporeVdEigen eigen = spore_vd33_eigen(&symmetric);
  const SporeVd *s = eigen.value;
  SporeVd inverse = 1 / (s[0] * s[0] + s[1] * s[1] + s[2] * s[2] + 1);
  SporeVd a = by.m - by.m * inverse, b = by.l * (s[0] * s[1] * s[2] - by.alpha), c = 2 * by.m * inverse * inverse;
  Stiffness stiffness;
  SPORE_UNROLL for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    SporeVd area = s[j] * s[k], next = s[i] * s[k];
    hessian.m[4 * i] = a + c * s[i] * s[i] + by.l * area * area;
    hessian.m[3 * i + j] = hessian.m[3 * j + i] = c * s[i] * s[j] + by.l * area * next + b * s[k];
    SporeVd twist = positive(a + b * s[i]), flip = positive(a - b * s[i]);
    stiffness.same[i] = 0.5 * (flip + twist), stiffness.transpose[i] = 0.5 * (flip - twist);
    SporeVd3 v = eigen.axis[i], u = spore_vd33_apply(&rotation->r, v);
    stiffness.v.m[i] = v.x, stiffness.v.m[3 + i] = v.y, stiffness.v.m[6 + i] = v.z;
    stiffness.u.m[i] = u.x, stiffness.u.m[3 + i] = u.y, stiffness.u.m[6 + i] = u.z;
  }
  stiffness.stretch = without_negative(&hessian);
  return stiffness;
}

/* What corner b's gradient h does to corner a's, g, both along the axes V. */
SPORE_INLINE SporeVd33 block_of(const Stiffness *stiffness, SporeVd3 g, SporeVd3 h) {
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

SPORE_INLINE void add_stiffness(const SporePart *part, const Stiffness *stiffness, double by,
                                SporeElementBlocks *blocks) {
  SporeVd33 across = spore_vd33_transpose(&stiffness->v), back = spore_vd33_transpose(&stiffness->u);
  SporeVd volume = part->volume * by;
  SporeVd3 along[3];
  SPORE_UNROLL for (int a = 0; a < 3; a++) along[a] = spore_vd33_apply(&across, spore_vd33_row(&part->inverse, a));
  int n = 0;
  SPORE_UNROLL for (int a = 0; a < 3; a++) SPORE_UNROLL for (int b = a; b < 3; b++, n++) {
    SporeVd33 block = block_of(stiffness, spore_vd3_scale(volume, along[a]), along[b]);
    SporeVd33 half = spore_vd33_multiply(&stiffness->u, &block), turned = spore_vd33_multiply(&half, &back);
    SPORE_UNROLL for (int k = 0; k < 9; k++) blocks->m[n].m[k] += turned.m[k];
  }
}

void SPORE_LEVEL_NAME(spore_neo_hookean_jacobian)(const SporeTetrahedra *tetrahedra, size_t slab,
                                                  SporeElasticity elasticity, const double *q, const double *shape,
                                                  double stiffness_scale, double damping_scale,
                                                  SporeBlockMatrix *matrix) {
  SporeParts parts = spore_parts_of_slab(tetrahedra, slab);
  double viscous = damping_scale * elasticity.viscosity;
  Constants by = constants_of(elasticity);
  SporeChunk chunk;
  for (size_t first = parts.first; first < parts.end; first += SPORE_TOGETHER) {
    spore_chunk_begin(tetrahedra, first, parts.end, q, &chunk);
    for (size_t n = 0; n < chunk.count; n++) {
      SporePart part = spore_part_at(tetrahedra, first + n);
      SporeVd33 gradient = chunk.gradient[n];
      SporeElementBlocks blocks = {0};
      if (stiffness_scale != 0) {
        SporeRotation rotation = spore_chunk_rotation(&chunk, n);
        Stiffness stiffness = stiffness_of(by, &gradient, &rotation);
        add_stiffness(&part, &stiffness, stiffness_scale, &blocks);
      }
      if (viscous != 0 && shape != q) gradient = spore_part_gradient(&part, shape);
      if (viscous != 0) spore_part_add_viscosity(&part, elasticity, damping_scale, &gradient, &blocks);
      spore_part_add_blocks(tetrahedra, &part, &blocks, matrix);
    }
  }
}
