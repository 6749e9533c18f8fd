/* What the kernels of all materials of tetrahedra share: deformation gradients, rotations, viscosity, and where forces
 * and blocks go; for kernel files. */
#ifndef SPORE_MODELS_TETRAHEDRA_LANES_H
#define SPORE_MODELS_TETRAHEDRA_LANES_H

#include <assert.h>

#include "core/math/mat3.h"
#include "core/math/simd_matrix.h"
#include "models/common/block_rows.h"
#include "models/tetrahedra/tetrahedra.h"

/* A part of a batch as wide as the instruction set. */
typedef struct SporePart {
  const SporeTetrahedronBatch *batch;
  size_t index, lane; /* of the batch; the part's first in it */
  SporeVd33 inverse;
  SporeVd volume;
} SporePart;

SPORE_INLINE SporePart spore_part_of(const SporeTetrahedra *tetrahedra, size_t batch, size_t lane) {
  assert(batch < tetrahedra->batch_count);
  assert(lane < SPORE_LANES && lane % SPORE_WIDTH == 0);
  SporePart part = {.batch = tetrahedra->batches + batch, .index = batch, .lane = lane};
  SPORE_UNROLL for (int k = 0; k < 9; k++) part.inverse.m[k] = spore_vd_load(part.batch->inverse[k] + lane);
  part.volume = spore_vd_load(part.batch->volume + lane);
  return part;
}

/* (x1 - x0, x2 - x0, x3 - x0) Dm^-1: F of positions, its rate of velocities. */
SPORE_INLINE SporeVd33 spore_part_gradient(const SporePart *part, const double *x) {
  SporeVd3 origin = spore_vd3_gather(x, part->batch->node[0] + part->lane);
  SporeVd33 edges;
  SPORE_UNROLL for (int k = 0; k < 3; k++) {
    SporeVd3 edge = spore_vd3_sub(spore_vd3_gather(x, part->batch->node[k + 1] + part->lane), origin);
    edges.m[k] = edge.x, edges.m[3 + k] = edge.y, edges.m[6 + k] = edge.z;
  }
  return spore_vd33_multiply(&edges, &part->inverse);
}

typedef struct SporeRotation {
  SporeVd33 r;
  SporeVd sum; /* of stretches, tr S */
} SporeRotation;

/* By the general decomposition: for lanes where stretches are nearly opposite, so that the closed form has too few
 * digits left, or where stretches are so far from 1 that the closed form would overflow. */
static __attribute__((noinline)) void spore_rotate_one_by_one(const SporeVd33 *f, SporeVl lanes,
                                                              SporeRotation *rotation) {
  for (int i = 0; i < SPORE_WIDTH; i++) {
    if (!lanes[i]) continue;
    SporeMat3 gradient, r, s;
    for (int k = 0; k < 9; k++) gradient.m[k] = f->m[k][i];
    spore_mat3_polar(gradient, &r, &s);
    for (int k = 0; k < 9; k++) rotation->r.m[k][i] = r.m[k];
    rotation->sum[i] = spore_mat3_trace(s);
  }
}

/* What the greatest root depends on: invariants of F^T F, and det F. */
typedef struct SporeInvariants {
  SporeVd first, second, determinant;
} SporeInvariants;

SPORE_INLINE SporeInvariants spore_invariants_of(const SporeVd33 *f, const SporeVd33 *c) {
  return (SporeInvariants){spore_vd33_product(f, f), spore_vd33_product(c, c),
                           f->m[0] * c->m[0] + f->m[1] * c->m[1] + f->m[2] * c->m[2]};
}

/* Parts whose roots are sought together: the rounds of one part depend on each other, the rounds of different parts do
 * not. */
#define SPORE_TOGETHER 4

/* The greatest roots by Newton's method from the right, where it is monotonic: no root is greater than (3 I)^1/2. A
 * lane that has converged stays as it is, whatever its neighbours need. */
