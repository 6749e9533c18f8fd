/* A virtual rigid core that nodes are tied to: it touches nothing and gives the body back its shape (Meseure and
 * Chaillou 2000). Each node has its place in the core's frame and is tied to it by a spring of no length; what the
 * spring pulls with acts on the core too, as force and torque, so that both momenta are kept. With x a node, c the
 * centre and s = R r its place in the core's frame, d = x - c - s:
 *   on the node  -k d - b (v - V - w x (x - c)),   on the core the opposite at x.
 * The tied nodes are the model's first; the core's centre is the node behind them, and the model's frame is the core's.
 */
#ifndef SPORE_MODELS_COMMON_VIRTUAL_CORE_H
#define SPORE_MODELS_COMMON_VIRTUAL_CORE_H

#include "core/math/simd.h"
#include "core/body/model.h"
#include "models/common/rigid_motion.h"

/* Where a tie's blocks lie in the model's matrix: the node with itself, with the core's centre and turning, and back.
 */
typedef struct SporeCoreBlocks {
  uint32_t node, centre, turning, from_centre, from_turning;
} SporeCoreBlocks;

typedef struct SporeCore {
  size_t count;     /* of nodes tied */
  double *weight;   /* of each tie: what it stands for (m^2 of a surface, m of a line) */
  double *place;    /* of each node in the core's frame, 3 each, m */
  SporeVec3 centre; /* of the core at rest, body's frame */
  SporeInertia inertia;
  double stiffness, damping; /* N/m and N s/m, for each unit of weight */
  SporeCoreBlocks *blocks;
  uint32_t centre_block, turning_block, across, back; /* of the core: diagonal ones, (centre, turning), and back */
} SporeCore;

/* Weights and places are 0. False: no memory. */
bool spore_core_allocate(SporeCore *core, size_t count);
void spore_core_clear(SporeCore *core);
/* A core of `mass` (kg) that is spread as the nodes' masses are (node_mass, rest: count x 1, x 3, body's frame), each a
 * ball of `radius` (m, may be 0): same centre, same shape of inertia. Refused where it has no inertia about an axis. */
bool spore_core_spread(SporeCore *core, const double *rest, const double *node_mass, double mass, double radius,
                       SporeError *error);

bool spore_core_pattern(const SporeCore *core, SporeBlockPattern *pattern);
/* In a matrix of the model's whole pattern. */
void spore_core_find_blocks(SporeCore *core, const SporeBlockMatrix *matrix);

/* The slots of a model whose other nodes are placed and drift as material points. */
void spore_core_place(const SporeCore *core, const double *rest, SporePose pose, SporeVec3 velocity, SporeVec3 spin,
                      double *q, double *v);
SporeMat3 spore_core_inertia(const SporeCore *core, const double *q);
void spore_core_drift(const SporeCore *core, const double *q, const double *v, double h, double *q1, double *v1);

/* What the ties add, as SporeModelType says. */
SPORE_DECLARE_KERNEL(void, spore_core_ties, const SporeCore *core, const SporeMat3 *rotation, const double *q,
                     const double *shape, const double *v, double *f);
void spore_core_force(const SporeCore *core, const double *q, const double *shape, const double *v, double *f);
double spore_core_potential(const SporeCore *core, const double *q);
void spore_core_jacobian(const SporeCore *core, const SporeTangent *at, SporeBlockMatrix *matrix);

#endif
