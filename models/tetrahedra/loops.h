/* The kernels of a material of tetrahedra, from its law; included once by the material's kernel file, which defines
 *
 *   SPORE_MATERIAL       its name: SPORE_MATERIAL_NAME(force) becomes spore_NAME_force_LEVEL
 *   SPORE_LAW_TURNS      whether stress and energy need the rotation of F, not F and cof F alone
 *   Law, law_of          its constants, among them `bulk` (SporeBulk), from the elasticity
 *   law_volume           t, the measure of volume change that bulk resists
 *   law_spread           T = dt/dF
 *   law_stress           P, with pressure = k (t - balance): of shear, plus pressure T
 *   law_density          energy density of shear alone
 *   law_add_stiffness    blocks += weight times what b_a, b_b (rows of `inverse`) make of dP/dF without what is
 * negative in it (whole: with it), at a pressure held fast but for bulk T T^T */
#ifndef SPORE_MODELS_TETRAHEDRA_LOOPS_H
#define SPORE_MODELS_TETRAHEDRA_LOOPS_H

#include <assert.h>

#include "models/tetrahedra/quadratic.h"

#define SPORE_JOIN_MATERIAL(material, what) spore_##material##_##what
#define SPORE_JOIN_NAMES(material, what) SPORE_JOIN_MATERIAL(material, what)
#define SPORE_MATERIAL_NAME(what) SPORE_LEVEL_NAME(SPORE_JOIN_NAMES(SPORE_MATERIAL, what))

/* What a kernel works on. */
typedef struct Work {
  const SporeTetrahedra *tetrahedra;
  SporeElasticity elasticity;
  Law law;
  const double *q, *shape, *v;
  double *f; /* forces, or the energies of the lanes */
  const SporeTangent *at;
  SporeBlockMatrix *matrix;
} Work;

/* Linear tetrahedra (four nodes). */

typedef void (*VisitPart)(const Work *work, const SporePart *part, const SporePoint *point);

SPORE_INLINE void each_part(const Work *work, SporeParts parts, int turns, VisitPart visit) {
  SporeChunk chunk;
  for (size_t n = parts.first; !turns && n < parts.end; n++) {
    SporePart part = spore_part_at(work->tetrahedra, n);
    SporeVd33 gradient = spore_part_gradient(&part, work->q);
    SporePoint point = spore_point_of(&gradient);
    visit(work, &part, &point);
  }
  for (size_t first = parts.first; turns && first < parts.end; first += SPORE_TOGETHER) {
    spore_chunk_begin(work->tetrahedra, first, parts.end, work->q, &chunk);
    for (size_t n = 0; n < chunk.count; n++) {
      SporePart part = spore_part_at(work->tetrahedra, first + n);
      SporePoint point = spore_chunk_point(&chunk, n);
      visit(work, &part, &point);
    }
  }
}

SPORE_INLINE SporeVd pressure_of(Law law, SporeVd t) { return spore_bulk_pressure(law.bulk, t); }

SPORE_INLINE void add_part_forces(const Work *work, const SporePart *part, const SporePoint *point) {
  SporeVd33 stress = law_stress(work->law, point, pressure_of(work->law, law_volume(work->law, point)));
  if (work->elasticity.viscosity > 0) {
    SporeVd33 gradient = work->shape == work->q ? point->f : spore_part_gradient(part, work->shape);
    SporeVd33 rate = spore_part_gradient(part, work->v);
    spore_add_viscous(work->elasticity, &gradient, &rate, spore_vd33_product(&gradient, &rate), &stress);
  }
  spore_part_add_forces(work->tetrahedra, part, &stress, work->f);
}

SPORE_INLINE void add_part_energy(const Work *work, const SporePart *part, const SporePoint *point) {
  SporeVd density = law_density(work->law, point) + spore_bulk_density(work->law.bulk, law_volume(work->law, point));
  double *lane = work->f + part->lane;
  spore_vd_store(lane, spore_vd_load(lane) + part->volume * density);
}

/* t where a step from another point promised it to be. */
SPORE_INLINE SporeVd promised_volume(Law law, const SporePoint *from, const SporePoint *to) {
  SporeVd33 spread = law_spread(law, from), change;
  SPORE_UNROLL for (int k = 0; k < 9; k++) change.m[k] = to->f.m[k] - from->f.m[k];
  return law_volume(law, from) + spore_vd33_product(&spread, &change);
}

