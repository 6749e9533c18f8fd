/* Quadratic tetrahedra (ten nodes: the corners and the middles of the edges, straight at rest), one a lane; for kernel
 * files.
 *
 * With the weights L of the corners, the shape functions are L_i (2 L_i - 1) and 4 L_i L_j. Their gradients are the
 * gradients of the four L, which are constant, times numbers that depend on the point. */
#ifndef SPORE_MODELS_TETRAHEDRA_QUADRATIC_H
#define SPORE_MODELS_TETRAHEDRA_QUADRATIC_H

#include <assert.h>

#include "models/tetrahedra/lanes.h"

/* Point g has L_g = (5 + 3 sqrt 5)/20 and the others (5 - sqrt 5)/20, and a quarter of the volume. */
#define SPORE_QUADRATIC_POINTS 4
#define SPORE_QUADRATIC_PAIRS 55

static const int spore_quadratic_edges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

SPORE_INLINE double spore_quadratic_weight(int point, int corner) {
  assert(point >= 0 && point < SPORE_QUADRATIC_POINTS);
  return corner == point ? 0.58541019662496845446 : 0.13819660112501051518;
}

/* A vector for each node, or the gradient of a vector by each node. */
typedef struct SporeQuadraticNodes {
  SporeVd3 node[10];
} SporeQuadraticNodes;

SPORE_INLINE SporeQuadraticNodes spore_quadratic_gather(const SporeTetrahedra *tetrahedra, const SporePart *part,
                                                        const double *x) {
  assert(tetrahedra->middles);
  const SporeMiddleBatch *middles = tetrahedra->middles + part->index;
  SporeQuadraticNodes nodes;
  for (int a = 0; a < 4; a++) nodes.node[a] = spore_vd3_gather(x, part->batch->node[a] + part->lane);
  for (int e = 0; e < 6; e++) nodes.node[4 + e] = spore_vd3_gather(x, middles->node[e] + part->lane);
  return nodes;
}

/* sum over the nodes of x_a grad N_a^T at a point */
SPORE_INLINE SporeVd33 spore_quadratic_gradient(const SporeQuadraticNodes *x, int point, const SporeVd33 *inverse) {
  SporeVd3 along[4]; /* dx/dL */
  SporeVd33 edges;
  SPORE_UNROLL for (int i = 0; i < 4; i++) along[i] =
      spore_vd3_scale(spore_vd_all(4 * spore_quadratic_weight(point, i) - 1), x->node[i]);
  SPORE_UNROLL for (int e = 0; e < 6; e++) {
    int i = spore_quadratic_edges[e][0], j = spore_quadratic_edges[e][1];
    along[i] =
        spore_vd3_add(along[i], spore_vd3_scale(spore_vd_all(4 * spore_quadratic_weight(point, j)), x->node[4 + e]));
    along[j] =
        spore_vd3_add(along[j], spore_vd3_scale(spore_vd_all(4 * spore_quadratic_weight(point, i)), x->node[4 + e]));
  }
  SPORE_UNROLL for (int k = 0; k < 3; k++) {
    SporeVd3 edge = spore_vd3_sub(along[k + 1], along[0]);
    edges.m[k] = edge.x, edges.m[3 + k] = edge.y, edges.m[6 + k] = edge.z;
  }
  return spore_vd33_multiply(&edges, inverse);
}

/* pull_a += volume P grad N_a at a point */
SPORE_INLINE void spore_quadratic_spread(const SporeVd33 *inverse, SporeVd volume, const SporeVd33 *stress, int point,
                                         SporeQuadraticNodes *pull) {
  SporeVd3 corner[4];
  spore_corner_pulls(inverse, volume, stress, corner);
  SPORE_UNROLL for (int i = 0; i < 4; i++) pull->node[i] =
      spore_vd3_add(pull->node[i], spore_vd3_scale(spore_vd_all(4 * spore_quadratic_weight(point, i) - 1), corner[i]));
  SPORE_UNROLL for (int e = 0; e < 6; e++) {
    int i = spore_quadratic_edges[e][0], j = spore_quadratic_edges[e][1];
    SporeVd3 both = spore_vd3_add(spore_vd3_scale(spore_vd_all(4 * spore_quadratic_weight(point, j)), corner[i]),
                                  spore_vd3_scale(spore_vd_all(4 * spore_quadratic_weight(point, i)), corner[j]));
    pull->node[4 + e] = spore_vd3_add(pull->node[4 + e], both);
  }
}

