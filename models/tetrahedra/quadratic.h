/* Tetrahedra of ten nodes, one a lane: the corners and the middles of the edges, straight at rest; for kernel files.
 *
 * With the weights L of the corners, shape functions are L_i (2 L_i - 1) and 4 L_i L_j. Their gradients are those of
 * the four L, which are constant, times numbers of the point. */
#ifndef SPORE_MODELS_TETRAHEDRA_QUADRATIC_H
#define SPORE_MODELS_TETRAHEDRA_QUADRATIC_H

#include <assert.h>

#include "models/tetrahedra/lanes.h"

/* Point g has L_g = (5 + 3 sqrt 5)/20 and the others (5 - sqrt 5)/20, and a quarter of the volume. */
#define SPORE_TEN_POINTS 4
#define SPORE_TEN_PAIRS 55

static const int spore_ten_edges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

SPORE_INLINE double spore_ten_weight(int point, int corner) {
  assert(point >= 0 && point < SPORE_TEN_POINTS);
  return corner == point ? 0.58541019662496845446 : 0.13819660112501051518;
}

/* A vector a node, or a gradient of one. */
typedef struct SporeTen {
  SporeVd3 node[10];
} SporeTen;

SPORE_INLINE SporeTen spore_ten_gather(const SporeTetrahedra *tetrahedra, const SporePart *part, const double *x) {
  assert(tetrahedra->middles);
  const SporeMiddleBatch *middles = tetrahedra->middles + part->index;
  SporeTen ten;
  for (int a = 0; a < 4; a++) ten.node[a] = spore_vd3_gather(x, part->batch->node[a] + part->lane);
  for (int e = 0; e < 6; e++) ten.node[4 + e] = spore_vd3_gather(x, middles->node[e] + part->lane);
  return ten;
}

/* sum over the nodes of x_a grad N_a^T at a point */
SPORE_INLINE SporeVd33 spore_ten_gradient(const SporeTen *x, int point, const SporeVd33 *inverse) {
  SporeVd3 along[4]; /* dx/dL */
  SporeVd33 edges;
  SPORE_UNROLL for (int i = 0; i < 4; i++) along[i] =
      spore_vd3_scale(spore_vd_all(4 * spore_ten_weight(point, i) - 1), x->node[i]);
  SPORE_UNROLL for (int e = 0; e < 6; e++) {
    int i = spore_ten_edges[e][0], j = spore_ten_edges[e][1];
    along[i] = spore_vd3_add(along[i], spore_vd3_scale(spore_vd_all(4 * spore_ten_weight(point, j)), x->node[4 + e]));
    along[j] = spore_vd3_add(along[j], spore_vd3_scale(spore_vd_all(4 * spore_ten_weight(point, i)), x->node[4 + e]));
  }
  SPORE_UNROLL for (int k = 0; k < 3; k++) {
    SporeVd3 edge = spore_vd3_sub(along[k + 1], along[0]);
    edges.m[k] = edge.x, edges.m[3 + k] = edge.y, edges.m[6 + k] = edge.z;
  }
  return spore_vd33_multiply(&edges, inverse);
}

/* pull_a += volume P grad N_a at a point */
SPORE_INLINE void spore_ten_spread(const SporeVd33 *inverse, SporeVd volume, const SporeVd33 *stress, int point,
                                   SporeTen *pull) {
  SporeVd3 corner[4];
  spore_corner_pulls(inverse, volume, stress, corner);
  SPORE_UNROLL for (int i = 0; i < 4; i++) pull->node[i] =
      spore_vd3_add(pull->node[i], spore_vd3_scale(spore_vd_all(4 * spore_ten_weight(point, i) - 1), corner[i]));
  SPORE_UNROLL for (int e = 0; e < 6; e++) {
    int i = spore_ten_edges[e][0], j = spore_ten_edges[e][1];
    SporeVd3 both = spore_vd3_add(spore_vd3_scale(spore_vd_all(4 * spore_ten_weight(point, j)), corner[i]),
                                  spore_vd3_scale(spore_vd_all(4 * spore_ten_weight(point, i)), corner[j]));
    pull->node[4 + e] = spore_vd3_add(pull->node[4 + e], both);
  }
}

SPORE_INLINE size_t spore_ten_node(const SporeTetrahedra *tetrahedra, const SporePart *part, size_t i, int a) {
  size_t lane = part->lane + i;
  return a < 4 ? part->batch->node[a][lane] : tetrahedra->middles[part->index].node[a - 4][lane];
}

