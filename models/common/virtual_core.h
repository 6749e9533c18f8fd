/* A virtual rigid core that nodes are tied to (Meseure and Chaillou 2000). The core touches nothing; it gives the body
 * back its shape. Each node has a place in the core's frame and is tied to that place by a spring of no length. The
 * force of the spring acts on the core too, as force and torque, so that both momenta are kept. With x a node, c the
 * centre of the core, s = R r the place of the node in the core's frame, and d = x - c - s:
 *   on the node  -k d - b (v - V - w x (x - c)),   on the core the opposite at x.
 * A tie may be slack up to a length L, as a sheet is that folds; then k d is k (1 - L / |d|) d where |d| > L, else 0.
 * The tied nodes are the first nodes of the model, the core's centre is the node behind them, and the frame of the
 * model is the frame of the core. */
#ifndef SPORE_MODELS_COMMON_VIRTUAL_CORE_H
#define SPORE_MODELS_COMMON_VIRTUAL_CORE_H

#include "core/math/simd.h"
#include "core/body/model.h"
#include "models/common/rigid_motion.h"

/* Where a tie's blocks lie in the model's matrix: the node with itself, with the core's centre and turning, and back.
 */
typedef struct SporeVirtualCoreBlocks {
  uint32_t node, centre, turning, from_centre, from_turning;
} SporeVirtualCoreBlocks;

#define SPORE_VIRTUAL_CORE_SHORTEST 1e-300 /* m: a tie that is shorter has no direction */
typedef struct SporeVirtualCore {
  size_t count;     /* of nodes tied */
  double *weight;   /* of each tie: what it stands for (m^2 of a surface, m of a line) */
  double *place;    /* where each tie begins, in the core's frame, 3 each, m */
  double *slack;    /* up to which length each tie is slack, m; NULL: none is */
  SporeVec3 centre; /* of the core at rest, body's frame */
  SporeInertia inertia;
  double stiffness, damping; /* N/m and N s/m, for each unit of weight */
  SporeVirtualCoreBlocks *blocks;
  uint32_t centre_block, turning_block, across, back; /* of the core: diagonal ones, (centre, turning), and back */
} SporeVirtualCore;

/* Weights and places are 0. False: no memory. */
bool spore_virtual_core_allocate(SporeVirtualCore *core, size_t count);
/* Lets ties begin elsewhere than where their nodes are at rest, and be slack up to their length at rest. feet, rest:
 * count x 3, body's frame, m. After spore_virtual_core_spread. False: no memory. */
bool spore_virtual_core_slacken(SporeVirtualCore *core, const double *feet, const double *rest);
void spore_virtual_core_clear(SporeVirtualCore *core);
/* A core of `mass` (kg) that is spread as the nodes' masses are (node_mass, rest: count x 1, x 3, body's frame), each a
 * ball of `radius` (m, may be 0): same centre, same shape of inertia. Refused where it has no inertia about an axis. */
bool spore_virtual_core_spread(SporeVirtualCore *core, const double *rest, const double *node_mass, double mass,
                               double radius, SporeError *error);

bool spore_virtual_core_pattern(const SporeVirtualCore *core, SporeBlockPattern *pattern);
/* In a matrix of the model's whole pattern. */
void spore_virtual_core_find_blocks(SporeVirtualCore *core, const SporeBlockMatrix *matrix);

/* The slots of a model whose other nodes are placed and drift as material points. */
void spore_virtual_core_place(const SporeVirtualCore *core, const double *rest, SporePose pose, SporeVec3 velocity,
                              SporeVec3 spin, double *q, double *v);
SporeMat3 spore_virtual_core_inertia(const SporeVirtualCore *core, const double *q);
void spore_virtual_core_drift(const SporeVirtualCore *core, const double *q, const double *v, double h, double *q1,
                              double *v1);
double spore_virtual_core_longest_turn(const SporeVirtualCore *core, const double *q, const double *v);

/* What the ties add, as SporeModelType says. */
SPORE_DECLARE_KERNEL(void, spore_virtual_core_ties, const SporeVirtualCore *core, const SporeMat3 *rotation,
                     const double *q, const double *shape, const double *v, double *f);
void spore_virtual_core_force(const SporeVirtualCore *core, const double *q, const double *shape, const double *v,
                              double *f);
double spore_virtual_core_potential(const SporeVirtualCore *core, const double *q);
void spore_virtual_core_jacobian(const SporeVirtualCore *core, const SporeTangent *at, SporeBlockMatrix *matrix);

#endif
