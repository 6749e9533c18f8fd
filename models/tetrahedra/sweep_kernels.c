/* Neo-Hookean tetrahedra met one after the other. */
#include "models/tetrahedra/sweep.h"

#include "models/tetrahedra/neo_hookean_law.h"

typedef struct Corners {
  SporeVd4 row[4];
  SporeVd3 gradient[4]; /* of the corners' weights */
} Corners;

SPORE_INLINE Corners corners_of(const SporeTetrahedronBatch *batch, size_t lane, const double *now) {
  Corners corners;
  SPORE_UNROLL for (int k = 0; k < 4; k++) corners.row[k] = spore_vd4_gather(now, batch->node[k] + lane);
  SPORE_UNROLL for (int k = 0; k < 3; k++) corners.gradient[k + 1] =
      (SporeVd3){spore_vd_load(batch->inverse[3 * k] + lane), spore_vd_load(batch->inverse[3 * k + 1] + lane),
                 spore_vd_load(batch->inverse[3 * k + 2] + lane)};
  SporeVd3 sum = spore_vd3_add(spore_vd3_add(corners.gradient[1], corners.gradient[2]), corners.gradient[3]);
  corners.gradient[0] = (SporeVd3){-sum.x, -sum.y, -sum.z};
  return corners;
}

SPORE_INLINE SporeVd33 gradient_of(const Corners *corners) {
  SporeVd33 f = {{{0}}};
  SporeVd3 origin = {corners->row[0].x, corners->row[0].y, corners->row[0].z};
  SPORE_UNROLL for (int k = 1; k < 4; k++) {
    SporeVd3 edge = spore_vd3_sub((SporeVd3){corners->row[k].x, corners->row[k].y, corners->row[k].z}, origin);
    spore_vd33_add_outer(&f, edge, corners->gradient[k]);
  }
  return f;
}

/* Symmetric matrices as whole ones. */
SPORE_INLINE SporeVd33 give_of(const Corners *corners) { /* G */
  SporeVd33 g = {{{0}}};
  SPORE_UNROLL for (int k = 0; k < 4; k++)
      spore_vd33_add_outer(&g, spore_vd3_scale(corners->row[k].w, corners->gradient[k]), corners->gradient[k]);
  return g;
}

/* (1 + s G)^-1, which is symmetric and at least 0 */
SPORE_INLINE SporeVd33 soften(const SporeVd33 *g, SporeVd s) {
  SporeVd33 whole;
  SPORE_UNROLL for (int k = 0; k < 9; k++) whole.m[k] = s * g->m[k] + (k % 4 == 0);
  SporeVd33 inverse = spore_vd33_cofactor(&whole);
  SporeVd one = 1 / (whole.m[0] * inverse.m[0] + whole.m[1] * inverse.m[1] + whole.m[2] * inverse.m[2]);
  SPORE_UNROLL for (int k = 0; k < 9; k++) inverse.m[k] *= one;
  return inverse;
}

/* P of the end. weight: h^2 V. */
SPORE_INLINE SporeVd33 stress_of(Law law, const Corners *corners, SporeVd weight) {
  SporeVd33 f = gradient_of(corners), c = spore_vd33_cofactor(&f), g = give_of(corners), stress;
  SporeVd j = f.m[0] * c.m[0] + f.m[1] * c.m[1] + f.m[2] * c.m[2];
  SporeVd a = law.m - law.m / (spore_vd33_product(&f, &f) + 1);
  SporeVd33 s = soften(&g, weight * a), fs = spore_vd33_multiply(&f, &s), gs = spore_vd33_multiply(&g, &s);
  SporeVd33 cgs = spore_vd33_multiply(&c, &gs);
  SporeVd promised = spore_vd33_product(&c, &fs) - 2 * j; /* J that the shear stiffness leaves */
  SporeVd p = law.bulk.k * (promised - law.bulk.balance) / (1 + law.bulk.k * weight * spore_vd33_product(&c, &cgs));
  SporeVd by = weight * p;
  SPORE_UNROLL for (int k = 0; k < 9; k++) stress.m[k] = a * (fs.m[k] - by * cgs.m[k]) + p * c.m[k];
  return stress;
}

SPORE_INLINE void pull_corners(Corners *corners, const SporeVd33 *stress, SporeVd weight) {
  SPORE_UNROLL for (int k = 0; k < 4; k++) {
    SporeVd4 *row = &corners->row[k];
    SporeVd by = weight * row->w;
    SporeVd3 pull = spore_vd33_apply(stress, corners->gradient[k]);
    row->x -= by * pull.x, row->y -= by * pull.y, row->z -= by * pull.z;
  }
}

