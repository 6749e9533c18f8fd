/* Corotated linear elasticity of linear tetrahedra, eight at a time.
 *
 * F = Ds Dm^-1 = R S. Energy density mu |F - R|^2 + lambda/2 (tr S - 3)^2, so
 * P = 2 mu (F - R) + lambda (tr S - 3) R.
 * Viscosity: P += eta F (2 mu E' + lambda tr E' I) with E' = sym(F^T F'), the rate of Green's strain: at rest this is
 * stiffness-proportional damping with factor eta (s), and it keeps momentum and takes energy in any state.
 * Forces on corners 1..3 are the columns of -V P Dm^-T. */
#ifndef SPORE_MODELS_COROTATION_H
#define SPORE_MODELS_COROTATION_H

#include <stddef.h>
#include <stdint.h>

#include "core/math/mat3.h"

#define SPORE_LANES 8

/* Eight tetrahedra; unused lanes have count <= lane, zero volume and node 0. */
typedef struct SporeTetrahedronBatch {
  uint32_t node[4][SPORE_LANES];
  double inverse[9][SPORE_LANES]; /* Dm^-1, row-major, 1/m */
  double volume[SPORE_LANES];     /* m^3 */
} SporeTetrahedronBatch;

typedef struct SporeElasticity {
  double mu, lambda; /* Lame's, Pa; mu > 0 */
  double viscosity;  /* eta, s */
} SporeElasticity;

/* f += forces of the batch's first `count` tetrahedra. */
void spore_corotation_force(const SporeTetrahedronBatch *batch, size_t count, SporeElasticity elasticity,
                            const double *q, const double *v, double *f);
/* Energy of one lane, J. */
double spore_corotation_potential(const SporeTetrahedronBatch *batch, size_t lane, SporeElasticity elasticity,
                                  const double *q);
/* Blocks (a, b) of one lane's stiffness_scale (-df/dq) + damping_scale (-df/dv) for a <= b, in the order 00 01 02 03 11
 * 12 13 22 23 33, row-major; the viscous force's own dependence on q is left out. Twist modes that would make the
 * stiffness indefinite are clamped (Smith, De Goes and Kim 2019, "Analytic eigensystems for isotropic distortion
 * energies"). */
void spore_corotation_jacobian(const SporeTetrahedronBatch *batch, size_t lane, SporeElasticity elasticity,
                               const double *q, double stiffness_scale, double damping_scale, double blocks[10][9]);

#endif