SPORE_INLINE void spore_greatest_roots(const SporeInvariants of[SPORE_TOGETHER], SporeVd sum[SPORE_TOGETHER],
                                       SporeVl failed[SPORE_TOGETHER]) {
  SPORE_UNROLL for (int n = 0; n < SPORE_TOGETHER; n++) {
    sum[n] = spore_vd_sqrt(3 * of[n].first);
    failed[n] = (SporeVl){0} - 1;
  }
  SporeVl going = failed[0];
  for (int round = 0; round < 16 && spore_vl_any(going); round++) {
    going = (SporeVl){0};
    SPORE_UNROLL for (int n = 0; n < SPORE_TOGETHER; n++) {
      SporeVd twice = sum[n] * sum[n] - of[n].first;
      SporeVd value = twice * twice - (8 * of[n].determinant * sum[n] + 4 * of[n].second);
      SporeVd change = value / (4 * sum[n] * twice - 8 * of[n].determinant);
      sum[n] = spore_vd_select(failed[n], sum[n] - change, sum[n]);
      failed[n] &= spore_vd_abs(change) > 1e-9 * sum[n]; /* the error after this round is its square */
      going |= failed[n];
    }
  }
}

/* Some parts with their F, and what of the rotations takes longest. */
typedef struct SporeChunk {
  size_t count;
  SporeVd33 gradient[SPORE_TOGETHER], cofactor[SPORE_TOGETHER];
  SporeInvariants invariants[SPORE_TOGETHER];
  SporeVd sum[SPORE_TOGETHER];
  SporeVl failed[SPORE_TOGETHER];
} SporeChunk;

/* Parts of the batches before. */
SPORE_INLINE size_t spore_parts_before(size_t batch) { return batch * (SPORE_LANES / SPORE_WIDTH); }

typedef struct SporeParts {
  size_t first, end;
} SporeParts;

SPORE_INLINE SporeParts spore_parts_of_slab(const SporeTetrahedra *tetrahedra, size_t slab) {
  assert(slab < tetrahedra->slab_count);
  const uint32_t *start = tetrahedra->slab_start + slab;
  return (SporeParts){spore_parts_before(start[0]), spore_parts_before(start[1])};
}

SPORE_INLINE SporeParts spore_parts_of_all(const SporeTetrahedra *tetrahedra) {
  return (SporeParts){0, spore_parts_before(tetrahedra->batch_count)};
}

SPORE_INLINE SporePart spore_part_at(const SporeTetrahedra *tetrahedra, size_t index) {
  return spore_part_of(tetrahedra, index / (SPORE_LANES / SPORE_WIDTH),
                       index % (SPORE_LANES / SPORE_WIDTH) * SPORE_WIDTH);
}

/* From the gradients to the roots. */
SPORE_INLINE void spore_chunk_solve(SporeChunk *chunk) {
  SPORE_UNROLL for (size_t n = 0; n < SPORE_TOGETHER; n++) {
    chunk->cofactor[n] = spore_vd33_cofactor(&chunk->gradient[n]);
    chunk->invariants[n] = spore_invariants_of(&chunk->gradient[n], &chunk->cofactor[n]);
  }
  spore_greatest_roots(chunk->invariants, chunk->sum, chunk->failed);
}

SPORE_INLINE void spore_chunk_begin(const SporeTetrahedra *tetrahedra, size_t first, size_t end, const double *q,
                                    SporeChunk *chunk) {
  assert(first < end);
  size_t left = end - first;
  chunk->count = left < SPORE_TOGETHER ? left : SPORE_TOGETHER;
  for (size_t n = 0; n < SPORE_TOGETHER; n++) { /* behind the last part: that again */
    SporePart part = spore_part_at(tetrahedra, first + (n < chunk->count ? n : chunk->count - 1));
    chunk->gradient[n] = spore_part_gradient(&part, q);
  }
  spore_chunk_solve(chunk);
}

/* R of F = R S from the root i: with II_S = s1 s2 + s2 s3 + s3 s1 and C = F^T F, the derivative of the quartic is
 * R = (F ((II_S + I) 1 - C) + i cof F) / (i II_S - J). */