/* t for the tangent. */
SPORE_INLINE SporeVd part_volume(const Work *work, const SporePart *part, const SporePoint *point) {
  if (!work->at->from) return law_volume(work->law, point);
  SporeVd33 gradient = spore_part_gradient(part, work->at->from);
  SporePoint from = SPORE_LAW_TURNS ? spore_point_turned(&gradient) : spore_point_of(&gradient);
  return promised_volume(work->law, &from, point);
}

SPORE_INLINE void add_part_matrix(const Work *work, const SporePart *part, const SporePoint *point) {
  SporeElementBlocks blocks = {0};
  if (work->at->stiffness_scale != 0)
    law_add_stiffness(work->law, part->volume * work->at->stiffness_scale, &part->inverse, point,
                      pressure_of(work->law, part_volume(work, part, point)), work->law.bulk.k, work->at->whole,
                      &blocks);
  double viscous = work->at->damping_scale * work->elasticity.viscosity;
  if (viscous != 0) {
    SporeVd33 gradient = work->shape == work->q ? point->f : spore_part_gradient(part, work->shape);
    spore_add_viscosity(part->volume * viscous, work->elasticity.mu, work->elasticity.lambda, &part->inverse, &gradient,
                        &blocks);
  }
  spore_part_add_blocks(work->tetrahedra, part, &blocks, work->matrix);
}

/* Quadratic tetrahedra (ten nodes). */

SPORE_INLINE void quadratic_points(const Work *work, const SporePart *part, const double *q, int turns,
                                   SporePoint point[SPORE_QUADRATIC_POINTS]) {
  SporeQuadraticNodes x = spore_quadratic_gather(work->tetrahedra, part, q);
  SporeChunk chunk = {.count = SPORE_QUADRATIC_POINTS};
  for (int g = 0; g < SPORE_QUADRATIC_POINTS; g++) chunk.gradient[g] = spore_quadratic_gradient(&x, g, &part->inverse);
  if (turns) spore_chunk_solve(&chunk);
  for (int g = 0; g < SPORE_QUADRATIC_POINTS; g++)
    point[g] = turns ? spore_chunk_point(&chunk, (size_t)g) : spore_point_of(&chunk.gradient[g]);
}

/* t at the points, and its mean. */
typedef struct QuadraticVolume {
  SporeVd at[SPORE_QUADRATIC_POINTS], mean;
} QuadraticVolume;

SPORE_INLINE SporeVd quadratic_mean(const SporeVd at[SPORE_QUADRATIC_POINTS]) {
  return 0.25 * ((at[0] + at[1]) + (at[2] + at[3]));
}

SPORE_INLINE QuadraticVolume quadratic_volume(Law law, const SporePoint point[SPORE_QUADRATIC_POINTS]) {
  QuadraticVolume volume;
  for (int g = 0; g < SPORE_QUADRATIC_POINTS; g++) volume.at[g] = law_volume(law, &point[g]);
  volume.mean = quadratic_mean(volume.at);
  return volume;
}

/* t for the tangent. */
SPORE_INLINE QuadraticVolume quadratic_tangent_volume(const Work *work, const SporePart *part,
                                                      const SporePoint point[SPORE_QUADRATIC_POINTS]) {
  if (!work->at->from) return quadratic_volume(work->law, point);
  SporePoint from[SPORE_QUADRATIC_POINTS];
  QuadraticVolume volume;
  quadratic_points(work, part, work->at->from, SPORE_LAW_TURNS, from);
  for (int g = 0; g < SPORE_QUADRATIC_POINTS; g++) volume.at[g] = promised_volume(work->law, &from[g], &point[g]);
  volume.mean = quadratic_mean(volume.at);
  return volume;
}

SPORE_INLINE SporeVd quadratic_pressure(Law law, const QuadraticVolume *volume, int g) {
  return pressure_of(law, volume->mean) + law.bulk.local * (volume->at[g] - volume->mean);
}

/* F and its rate at the points, and the rates of volume that viscosity resists there. */
typedef struct QuadraticRates {
  SporeVd33 gradient[SPORE_QUADRATIC_POINTS], rate[SPORE_QUADRATIC_POINTS];
  SporeVd volume[SPORE_QUADRATIC_POINTS];
} QuadraticRates;