/* f -= pull, one element after the other, whatever the width. */
SPORE_INLINE void spore_ten_add_forces(const SporeTetrahedra *tetrahedra, const SporePart *part, const SporeTen *pull,
                                       double *f) {
  double rows[10][4 * SPORE_WIDTH];
  for (int a = 0; a < 10; a++) spore_vd3_store_rows(rows[a], pull->node[a]);
  for (size_t i = 0, lanes = spore_part_lanes(tetrahedra, part); i < lanes; i++)
    for (int a = 0; a < 10; a++) {
      double *node = f + 3 * spore_ten_node(tetrahedra, part, i, a);
      for (int k = 0; k < 3; k++) node[k] -= rows[a][4 * i + (size_t)k];
    }
}

/* Blocks (a, b), a <= b, one row of pairs after the other. */
typedef struct SporeTenBlocks {
  SporeVd33 m[SPORE_TEN_PAIRS];
} SporeTenBlocks;

/* A node's gradient at a point: at most two of the corners', each times a number. */
typedef struct SporeTenFactor {
  int corner[2], count;
  double by[2];
} SporeTenFactor;

SPORE_INLINE SporeTenFactor spore_ten_factor(int point, int a) {
  assert(a >= 0 && a < 10);
  if (a < 4) return (SporeTenFactor){{a, a}, 1, {4 * spore_ten_weight(point, a) - 1, 0}};
  int i = spore_ten_edges[a - 4][0], j = spore_ten_edges[a - 4][1];
  return (SporeTenFactor){{i, j}, 2, {4 * spore_ten_weight(point, j), 4 * spore_ten_weight(point, i)}};
}

/* All blocks of the corners; rows and columns add up to nothing. */
SPORE_INLINE void spore_ten_corners(const SporeElementBlocks *blocks, SporeVd33 all[4][4]) {
  static const int place[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  all[0][0] = (SporeVd33){0};
  for (int a = 0; a < 3; a++) {
    all[0][a + 1] = (SporeVd33){0};
    for (int b = 0; b < 3; b++) {
      SporeVd33 block = blocks->m[place[a][b]];
      if (b < a) block = spore_vd33_transpose(&block);
      all[a + 1][b + 1] = block;
      block = spore_vd33_transpose(&block);
      for (int k = 0; k < 9; k++) all[0][a + 1].m[k] -= block.m[k];
    }
    all[a + 1][0] = spore_vd33_transpose(&all[0][a + 1]);
    for (int k = 0; k < 9; k++) all[0][0].m[k] -= all[0][a + 1].m[k];
  }
}

/* blocks += what the corners' blocks at a point make of the nodes' */
SPORE_INLINE void spore_ten_expand(const SporeElementBlocks *corners, int point, SporeTenBlocks *blocks) {
  SporeVd33 all[4][4];
  spore_ten_corners(corners, all);
  SporeVd33 *block = blocks->m;
  for (int a = 0; a < 10; a++)
    for (int b = a; b < 10; b++, block++) {
      SporeTenFactor left = spore_ten_factor(point, a), right = spore_ten_factor(point, b);
      for (int i = 0; i < left.count; i++)
        for (int j = 0; j < right.count; j++) {
          double by = left.by[i] * right.by[j];
          const SporeVd33 *from = &all[left.corner[i]][right.corner[j]];
          SPORE_UNROLL for (int k = 0; k < 9; k++) block->m[k] += by * from->m[k];
        }
    }
}

/* blocks += by x x^T */
SPORE_INLINE void spore_ten_add_outer(SporeVd by, const SporeTen *x, SporeTenBlocks *blocks) {
  SporeVd33 *block = blocks->m;
  for (int a = 0; a < 10; a++) {
    SporeVd3 left = spore_vd3_scale(by, x->node[a]);
    for (int b = a; b < 10; b++, block++) spore_vd33_add_outer(block, left, x->node[b]);
  }
}

/* One element after the other, whatever the width. */
SPORE_INLINE void spore_ten_add_blocks(const SporeTetrahedra *tetrahedra, const SporePart *part,
                                       const SporeTenBlocks *blocks, SporeBlockMatrix *matrix) {
  double entries[SPORE_TEN_PAIRS][9][SPORE_WIDTH];
  for (int pair = 0; pair < SPORE_TEN_PAIRS; pair++)
    for (int k = 0; k < 9; k++) spore_vd_store(entries[pair][k], blocks->m[pair].m[k]);
  for (size_t i = 0, lanes = spore_part_lanes(tetrahedra, part); i < lanes; i++) {
    const uint32_t *place = tetrahedra->blocks + 100 * (SPORE_LANES * part->index + part->lane + i);
    for (int a = 0, pair = 0; a < 10; a++)
      for (int b = a; b < 10; b++, pair++) {
        double *upper = matrix->values + 9 * (size_t)place[10 * a + b];
        double *lower = matrix->values + 9 * (size_t)place[10 * b + a];
        for (int k = 0; k < 9; k++) upper[k] += entries[pair][k][i];
        for (int k = 0; a != b && k < 9; k++) lower[3 * (k % 3) + k / 3] += entries[pair][k][i];
      }
  }
}

#endif