SPORE_INLINE SporeRotation spore_chunk_rotation(const SporeChunk *chunk, size_t n) {
  assert(n < SPORE_TOGETHER);
  const SporeVd33 *f = &chunk->gradient[n], *c = &chunk->cofactor[n];
  SporeInvariants of = chunk->invariants[n];
  SporeRotation rotation = {.sum = chunk->sum[n]};
  SporeVd pairs = 0.5 * (rotation.sum * rotation.sum - of.first);
  SporeVd divisor = rotation.sum * pairs - of.determinant; /* (s1 + s2) (s2 + s3) (s3 + s1) */
  SporeVd inverse = 1 / divisor, by_cofactor = rotation.sum * inverse;
  SporeVd33 factor;
  SPORE_UNROLL for (int i = 0; i < 3; i++) SPORE_UNROLL for (int j = i; j < 3; j++) {
    SporeVd entry = f->m[i] * f->m[j] + f->m[3 + i] * f->m[3 + j] + f->m[6 + i] * f->m[6 + j];
    factor.m[3 * i + j] = factor.m[3 * j + i] = inverse * (i == j ? pairs + of.first - entry : -entry);
  }
  rotation.r = spore_vd33_multiply(f, &factor);
  SPORE_UNROLL for (int k = 0; k < 9; k++) rotation.r.m[k] += by_cofactor * c->m[k];
  SporeVl failed = chunk->failed[n];
  failed |= ~((divisor > 0) & (divisor * divisor > 1e-6 * of.first * of.first * of.first) & (of.first > 1e-50) &
              (of.first < 1e50));
  if (__builtin_expect(spore_vl_any(failed), 0)) {
    SporeVd33 gradient = *f;
    SporeRotation mended = rotation;
    spore_rotate_one_by_one(&gradient, failed, &mended);
    rotation = mended;
  }
  return rotation;
}

/* S = R^T F, symmetric to the last bit. */
SPORE_INLINE SporeVd33 spore_rotation_stretch(const SporeRotation *rotation, const SporeVd33 *f) {
  SporeVd33 stretch;
  SPORE_UNROLL for (int i = 0; i < 3; i++) SPORE_UNROLL for (int j = i; j < 3; j++) {
    SporeVd3 ri = spore_vd33_column(&rotation->r, i), rj = spore_vd33_column(&rotation->r, j);
    stretch.m[3 * i + j] =
        0.5 * (spore_vd3_dot(ri, spore_vd33_column(f, j)) + spore_vd3_dot(rj, spore_vd33_column(f, i)));
    stretch.m[3 * j + i] = stretch.m[3 * i + j];
  }
  return stretch;
}

/* P += eta F (2 mu E' + lambda r I), with F' and the rate r of volume, which is tr E' = F : F' or a mean of it. */
SPORE_INLINE void spore_add_viscous(SporeElasticity elasticity, const SporeVd33 *f, const SporeVd33 *rate, SporeVd r,
                                    SporeVd33 *stress) {
  SporeVd33 strain, viscous;
  double mu = elasticity.viscosity * elasticity.mu, lambda = elasticity.viscosity * elasticity.lambda;
  SporeVd volumetric = lambda * r;
  SPORE_UNROLL for (int i = 0; i < 3; i++) SPORE_UNROLL for (int j = i; j < 3; j++) {
    SporeVd ab = f->m[i] * rate->m[j] + f->m[3 + i] * rate->m[3 + j] + f->m[6 + i] * rate->m[6 + j];
    SporeVd ba = f->m[j] * rate->m[i] + f->m[3 + j] * rate->m[3 + i] + f->m[6 + j] * rate->m[6 + i];
    strain.m[3 * i + j] = mu * (ab + ba);
    if (i == j) strain.m[3 * i + j] += volumetric;
    strain.m[3 * j + i] = strain.m[3 * i + j];
  }
  viscous = spore_vd33_multiply(f, &strain);
  SPORE_UNROLL for (int k = 0; k < 9; k++) stress->m[k] += viscous.m[k];
}

/* Lanes of the part that hold a tetrahedron. */
SPORE_INLINE size_t spore_part_lanes(const SporeTetrahedra *tetrahedra, const SporePart *part) {
  size_t lanes = tetrahedra->lanes[part->index];
  return lanes < part->lane ? 0 : lanes - part->lane < SPORE_WIDTH ? lanes - part->lane : SPORE_WIDTH;
}

typedef double SporeTwo __attribute__((vector_size(16), aligned(8), may_alias));