/* Part of the viscosity against the change of volume that is local. */
SPORE_INLINE double local_part(SporeElasticity elasticity) {
  if (elasticity.lambda == 0) return 1;
  return spore_bulk_local(elasticity.lambda, elasticity.mu) / elasticity.lambda;
}

SPORE_INLINE void quadratic_rates(const Work *work, const SporePart *part, QuadraticRates *rates) {
  SporeQuadraticNodes shape = spore_quadratic_gather(work->tetrahedra, part, work->shape);
  SporeQuadraticNodes v = spore_quadratic_gather(work->tetrahedra, part, work->v);
  for (int g = 0; g < SPORE_QUADRATIC_POINTS; g++) {
    rates->gradient[g] = spore_quadratic_gradient(&shape, g, &part->inverse);
    rates->rate[g] = spore_quadratic_gradient(&v, g, &part->inverse);
    rates->volume[g] = spore_vd33_product(&rates->gradient[g], &rates->rate[g]);
  }
  SporeVd mean = quadratic_mean(rates->volume);
  double local = local_part(work->elasticity);
  for (int g = 0; g < SPORE_QUADRATIC_POINTS; g++) rates->volume[g] = mean + local * (rates->volume[g] - mean);
}

SPORE_INLINE void add_quadratic_forces(const Work *work, const SporePart *part) {
  SporePoint point[SPORE_QUADRATIC_POINTS];
  QuadraticRates rates;
  SporeQuadraticNodes pull = {0};
  quadratic_points(work, part, work->q, SPORE_LAW_TURNS, point);
  QuadraticVolume volume = quadratic_volume(work->law, point);
  if (work->elasticity.viscosity > 0) quadratic_rates(work, part, &rates);
  for (int g = 0; g < SPORE_QUADRATIC_POINTS; g++) {
    SporeVd33 stress = law_stress(work->law, &point[g], quadratic_pressure(work->law, &volume, g));
    if (work->elasticity.viscosity > 0)
      spore_add_viscous(work->elasticity, &rates.gradient[g], &rates.rate[g], rates.volume[g], &stress);
    spore_quadratic_spread(&part->inverse, part->volume / SPORE_QUADRATIC_POINTS, &stress, g, &pull);
  }
  spore_quadratic_add_forces(work->tetrahedra, part, &pull, work->f);
}

SPORE_INLINE void add_quadratic_energy(const Work *work, const SporePart *part) {
  SporePoint point[SPORE_QUADRATIC_POINTS];
  SporeVd density[SPORE_QUADRATIC_POINTS];
  quadratic_points(work, part, work->q, SPORE_LAW_TURNS, point);
  QuadraticVolume volume = quadratic_volume(work->law, point);
  for (int g = 0; g < SPORE_QUADRATIC_POINTS; g++) {
    SporeVd apart = volume.at[g] - volume.mean;
    density[g] = law_density(work->law, &point[g]) + 0.5 * work->law.bulk.local * apart * apart;
  }
  double *lane = work->f + part->lane;
  spore_vd_store(lane, spore_vd_load(lane) +
                           part->volume * (quadratic_mean(density) + spore_bulk_density(work->law.bulk, volume.mean)));
}

SPORE_INLINE void add_quadratic_stiffness(const Work *work, const SporePart *part, SporeQuadraticBlocks *blocks) {
  SporePoint point[SPORE_QUADRATIC_POINTS];
  SporeVd share = part->volume * (work->at->stiffness_scale / SPORE_QUADRATIC_POINTS);
  SporeQuadraticNodes spread = {0}; /* mean of T b_a */
  SporeBulk bulk = work->law.bulk;
  quadratic_points(work, part, work->q, 1, point);
  QuadraticVolume volume = quadratic_tangent_volume(work, part, point);
  for (int g = 0; g < SPORE_QUADRATIC_POINTS; g++) {
    SporeElementBlocks corners = {0};
    law_add_stiffness(work->law, share, &part->inverse, &point[g], quadratic_pressure(work->law, &volume, g),
                      bulk.local, work->at->whole, &corners);
    spore_quadratic_expand(&corners, g, blocks);
    SporeVd33 t = law_spread(work->law, &point[g]);
    spore_quadratic_spread(&part->inverse, spore_vd_all(1.0 / SPORE_QUADRATIC_POINTS), &t, g, &spread);
  }
  if (bulk.k > bulk.local)
    spore_quadratic_add_outer(part->volume * (work->at->stiffness_scale * (bulk.k - bulk.local)), &spread, blocks);
}

