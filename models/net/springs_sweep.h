/* Springs met one chain after the other, each chain implicitly by itself: what the method position_based asks of a net.
 *
 * A chain of springs i between nodes i and i + 1 of inverse masses w, with the lines d_i from node i + 1 to node i of
 * length l_i, moves its nodes by x_i += w_i (s_i d_i - s_(i-1) d_(i-1)), so that the force of each spring at the end of
 * a step of h seconds is what moved them: with K = h^2 k + h c, c the damping along the line, and x - x0 the nodes'
 * displacement before that,
 *   s_i l_i^2 (1 + K_i (w_i + w_(i+1))) - K_i (w_i d_i.d_(i-1) s_(i-1) + w_(i+1) d_i.d_(i+1) s_(i+1)) =
 *     -(h^2 k (l_i^2 - l_i length) + h c d_i.((x_i - x0_i) - (x_(i+1) - x0_(i+1)))),
 * a system with three diagonals. Of a chain of one spring that is the step of M. Macklin, M. Mueller and N. Chentanez,
 * "XPBD: position-based simulation of compliant constrained dynamics", Motion in Games 2016, with one sweep a step as
 * in M. Macklin et al., "Small steps in physics simulation", SCA 2019. It is implicit Euler with the lines held: where
 * they turn so far in it that the forces are off by a tenth, it is taken again from there. A sweep over many chains
 * splits their forces.
 *
 * Chains of one batch have no node in common. They lie side by side, SPORE_LANES of them, the longest first, or there
 * is one alone: with `width` of them, node n of lane l is entry n width + l of the batch's part of the lists, and
 * spring j leads from node j to node j + width. */
#ifndef SPORE_MODELS_NET_SPRINGS_SWEEP_H
#define SPORE_MODELS_NET_SPRINGS_SWEEP_H

#include "core/body/model.h"
#include "core/math/simd.h"

typedef struct SporeSprings SporeSprings;

typedef struct SporeSpringsBatch {
  size_t width, length;       /* length: springs of its longest chain */
  size_t node, spring, group; /* where its part of the lists begins */
} SporeSpringsBatch;

typedef struct SporeSpringsSweep {
  size_t count;
  SporeSpringsBatch *batches;
  bool whole;     /* no node is in two chains: they do not split each other's forces */
  bool stale;     /* lengths or shares in the slots changed */
  uint32_t *node; /* behind the end of a chain its last node is repeated */
  uint8_t *lanes; /* of SPORE_LANES nodes one after the other: the first of how many are no such repetition */
  uint32_t *slot; /* where a spring lies in the slots at its lower node; UINT32_MAX: there is no spring */
  double *length; /* m, at rest */
  double *share;  /* of the stiffness; 0: there is no spring, or it was cut */
  double *held;   /* 1; 0: likewise, and it does not damp either */
  double *idle;   /* 1 where there is no spring, else 0 */
  size_t room;    /* doubles of a column of `work` */
  double *work;   /* what a batch is computed in */
} SporeSpringsSweep;

#define SPORE_SPRINGS_COLUMNS 23

/* Puts the springs in batches. False: no memory. */
bool spore_springs_order(SporeSprings *springs, size_t node_count);
void spore_springs_sweep_clear(SporeSpringsSweep *sweep);
/* One sweep over several kinds of springs between the same nodes. */
void spore_springs_sweep(SporeSprings *springs, size_t kinds, const SporeSweep *at);
/* SporeModelSweep.part of them: less where the sweep splits no forces. */
double spore_springs_sweep_part(const SporeSprings *springs, size_t kinds);

SPORE_DECLARE_KERNEL(void, spore_springs_sweep_batches, const SporeSprings *springs, const SporeSweep *at);

#endif
