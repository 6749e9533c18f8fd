/* Corotated linear elasticity of linear tetrahedra, SPORE_LANES at a time.
 *
 * F = Ds Dm^-1 = R S. Energy density mu |F - R|^2 + lambda/2 (tr S - 3)^2, so
 * P = 2 mu (F - R) + lambda (tr S - 3) R.
 * Viscosity: P += eta F (2 mu E' + lambda tr E' I) with E' = sym(F^T F'), the rate of Green's strain: at rest this is
 * stiffness-proportional damping with factor eta (s), and it keeps momentum and takes energy in any state.
 * Forces on corners 1..3 are the columns of -V P Dm^-T.
 *
 * R comes in closed form from the stretches' sum i = tr S, the greatest root of
 * (i^2 - I)^2 - 8 J i - 4 II = 0 with the invariants I, II of F^T F and J = det F, of which R is the derivative by F
 * (Lin, Chitalu and Komura 2022, "Isotropic ARAP energy using Cauchy-Green invariants"). It needs no start from a step
 * before, so that forces depend on the state alone, and it holds for inverted tetrahedra: the least stretch then counts
 * as negative. */
#ifndef SPORE_MODELS_COROTATION_H
#define SPORE_MODELS_COROTATION_H

#include "core/linalg/block_matrix.h"
#include "core/math/simd.h"

typedef struct SporeTetrahedronBatch {
  uint32_t node[4][SPORE_LANES];
  double inverse[9][SPORE_LANES]; /* Dm^-1, row-major, 1/m */
  double volume[SPORE_LANES];     /* m^3; 0 in lanes without a tetrahedron, which repeat another */
} SporeTetrahedronBatch;

/* Tetrahedron t lies in batch t % batch_count, lane t / batch_count: neighbours, which push on the same nodes, come one
 * after the other and not together. */
typedef struct SporeTetrahedra {
  size_t count, batch_count;
  SporeTetrahedronBatch *batches;
  uint32_t (
      *blocks)[SPORE_LANES][16]; /* batch_count: where corner pair (a, b) lies in the model's matrix, at 4 a + b */
} SporeTetrahedra;

typedef struct SporeElasticity {
  double mu, lambda; /* Lame's, Pa; mu > 0 */
  double viscosity;  /* eta, s */
} SporeElasticity;

SPORE_DECLARE_KERNEL(void, spore_corotation_force, const SporeTetrahedra *tetrahedra, SporeElasticity elasticity,
                     const double *q, const double *shape, const double *v, double *f);
SPORE_DECLARE_KERNEL(double, spore_corotation_potential, const SporeTetrahedra *tetrahedra, SporeElasticity elasticity,
                     const double *q);
SPORE_DECLARE_KERNEL(void, spore_corotation_jacobian, const SporeTetrahedra *tetrahedra, SporeElasticity elasticity,
                     const double *q, const double *shape, double stiffness_scale, double damping_scale,
                     SporeBlockMatrix *matrix);

/* f += forces, the viscous ones with F as it is in shape. */
static inline void spore_corotation_force(const SporeTetrahedra *tetrahedra, SporeElasticity elasticity,
                                          const double *q, const double *shape, const double *v, double *f) {
  SPORE_KERNEL(spore_corotation_force)(tetrahedra, elasticity, q, shape, v, f);
}
/* Energy, J. */
static inline double spore_corotation_potential(const SporeTetrahedra *tetrahedra, SporeElasticity elasticity,
                                                const double *q) {
  return SPORE_KERNEL(spore_corotation_potential)(tetrahedra, elasticity, q);
}
/* matrix += stiffness_scale (-df/dq) + damping_scale (-df/dv); where shape is q, the viscous force's dependence on it
 * is left out. Twist modes that would make the stiffness indefinite are clamped (Smith, De Goes and Kim 2019, "Analytic
 * eigensystems for isotropic distortion energies"). */
static inline void spore_corotation_jacobian(const SporeTetrahedra *tetrahedra, SporeElasticity elasticity,
                                             const double *q, const double *shape, double stiffness_scale,
                                             double damping_scale, SporeBlockMatrix *matrix) {
  SPORE_KERNEL(spore_corotation_jacobian)(tetrahedra, elasticity, q, shape, stiffness_scale, damping_scale, matrix);
}

#endif
