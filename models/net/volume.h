/* The pressure with which a closed surface keeps its volume: U = K (V - V0)^2 / (2 |V0|), so that p = -K (V - V0) /
 * |V0| pushes each triangle along its normal, shared by its corners. The surface is closed, so that all pushes together
 * are neither force nor torque. */
#ifndef SPORE_MODELS_NET_VOLUME_H
#define SPORE_MODELS_NET_VOLUME_H

#include "core/body/model.h"

typedef struct SporeVolume {
  const SporeTriangleMesh *mesh; /* borrowed; closed; its vertices are the model's first nodes */
  double rest;                   /* V0, m^3; negative where the normals point inwards */
  double stiffness;              /* K, Pa; 0: it costs nothing */
  double *gradient;              /* scratch: 3 a vertex */
  uint32_t *blocks;              /* triangle x 6: where (corner k, k + 1) and (k + 1, k) lie in the model's matrix */
} SporeVolume;

/* False: no memory. */
bool spore_volume_create(SporeVolume *volume, const SporeTriangleMesh *mesh);
void spore_volume_clear(SporeVolume *volume);
/* Its blocks are edges, and what is dense is the matrix's direction. */
bool spore_volume_pattern(const SporeVolume *volume, SporeBlockPattern *pattern);
void spore_volume_find_blocks(SporeVolume *volume, const SporeBlockMatrix *matrix);

double spore_volume_at(const SporeVolume *volume, const double *q);
void spore_volume_force(const SporeVolume *volume, const double *q, double *f);
double spore_volume_potential(const SporeVolume *volume, const double *q);
/* K/|V0| g g^T, g = dV/dq, and where the tangent is to be whole -p d2V/dq2, which is indefinite. */
void spore_volume_jacobian(const SporeVolume *volume, const SporeTangent *at, SporeBlockMatrix *matrix);

#endif