SPORE_INLINE void add_quadratic_viscosity(const Work *work, const SporePart *part, double viscous,
                                          SporeQuadraticBlocks *blocks) {
  SporeQuadraticNodes shape = spore_quadratic_gather(work->tetrahedra, part, work->shape), spread = {0};
  double local = local_part(work->elasticity) * work->elasticity.lambda;
  for (int g = 0; g < SPORE_QUADRATIC_POINTS; g++) {
    SporeElementBlocks corners = {0};
    SporeVd33 gradient = spore_quadratic_gradient(&shape, g, &part->inverse);
    spore_add_viscosity(part->volume * (viscous / SPORE_QUADRATIC_POINTS), work->elasticity.mu, local, &part->inverse,
                        &gradient, &corners);
    spore_quadratic_expand(&corners, g, blocks);
    spore_quadratic_spread(&part->inverse, spore_vd_all(1.0 / SPORE_QUADRATIC_POINTS), &gradient, g, &spread);
  }
  if (work->elasticity.lambda > local)
    spore_quadratic_add_outer(part->volume * (viscous * (work->elasticity.lambda - local)), &spread, blocks);
}

SPORE_INLINE void add_quadratic_matrix(const Work *work, const SporePart *part) {
  SporeQuadraticBlocks blocks = {0};
  double viscous = work->at->damping_scale * work->elasticity.viscosity;
  if (work->at->stiffness_scale != 0) add_quadratic_stiffness(work, part, &blocks);
  if (viscous != 0) add_quadratic_viscosity(work, part, viscous, &blocks);
  spore_quadratic_add_blocks(work->tetrahedra, part, &blocks, work->matrix);
}

typedef void (*VisitQuadratic)(const Work *work, const SporePart *part);

SPORE_INLINE void each_quadratic(const Work *work, SporeParts parts, VisitQuadratic visit) {
  for (size_t n = parts.first; n < parts.end; n++) {
    SporePart part = spore_part_at(work->tetrahedra, n);
    visit(work, &part);
  }
}

/* The kernels. */

void SPORE_MATERIAL_NAME(force)(const SporeTetrahedra *tetrahedra, size_t slab, SporeElasticity elasticity,
                                const double *q, const double *shape, const double *v, double *f) {
  assert(f != q && f != v);
  assert(elasticity.viscosity >= 0);
  SporeParts parts = spore_parts_of_slab(tetrahedra, slab);
  Work work = {.tetrahedra = tetrahedra, .elasticity = elasticity, .law = law_of(elasticity), q, shape, v, f};
  if (tetrahedra->middles) each_quadratic(&work, parts, add_quadratic_forces);
  else each_part(&work, parts, SPORE_LAW_TURNS, add_part_forces);
}

double SPORE_MATERIAL_NAME(potential)(const SporeTetrahedra *tetrahedra, SporeElasticity elasticity, const double *q) {
  double lanes[SPORE_LANES] = {0};
  SporeParts parts = spore_parts_of_all(tetrahedra);
  Work work = {.tetrahedra = tetrahedra, .law = law_of(elasticity), .q = q, .f = lanes};
  if (tetrahedra->middles) each_quadratic(&work, parts, add_quadratic_energy);
  else each_part(&work, parts, SPORE_LAW_TURNS, add_part_energy);
  return spore_lanes_sum(lanes);
}

void SPORE_MATERIAL_NAME(tangent)(const SporeTetrahedra *tetrahedra, size_t slab, SporeElasticity elasticity,
                                  const SporeTangent *at, SporeBlockMatrix *matrix) {
  assert(at->stiffness_scale >= 0);
  assert(matrix->values);
  SporeParts parts = spore_parts_of_slab(tetrahedra, slab);
  Work work = {.tetrahedra = tetrahedra,
               .elasticity = elasticity,
               .law = law_of(elasticity),
               .q = at->q,
               .shape = at->shape,
               .at = at,
               .matrix = matrix};
  if (tetrahedra->middles) each_quadratic(&work, parts, add_quadratic_matrix);
  else each_part(&work, parts, 1, add_part_matrix);
}

#endif
