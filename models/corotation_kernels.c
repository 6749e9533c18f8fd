#include "models/tetrahedra_lanes.h"

SPORE_INLINE SporeVd33 elastic_stress(SporeElasticity elasticity, const SporeVd33 *f, const SporeRotation *rotation) {
  SporeVd33 stress;
  SporeVd factor = elasticity.lambda * (rotation->sum - 3) - 2 * elasticity.mu;
  SPORE_UNROLL for (int k = 0; k < 9; k++) stress.m[k] = 2 * elasticity.mu * f->m[k] + factor * rotation->r.m[k];
  return stress;
}

void SPORE_LEVEL_NAME(spore_corotation_force)(const SporeTetrahedra *tetrahedra, size_t slab,
                                              SporeElasticity elasticity, const double *q, const double *shape,
                                              const double *v, double *f) {
  SporeParts parts = spore_parts_of_slab(tetrahedra, slab);
  SporeChunk chunk;
  for (size_t first = parts.first; first < parts.end; first += SPORE_TOGETHER) {
    spore_chunk_begin(tetrahedra, first, parts.end, q, &chunk);
    for (size_t n = 0; n < chunk.count; n++) {
      SporePart part = spore_part_at(tetrahedra, first + n);
      SporeVd33 gradient = chunk.gradient[n];
      SporeRotation rotation = spore_chunk_rotation(&chunk, n);
      SporeVd33 stress = elastic_stress(elasticity, &gradient, &rotation);
      if (elasticity.viscosity > 0 && shape != q) gradient = spore_part_gradient(&part, shape);
      if (elasticity.viscosity > 0) spore_part_add_viscous(&part, elasticity, &gradient, v, &stress);
      spore_part_add_forces(tetrahedra, &part, &stress, f);
    }
  }
}

double SPORE_LEVEL_NAME(spore_corotation_potential)(const SporeTetrahedra *tetrahedra, SporeElasticity elasticity,
                                                    const double *q) {
  SporeParts parts = spore_parts_of_all(tetrahedra);
  double lanes[SPORE_LANES] = {0};
  SporeChunk chunk;
  for (size_t first = parts.first; first < parts.end; first += SPORE_TOGETHER) {
    spore_chunk_begin(tetrahedra, first, parts.end, q, &chunk);
    for (size_t n = 0; n < chunk.count; n++) {
      SporePart part = spore_part_at(tetrahedra, first + n);
      SporeVd33 strain = chunk.gradient[n];
      SporeRotation rotation = spore_chunk_rotation(&chunk, n);
      SporeVd volumetric = rotation.sum - 3;
      SPORE_UNROLL for (int k = 0; k < 9; k++) strain.m[k] -= rotation.r.m[k];
      SporeVd density =
          elasticity.mu * spore_vd33_product(&strain, &strain) + 0.5 * elasticity.lambda * volumetric * volumetric;
      double *lane = lanes + part.lane;
      spore_vd_store(lane, spore_vd_load(lane) + part.volume * density);
    }
  }
  return spore_lanes_sum(lanes);
}

/* The stiffness of F is 2 mu I + lambda vec(R) vec(R)^T + sum over the three twists of c_k vec(Q_k) vec(Q_k)^T, where
 * Q_k = R [s_k]x / sqrt 2, s_k an eigenvector of S, and c_k = (lambda (tr S - 3) - 2 mu) 2 / (the other two stretches).
 * 2 mu + c_k is the eigenvalue of that twist; it is clamped to be no less than 0. */
SPORE_INLINE void add_stiffness(const SporePart *part, SporeElasticity elasticity, double by, const SporeVd33 *f,
                                SporeRotation rotation, SporeElementBlocks *blocks) {
  SporeVd33 stretch = spore_rotation_stretch(&rotation, f);
  SporeVdEigen eigen = spore_vd33_eigen(&stretch);
  SporeVd volume = part->volume * by;
  SporeVd factor = elasticity.lambda * (rotation.sum - 3) - 2 * elasticity.mu;
  SporeVd3 gradient[3], along[3], twisted[3][3];
  SPORE_UNROLL for (int a = 0; a < 3; a++) {
    gradient[a] = spore_vd33_row(&part->inverse, a);
    along[a] = spore_vd33_apply(&rotation.r, gradient[a]);
  }
  SporeVd coefficient[3];
  SPORE_UNROLL for (int k = 0; k < 3; k++) {
    SporeVd others = spore_vd_max(eigen.value[(k + 1) % 3] + eigen.value[(k + 2) % 3], spore_vd_all(1e-6));
    coefficient[k] = volume * spore_vd_max(factor / others, spore_vd_all(-elasticity.mu));
    SporeVd3 axis = spore_vd33_apply(&rotation.r, eigen.axis[k]);
    SPORE_UNROLL for (int a = 0; a < 3; a++) twisted[k][a] = spore_vd3_cross(axis, along[a]);
  }
  int n = 0;
  SPORE_UNROLL for (int a = 0; a < 3; a++) {
    SporeVd3 left[4] = {spore_vd3_scale(volume * elasticity.lambda, along[a]),
                        spore_vd3_scale(coefficient[0], twisted[0][a]), spore_vd3_scale(coefficient[1], twisted[1][a]),
                        spore_vd3_scale(coefficient[2], twisted[2][a])};
    SPORE_UNROLL for (int b = a; b < 3; b++, n++) {
      SporeVd same = volume * (2 * elasticity.mu) * spore_vd3_dot(gradient[a], gradient[b]);
      spore_vd33_add_outer(&blocks->m[n], left[0], along[b]);
      SPORE_UNROLL for (int k = 0; k < 3; k++) spore_vd33_add_outer(&blocks->m[n], left[k + 1], twisted[k][b]);
      SPORE_UNROLL for (int i = 0; i < 9; i += 4) blocks->m[n].m[i] += same;
    }
  }
}

void SPORE_LEVEL_NAME(spore_corotation_jacobian)(const SporeTetrahedra *tetrahedra, size_t slab,
                                                 SporeElasticity elasticity, const double *q, const double *shape,
                                                 double stiffness_scale, double damping_scale,
                                                 SporeBlockMatrix *matrix) {
  SporeParts parts = spore_parts_of_slab(tetrahedra, slab);
  double viscous = damping_scale * elasticity.viscosity;
  SporeChunk chunk;
  for (size_t first = parts.first; first < parts.end; first += SPORE_TOGETHER) {
    spore_chunk_begin(tetrahedra, first, parts.end, q, &chunk);
    for (size_t n = 0; n < chunk.count; n++) {
      SporePart part = spore_part_at(tetrahedra, first + n);
      SporeVd33 gradient = chunk.gradient[n];
      SporeElementBlocks blocks = {0};
      if (stiffness_scale != 0) {
        SporeRotation rotation = spore_chunk_rotation(&chunk, n);
        add_stiffness(&part, elasticity, stiffness_scale, &gradient, rotation, &blocks);
      }
      if (viscous != 0 && shape != q) gradient = spore_part_gradient(&part, shape);
      if (viscous != 0) spore_part_add_viscosity(&part, elasticity, damping_scale, &gradient, &blocks);
      spore_part_add_blocks(tetrahedra, &part, &blocks, matrix);
    }
  }
}
