/* Springs met one after the other, each implicitly by itself: what the method position_based asks of a net.
 *
 * A spring between nodes a and b of inverse masses w moves them by s along its line n, from b to a, so that its own
 * force at the end of a step of h seconds is what moved them: with l and the nodes' displacement x - x0 as they are
 * before that, and c the damping along the line,
 *   s = -(h^2 k (l - length) + h c n.((xa - xa0) - (xb - xb0))) / (1 + (wa + wb) (h^2 k + h c)),
 *   xa += wa s n,  xb -= wb s n.
 * (M. Macklin, M. Mueller and N. Chentanez, "XPBD: position-based simulation of compliant constrained dynamics", Motion
 * in Games 2016, with one sweep a step as in M. Macklin et al., "Small steps in physics simulation", SCA 2019.) One
 * spring alone this is implicit Euler with the line held; a sweep over many springs splits their forces.
 *
 * Springs of one batch have no node in common, so that its lanes do not depend on each other. */
#ifndef SPORE_MODELS_NET_SPRINGS_SWEEP_H
#define SPORE_MODELS_NET_SPRINGS_SWEEP_H

#include "core/body/model.h"
#include "core/math/simd.h"

typedef struct SporeSprings SporeSprings;

typedef struct SporeSpringsBatch {
  uint32_t a[SPORE_LANES], b[SPORE_LANES]; /* nodes; of a lane without a spring those of the first lane */
  uint32_t slot[SPORE_LANES];              /* where the spring lies in the slots at its node a */
  double length[SPORE_LANES];              /* m, at rest */
  double share[SPORE_LANES];               /* of the stiffness; 0: the spring was cut */
  double held[SPORE_LANES];                /* 1; 0: the spring was cut, and does not damp either */
  uint32_t count;                          /* lanes that hold springs */
} SporeSpringsBatch;

typedef struct SporeSpringsSweep {
  size_t count;
  SporeSpringsBatch *batches;
  bool stale; /* lengths or shares in the slots changed */
} SporeSpringsSweep;

/* Puts the springs in batches. False: no memory. */
bool spore_springs_order(SporeSprings *springs, size_t node_count);
/* One sweep over several kinds of springs between the same nodes. */
void spore_springs_sweep(SporeSprings *springs, size_t kinds, const SporeSweep *at);

SPORE_DECLARE_KERNEL(void, spore_springs_sweep_batches, const SporeSprings *springs, const SporeSweep *at);

#endif