SPORE_INLINE size_t spore_quadratic_node(const SporeTetrahedra *tetrahedra, const SporePart *part, size_t i, int a) {
  size_t lane = part->lane + i;
  return a < 4 ? part->batch->node[a][lane] : tetrahedra->middles[part->index].node[a - 4][lane];
}

/* f -= pull, one element after the other, whatever the width. */
SPORE_INLINE void spore_quadratic_add_forces(const SporeTetrahedra *tetrahedra, const SporePart *part,
                                             const SporeQuadraticNodes *pull, double *f) {
  double rows[10][4 * SPORE_WIDTH];
  for (int a = 0; a < 10; a++) spore_vd3_store_rows(rows[a], pull->node[a]);
  for (size_t i = 0, lanes = spore_part_lanes(tetrahedra, part); i < lanes; i++)
    for (int a = 0; a < 10; a++) {
      double *node = f + 3 * spore_quadratic_node(tetrahedra, part, i, a);
      for (int k = 0; k < 3; k++) node[k] -= rows[a][4 * i + (size_t)k];
    }
}

/* Blocks (a, b), a <= b, one row of pairs after the other. */
typedef struct SporeQuadraticBlocks {
  SporeVd33 m[SPORE_QUADRATIC_PAIRS];
} SporeQuadraticBlocks;

/* The gradient of a node at a point: the gradients of one or two corners, each times a number. */
typedef struct SporeQuadraticFactor {
  int corner[2], count;
  double by[2];
} SporeQuadraticFactor;

SPORE_INLINE SporeQuadraticFactor spore_quadratic_factor(int point, int a) {
  assert(a >= 0 && a < 10);
  if (a < 4) return (SporeQuadraticFactor){{a, a}, 1, {4 * spore_quadratic_weight(point, a) - 1, 0}};
  int i = spore_quadratic_edges[a - 4][0], j = spore_quadratic_edges[a - 4][1];
  return (SporeQuadraticFactor){
      {i, j}, 2, {4 * spore_quadratic_weight(point, j), 4 * spore_quadratic_weight(point, i)}};
}

/* All blocks of the corners; rows and columns add up to nothing. */
SPORE_INLINE void spore_quadratic_corners(const SporeElementBlocks *blocks, SporeVd33 all[4][4]) {
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

/* blocks += the nodes' blocks that follow from the corners' blocks at a point */
SPORE_INLINE void spore_quadratic_expand(const SporeElementBlocks *corners, int point, SporeQuadraticBlocks *blocks) {
  SporeVd33 all[4][4];
  spore_quadratic_corners(corners, all);
  SporeVd33 *block = blocks->m;
  for (int a = 0; a < 10; a++)
    for (int b = a; b < 10; b++, block++) {
      SporeQuadraticFactor left = spore_quadratic_factor(point, a), right = spore_quadratic_factor(point, b);
      for (int i = 0; i < left.count; i++)
        for (int j = 0; j < right.count; j++) {
          double by = left.by[i] * right.by[j];
          const SporeVd33 *from = &all[left.corner[i]][right.corner[j]];
          SPORE_UNROLL for (int k = 0; k < 9; k++) block->m[k] += by * from->m[k];
        }
    }
}

/* blocks += by x x^T */
SPORE_INLINE void spore_quadratic_add_outer(SporeVd by, const SporeQuadraticNodes *x, SporeQuadraticBlocks *blocks) {
  SporeVd33 *block = blocks->m;
  for (int a = 0; a < 10; a++) {
    SporeVd3 left = spore_vd3_scale(by, x->node[a]);
    for (int b = a; b < 10; b++, block++) spore_vd33_add_outer(block, left, x->node[b]);
  }
}

/* One element after the other, whatever the width. */
SPORE_INLINE void spore_quadratic_add_blocks(const SporeTetrahedra *tetrahedra, const SporePart *part,
                                             const SporeQuadraticBlocks *blocks, SporeBlockMatrix *matrix) {
  double entries[SPORE_QUADRATIC_PAIRS][9][SPORE_WIDTH];
  for (int pair = 0; pair < SPORE_QUADRATIC_PAIRS; pair++)
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