/* pull[k] = volume P Dm^-T of corner k; corner 0 takes the value that makes the sum zero. */
SPORE_INLINE void spore_corner_pulls(const SporeVd33 *inverse, SporeVd volume, const SporeVd33 *stress,
                                     SporeVd3 pull[4]) {
  const SporeVd *p = stress->m;
  pull[0] = (SporeVd3){0};
  SPORE_UNROLL for (int k = 0; k < 3; k++) {
    const SporeVd *b = inverse->m + 3 * k;
    pull[k + 1] = (SporeVd3){volume * (p[0] * b[0] + p[1] * b[1] + p[2] * b[2]),
                             volume * (p[3] * b[0] + p[4] * b[1] + p[5] * b[2]),
                             volume * (p[6] * b[0] + p[7] * b[1] + p[8] * b[2])};
    pull[0] = spore_vd3_sub(pull[0], pull[k + 1]);
  }
}

/* f -= V P Dm^-T */
SPORE_INLINE void spore_part_add_forces(const SporeTetrahedra *tetrahedra, const SporePart *part,
                                        const SporeVd33 *stress, double *f) {
  double rows[4][4 * SPORE_WIDTH];
  SporeVd3 pull[4];
  spore_corner_pulls(&part->inverse, part->volume, stress, pull);
  SPORE_UNROLL for (int k = 0; k < 4; k++) spore_vd3_store_rows(rows[k], pull[k]);
  for (size_t i = 0, lanes = spore_part_lanes(tetrahedra, part); i < lanes; i++)
    SPORE_UNROLL for (int a = 0; a < 4; a++) {
      double *corner = f + 3 * (size_t)part->batch->node[a][part->lane + i];
      const double *row = rows[a] + 4 * i;
      *(SporeTwo *)corner -= *(const SporeTwo *)row, corner[2] -= row[2];
    }
}

/* SporeElementBlocks (a, b) of an element's matrix for corners 1 <= a <= b <= 3, at these places: 11 12 13 22 23 33. */
typedef struct SporeElementBlocks {
  SporeVd33 m[6];
} SporeElementBlocks;

/* -df/dv of the viscous force between corners a and b, with F b_a the gradients pushed forward:
 *   V eta (mu (b_a . b_b) F F^T + mu (F b_b)(F b_a)^T + lambda (F b_a)(F b_b)^T); weight is V eta. */
SPORE_INLINE void spore_add_viscosity(SporeVd weight, double mu_, double lambda_, const SporeVd33 *inverse,
                                      const SporeVd33 *f, SporeElementBlocks *blocks) {
  SporeVd mu = weight * mu_, lambda = weight * lambda_;
  SporeVd3 gradient[3], pushed[3];
  SporeVd33 square;
  SPORE_UNROLL for (int i = 0; i < 3; i++) SPORE_UNROLL for (int j = 0; j < 3; j++) square.m[3 * i + j] =
      spore_vd3_dot(spore_vd33_row(f, i), spore_vd33_row(f, j));
  SPORE_UNROLL for (int a = 0; a < 3; a++) {
    gradient[a] = spore_vd33_row(inverse, a);
    pushed[a] = spore_vd33_apply(f, gradient[a]);
  }
  int n = 0;
  SPORE_UNROLL for (int a = 0; a < 3; a++) SPORE_UNROLL for (int b = a; b < 3; b++, n++) {
    SporeVd same = mu * spore_vd3_dot(gradient[a], gradient[b]);
    SPORE_UNROLL for (int i = 0; i < 9; i++) blocks->m[n].m[i] += same * square.m[i];
    spore_vd33_add_outer(&blocks->m[n], spore_vd3_scale(mu, pushed[b]), pushed[a]);
    spore_vd33_add_outer(&blocks->m[n], spore_vd3_scale(lambda, pushed[a]), pushed[b]);
  }
}

typedef double SporeBlockRows[3][4 * SPORE_WIDTH];

SPORE_INLINE void spore_store_block(SporeBlockRows *rows, const SporeVd33 *block) {
  SPORE_UNROLL for (int i = 0; i < 3; i++) spore_vd3_store_rows((*rows)[i], spore_vd33_row(block, i));
}