/* No less than the largest eigenvalue of a symmetric matrix: Gershgorin. */
SPORE_INLINE SporeVd largest_of(const SporeVd33 *a) {
  SporeVd most = {0};
  SPORE_UNROLL for (int i = 0; i < 3; i++) {
    SporeVd row = {0};
    SPORE_UNROLL for (int j = 0; j < 3; j++) row += spore_vd_abs(a->m[3 * i + j]);
    most = spore_vd_max(most, row);
  }
  return most;
}

/* P of viscosity at the end of h seconds, at F: see sweep.h. moved: (F - F0), of the corners. weight: h V. */
SPORE_INLINE SporeVd33 viscous_stress(SporeElasticity elasticity, const Corners *corners, const SporeVd33 *moved,
                                      double h, SporeVd weight) {
  SporeVd33 f = gradient_of(corners), g = give_of(corners), turned = spore_vd33_transpose(&f);
  SporeVd33 square = spore_vd33_multiply(&turned, &f), along = spore_vd33_multiply(&turned, moved), strain;
  double mu = 2 * elasticity.viscosity * elasticity.mu, bulk = mu + 3 * elasticity.viscosity * elasticity.lambda;
  SporeVd give = weight * largest_of(&square) * largest_of(&g), mean = spore_vd33_product(&f, moved) * (1 / (3 * h));
  SporeVd shear = mu / (1 + mu * give), pressure = bulk / (1 + bulk * give) * mean;
  SPORE_UNROLL for (int i = 0; i < 3; i++) SPORE_UNROLL for (int j = 0; j < 3; j++) {
    SporeVd rate = (0.5 / h) * (along.m[3 * i + j] + along.m[3 * j + i]);
    if (i == j) rate -= mean;
    strain.m[3 * i + j] = shear * rate;
    if (i == j) strain.m[3 * i + j] += pressure;
  }
  return spore_vd33_multiply(&f, &strain);
}

/* F less that of the start of the step. */
SPORE_INLINE SporeVd33 moved_of(const Corners *corners, const SporeTetrahedronBatch *batch, size_t lane,
                                const double *before) {
  Corners moved = *corners;
  SPORE_UNROLL for (int k = 0; k < 4; k++) {
    SporeVd3 start = spore_vd3_gather(before, batch->node[k] + lane);
    moved.row[k].x -= start.x, moved.row[k].y -= start.y, moved.row[k].z -= start.z;
  }
  return gradient_of(&moved);
}

SPORE_INLINE void meet(Law law, SporeElasticity elasticity, const SporeTetrahedronBatch *batch, size_t lane,
                       size_t count, const SporeSweep *at) {
  Corners corners = corners_of(batch, lane, at->now);
  SporeVd volume = spore_vd_load(batch->volume + lane), weight = at->h * at->h * volume;
  SporeVd33 stress = stress_of(law, &corners, weight);
  pull_corners(&corners, &stress, weight);
  if (elasticity.viscosity > 0) {
    SporeVd33 moved = moved_of(&corners, batch, lane, at->before);
    stress = viscous_stress(elasticity, &corners, &moved, at->h, at->h * volume);
    pull_corners(&corners, &stress, weight);
  }
  SPORE_UNROLL for (int k = 0; k < 4; k++) spore_vd4_scatter(at->now, batch->node[k] + lane, count, corners.row[k]);
}

SPORE_INLINE void meet_all(const SporeTetrahedraSweep *sweep, SporeElasticity elasticity, const SporeSweep *at) {
  Law law = law_of(elasticity);
  for (size_t i = 0; i < sweep->count; i++)
    for (size_t lane = 0; lane < sweep->lanes[i]; lane += SPORE_WIDTH)
      meet(law, elasticity, &sweep->batches[i], lane, sweep->lanes[i] - lane, at);
}

void SPORE_LEVEL_NAME(spore_tetrahedra_sweep_batches)(const SporeTetrahedraSweep *sweep, SporeElasticity elasticity,
                                                      const SporeSweep *at) {
  if (elasticity.viscosity > 0) meet_all(sweep, elasticity, at);
  else {
    elasticity.viscosity = 0;
    meet_all(sweep, elasticity, at);
  }
}
