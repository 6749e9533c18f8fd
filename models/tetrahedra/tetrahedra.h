/* Tetrahedra, SPORE_LANES at a time, of several materials.
 *
 * Four nodes: F = Ds Dm^-1. Forces on corners 1..3 are the columns of -V P Dm^-T, with the stress P of the material and
 * of viscosity: P += eta F (2 mu E' + lambda tr E' I) with E' = sym(F^T F'), the rate of Green's strain: at rest this
 * is stiffness-proportional damping with factor eta (s), and it keeps momentum and takes energy in any state.
 *
 * Ten nodes, one more on the middle of each edge: F varies, and is taken at four points (Hammer's rule, exact to second
 * order). Each material's energy density is that of shear plus k/2 (t - t0)^2 in a measure t of the change of volume.
 * Near a Poisson's ratio of 0.5 most of k acts on the mean of t over the element, or the element would be too stiff
 * (Nagtegaal, Parks and Rice 1974, "On numerically accurate finite element solutions in the fully plastic range";
 * Hughes 1980, "Generalization of selective integration procedures to anisotropic and nonlinear media"). That is one
 * more term of rank one in the element's matrix, and couples no more nodes. The viscosity does the same.
 *
 * Corotated linear elasticity: F = R S, energy density mu |F - R|^2 + lambda/2 (tr S - 3)^2, so
 * P = 2 mu (F - R) + lambda (tr S - 3) R.
 * R comes in closed form from the stretches' sum i = tr S, the greatest root of
 * (i^2 - I)^2 - 8 J i - 4 II = 0 with the invariants I, II of F^T F and J = det F, of which R is the derivative by F
 * (Lin, Chitalu and Komura 2022, "Isotropic ARAP energy using Cauchy-Green invariants"). It needs no start from a step
 * before, so that forces depend on the state alone, and it holds for inverted tetrahedra: the least stretch then counts
 * as negative.
 *
 * Stable neo-Hookean (Smith, De Goes and Kim 2018, "Stable neo-Hookean flesh simulation"): with m = 4 mu / 3,
 * l = lambda + 5 mu / 6, alpha = 1 + m/l - m/(4 l) and I = |F|^2, energy density
 * m/2 (I - 3) - m/2 log((I + 1)/4) + l/2 ((J - alpha)^2 - (1 - alpha)^2), so
 * P = m (1 - 1/(I + 1)) F + l (J - alpha) cof F.
 *
 * St Venant-Kirchhoff: with Green's strain E = (F^T F - I)/2, energy density mu E:E + lambda/2 (tr E)^2, so
 * P = F (2 mu E + lambda tr E I). Squeezed below 0.58 of its length it gives way, and turned inside out it stays so. */
#ifndef SPORE_MODELS_TETRAHEDRA_TETRAHEDRA_H
#define SPORE_MODELS_TETRAHEDRA_TETRAHEDRA_H

#include "core/body/model.h"
#include "core/math/simd.h"

typedef struct SporeTetrahedronBatch {
  uint32_t node[4][SPORE_LANES];
  double inverse[9][SPORE_LANES]; /* Dm^-1, row-major, 1/m */
  double volume[SPORE_LANES];     /* m^3, times how much stiffer it is than the body; 0 in lanes without a tetrahedron,
                                     which repeat another */
} SporeTetrahedronBatch;

/* Nodes on the edges between corners 01 02 03 12 13 23. */
typedef struct SporeMiddleBatch {
  uint32_t node[6][SPORE_LANES];
} SporeMiddleBatch;

/* Slabs of the mesh: two even slabs have no node in common, nor have two odd ones. So all even slabs may be computed at
 * once on several threads, then all odd ones, and the sums at a node are added in the same order on any number of
 * threads. Of n batches in a slab, tetrahedron t of the slab lies in batch t % n, lane t / n: neighbours, which add to
 * the same nodes, then lie in different batches. */
typedef struct SporeTetrahedra {
  size_t slab_count, batch_count;
  uint32_t *slab_start; /* slab_count + 1: its first batch */
  uint8_t *lanes;       /* batch_count: how many hold a tetrahedron */
  SporeTetrahedronBatch *batches;
  SporeMiddleBatch *middles; /* batch_count; NULL: tetrahedra of four nodes */
  uint32_t *blocks;          /* batch_count x SPORE_LANES x n x n: where node pair (a, b) lies in the model's matrix */
} SporeTetrahedra;

typedef struct SporeElasticity {
  double mu, lambda; /* Lame's, Pa; mu > 0 */
  double viscosity;  /* eta, s */
} SporeElasticity;

/* Lame's parameters from Young's modulus (Pa) and Poisson's ratio. */
static inline SporeElasticity spore_elasticity(double e, double nu, double viscosity) {
  return (SporeElasticity){
      .mu = e / (2 * (1 + nu)), .lambda = e * nu / ((1 + nu) * (1 - 2 * nu)), .viscosity = viscosity};
}

/* strain.c: the largest stretch of an element, less 1. Of a quadratic element that of its corners counts. */
double spore_tetrahedra_strain(const SporeTetrahedra *tetrahedra, const double *q);

/* Kernels of a material:
 *
 * _force: f += forces of a slab, the viscous ones with F as it is in shape.
 * _potential: energy of all, J.
 * _tangent: matrix += stiffness_scale (-df/dq) + damping_scale (-df/dv) of a slab; where shape is q, the viscous
 * force's dependence on it is left out. Unless it is to be whole, modes that would make the stiffness indefinite are
 * clamped (Smith, De Goes and Kim 2019, "Analytic eigensystems for isotropic distortion energies"). Where a step led
 * from at->from to q, the pressure in it is the one that the step promised: near a Poisson's ratio of 0.5 a step that
 * turns an element changes its volume to second order only, but k times that is a pressure that hides everything else.
 */
#define SPORE_DECLARE_MATERIAL(name)                                                                                   \
  SPORE_DECLARE_KERNEL(void, spore_##name##_force, const SporeTetrahedra *tetrahedra, size_t slab,                     \
                       SporeElasticity elasticity, const double *q, const double *shape, const double *v, double *f);  \
  SPORE_DECLARE_KERNEL(double, spore_##name##_potential, const SporeTetrahedra *tetrahedra,                            \
                       SporeElasticity elasticity, const double *q);                                                   \
  SPORE_DECLARE_KERNEL(void, spore_##name##_tangent, const SporeTetrahedra *tetrahedra, size_t slab,                   \
                       SporeElasticity elasticity, const SporeTangent *at, SporeBlockMatrix *matrix)

SPORE_DECLARE_MATERIAL(corotation);
SPORE_DECLARE_MATERIAL(neo_hookean);
SPORE_DECLARE_MATERIAL(saint_venant_kirchhoff);

#endif