/* All 16 blocks of the elements' matrices. Rows and columns add up to zero, which gives the blocks of corner 0. */
SPORE_INLINE void spore_store_blocks(SporeBlockRows rows[16], const SporeElementBlocks *blocks) {
  static const int place[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  SporeVd33 corner = {0};
  SPORE_UNROLL for (int a = 0; a < 3; a++) {
    SporeVd33 column = {0}; /* block (0, a + 1) */
    SPORE_UNROLL for (int b = 0; b < 3; b++) {
      SporeVd33 block = blocks->m[place[a][b]], flipped = spore_vd33_transpose(&block);
      if (b < a) block = flipped, flipped = blocks->m[place[a][b]];
      spore_store_block(&rows[4 * (a + 1) + b + 1], &block);
      SPORE_UNROLL for (int k = 0; k < 9; k++) column.m[k] -= flipped.m[k];
    }
    spore_store_block(&rows[a + 1], &column);
    SPORE_UNROLL for (int k = 0; k < 9; k++) corner.m[k] -= column.m[k];
    column = spore_vd33_transpose(&column);
    spore_store_block(&rows[4 * (a + 1)], &column);
  }
  spore_store_block(&rows[0], &corner);
}

/* One element after the other, whatever the width. */
SPORE_INLINE void spore_part_add_blocks(const SporeTetrahedra *tetrahedra, const SporePart *part,
                                        const SporeElementBlocks *blocks, SporeBlockMatrix *matrix) {
  SporeBlockRows rows[16];
  spore_store_blocks(rows, blocks);
  for (size_t i = 0, lanes = spore_part_lanes(tetrahedra, part); i < lanes; i++) {
    const uint32_t *place = tetrahedra->blocks + 16 * (SPORE_LANES * part->index + part->lane + i);
    for (int pair = 0; pair < 16; pair++) spore_block_add_rows(matrix->values + 9 * (size_t)place[pair], rows[pair], i);
  }
}

/* A point at which a material is evaluated: F, cof F, and where the caller needs it the rotation of F. */
typedef struct SporePoint {
  SporeVd33 f, c;
  SporeRotation rotation;
} SporePoint;

SPORE_INLINE SporePoint spore_point_of(const SporeVd33 *f) {
  return (SporePoint){.f = *f, .c = spore_vd33_cofactor(f)};
}

SPORE_INLINE SporePoint spore_chunk_point(const SporeChunk *chunk, size_t n) {
  return (SporePoint){chunk->gradient[n], chunk->cofactor[n], spore_chunk_rotation(chunk, n)};
}

/* A point by itself, with its rotation. */
SPORE_INLINE SporePoint spore_point_turned(const SporeVd33 *f) {
  SporeChunk chunk = {.count = 1};
  SPORE_UNROLL for (int n = 0; n < SPORE_TOGETHER; n++) chunk.gradient[n] = *f;
  spore_chunk_solve(&chunk);
  return spore_chunk_point(&chunk, 0);
}

/* The part of a material that resists the change of volume: energy density k/2 (t - balance)^2, less its value at t =
 * still, where the material is at rest. An element of several points takes the mean of t, and adds local/2 times the
 * mean square of the deviations from that mean: otherwise its points could swell and shrink against each other at no
 * cost. */
typedef struct SporeBulk {
  double k, balance, still, local;
} SporeBulk;

/* Of lambda. Up to a Poisson's ratio of 0.25 all of it is local, and the element is the plain one. Near 0.5 a bar of
 * two cells across bends too little where more of it is local, and one of a single cell too far where less is
 * (tests/stability/test_locking.c). */
SPORE_INLINE double spore_bulk_local(double lambda, double mu) { return fmin(lambda, mu); }

SPORE_INLINE SporeBulk spore_bulk(double k, double balance, double still, double local) {
  assert(k >= 0 && local >= 0);
  return (SporeBulk){k, balance, still, local};
}

SPORE_INLINE SporeVd spore_bulk_pressure(SporeBulk bulk, SporeVd t) { return bulk.k * (t - bulk.balance); }
SPORE_INLINE SporeVd spore_bulk_density(SporeBulk bulk, SporeVd t) {
  return 0.5 * bulk.k * (t - bulk.still) * (t + (bulk.still - 2 * bulk.balance));
}

#endif
