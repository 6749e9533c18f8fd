/* Neo-Hookean tetrahedra met one after the other, each implicitly by itself: what the method position_based asks.
 *
 * With the gradients b of the corners' weights (b_0 = -(b_1 + b_2 + b_3), the others the rows of Dm^-1), inverse masses
 * w, and G = sum w b b^T, a stress P at the end of h seconds moves the corners by -h^2 V w P b, and so F by -h^2 V P G.
 * Of P = a F + p cof F (tetrahedra.h), a = m (1 - 1/(I + 1)) and the cofactor C stay what they are, F does not, and the
 * pressure p = l (J - alpha) is linear in it:
 *   F' = F S - h^2 V p C G S,   S = (1 + h^2 V a G)^-1,
 *   p = l (J - alpha + C : (F S) - 3 J) / (1 + l h^2 V C : (C G S)),
 * since C : F = 3 J. What resists shear is implicit in this, other than in XPBD (M. Macklin, M. Mueller and N.
 * Chentanez 2016), whose two constraints resist along their gradients alone.
 *
 * Viscosity P = F T, T = eta (2 mu E' + lambda tr E' I), comes after it in the same visit: it changes the rate of
 * strain by -h V sym(F^T F T G), which is no more than that of c T, c = h V times bounds of the largest eigenvalues of
 * F^T F and G. With c in its place the parts of T with and without trace are implicit apart, each with the stiffness C
 * of its own: T = C E' / (1 + C c). It damps at any step, and somewhat less than it should where C c is large. */
#ifndef SPORE_MODELS_TETRAHEDRA_SWEEP_H
#define SPORE_MODELS_TETRAHEDRA_SWEEP_H

#include "models/tetrahedra/tetrahedra.h"

#define SPORE_TETRAHEDRA_SWEEP_PART 0.8 /* SporeModelSweep.part */

typedef struct SporeTetrahedraSweep {
  size_t count;
  SporeTetrahedronBatch *batches; /* of one batch no two have a node in common; lanes without one repeat the first */
  uint8_t *lanes;                 /* count: how many hold a tetrahedron */
  uint32_t *source;               /* count x SPORE_LANES: which tetrahedron of the other batches it is */
  bool stale;                     /* those have changed */
} SporeTetrahedraSweep;

/* False: no memory; to be cleared all the same. */
bool spore_tetrahedra_sweep_create(SporeTetrahedraSweep *sweep, const SporeTetrahedra *tetrahedra, size_t node_count);
void spore_tetrahedra_sweep_clear(SporeTetrahedraSweep *sweep);
void spore_tetrahedra_sweep(SporeTetrahedraSweep *sweep, const SporeTetrahedra *tetrahedra, SporeElasticity elasticity,
                            const SporeSweep *at);

SPORE_DECLARE_KERNEL(void, spore_tetrahedra_sweep_batches, const SporeTetrahedraSweep *sweep,
                     SporeElasticity elasticity, const SporeSweep *at);

#endif
