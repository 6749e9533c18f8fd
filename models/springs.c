#include "models/springs.h"

#include <math.h>

#include "core/base/memory.h"
#include "models/spring_pairs.h"

/* Fills arrays of the springs' number from the pairs of nodes. */
static bool allocate(SporeSprings *springs, size_t count) {
  springs->count = count;
  springs->nodes = SPORE_NEW_ARRAY(uint32_t, 2 * count);
  springs->length = SPORE_NEW_ARRAY(double, count);
  springs->direction = SPORE_NEW_ARRAY(double, 3 * count);
  springs->stiffness = SPORE_NEW_ARRAY(double, count);
  springs->blocks = SPORE_NEW_ARRAY(size_t, 4 * count);
  return springs->nodes && springs->length && springs->direction && springs->stiffness && springs->blocks;
}

void spore_springs_clear(SporeSprings *springs) {
  spore_free(springs->nodes);
  spore_free(springs->length);
  spore_free(springs->direction);
  spore_free(springs->stiffness);
  spore_free(springs->blocks);
  *springs = (SporeSprings){0};
}

static void take_pairs(SporeSprings *springs, size_t first, const SporePairs *pairs, const double *rest) {
  for (size_t p = 0; p < pairs->count; p++) {
    size_t s = first + p;
    uint32_t a = (uint32_t)(pairs->keys[p] >> 32), b = (uint32_t)pairs->keys[p];
    SporeVec3 d = spore_vec3_sub(spore_vec3_load(rest + 3 * (size_t)a), spore_vec3_load(rest + 3 * (size_t)b));
    springs->nodes[2 * s] = a, springs->nodes[2 * s + 1] = b;
    springs->length[s] = spore_vec3_length(d);
    spore_vec3_store(springs->direction + 3 * s, spore_vec3_normalise(d, (SporeVec3){0, 0, 0}));
  }
}

/* Looks up each spring's blocks once, in a matrix of the pattern that the world will make too. */
static bool find_blocks(SporeSprings *springs, size_t node_count) {
  SporeBlockPattern pattern;
  SporeBlockMatrix matrix;
  spore_block_pattern_init(&pattern, node_count);
  bool made = spore_springs_pattern(springs, &pattern) && spore_block_matrix_create(&matrix, &pattern);
  spore_block_pattern_clear(&pattern);
  if (!made) return false;
  for (size_t s = 0; s < springs->count; s++) {
    uint32_t a = springs->nodes[2 * s], b = springs->nodes[2 * s + 1];
    size_t *blocks = springs->blocks + 4 * s;
    blocks[0] = matrix.diagonal[a], blocks[1] = matrix.diagonal[b];
    blocks[2] = spore_block_matrix_find(&matrix, a, b), blocks[3] = spore_block_matrix_find(&matrix, b, a);
  }
  spore_block_matrix_clear(&matrix);
  return true;
}

bool spore_springs_of_triangles(SporeSprings *springs, const SporeTriangleMesh *mesh, size_t *structural_end,
                                size_t *shear_end) {
  *springs = (SporeSprings){0};
  SporePairs structural = {0}, shear = {0}, bending = {0};
  bool made = spore_pairs_structural(&structural, mesh) && spore_pairs_shear(&shear, mesh, &structural) &&
              spore_pairs_bending(&bending, mesh, &structural, &shear) &&
              allocate(springs, structural.count + shear.count + bending.count);
  if (made) {
    *structural_end = structural.count;
    *shear_end = structural.count + shear.count;
    take_pairs(springs, 0, &structural, mesh->vertices);
    take_pairs(springs, *structural_end, &shear, mesh->vertices);
    take_pairs(springs, *shear_end, &bending, mesh->vertices);
    made = find_blocks(springs, mesh->vertex_count);
  }
  spore_pairs_clear(&structural);
  spore_pairs_clear(&shear);
  spore_pairs_clear(&bending);
  return made;
}

/* Below this part of the rest length a spring has no direction of its own. */
#define SHORT 1e-9

/* Springs are worked on in batches: gather, compute (this part the compiler turns into vector code), scatter. */
#define BATCH 32

typedef struct Batch {
  double d[3][BATCH], w[3][BATCH]; /* difference of positions and velocities */
  double length[BATCH], stiffness[BATCH];
} Batch;

static void gather(const SporeSprings *springs, size_t first, size_t count, const double *q, const double *v,
                   Batch *batch) {
  for (size_t i = 0; i < count; i++) {
    const double *direction = springs->direction + 3 * (first + i);
    size_t a = 3 * (size_t)springs->nodes[2 * (first + i)], b = 3 * (size_t)springs->nodes[2 * (first + i) + 1];
    double length = springs->length[first + i], square = 0;
    for (int k = 0; k < 3; k++) {
      batch->d[k][i] = q[a + k] - q[b + k];
      batch->w[k][i] = v[a + k] - v[b + k];
      square += batch->d[k][i] * batch->d[k][i];
    }
    batch->length[i] = length;
    batch->stiffness[i] = springs->stiffness[first + i];
    if (square > SHORT * SHORT * length * length) continue;
    /* No line between the nodes: that of rest, at a length at which nothing is lost to rounding. */
    for (int k = 0; k < 3; k++) batch->d[k][i] = SHORT * length * direction[k];
  }
  for (size_t i = count; i < BATCH; i++) {
    for (int k = 0; k < 3; k++) batch->d[k][i] = batch->w[k][i] = 0;
    batch->length[i] = batch->stiffness[i] = 0;
  }
}

/* f = -(k (1 - L/l) + c (d . w) / l^2) d, into w. Nodes that meet with L = 0 feel nothing. */
static void compute(Batch *batch, double damping) {
  for (int i = 0; i < BATCH; i++) {
    double x = batch->d[0][i], y = batch->d[1][i], z = batch->d[2][i];
    double square = x * x + y * y + z * z + 1e-300;
    double speed = x * batch->w[0][i] + y * batch->w[1][i] + z * batch->w[2][i];
    double pull = batch->stiffness[i] * (1 - batch->length[i] / sqrt(square)) + damping * speed / square;
    batch->w[0][i] = -pull * x;
    batch->w[1][i] = -pull * y;
    batch->w[2][i] = -pull * z;
  }
}

void spore_springs_force(const SporeSprings *springs, const double *q, const double *v, double *f) {
  Batch batch;
  for (size_t first = 0; first < springs->count; first += BATCH) {
    size_t count = springs->count - first < BATCH ? springs->count - first : BATCH;
    gather(springs, first, count, q, v, &batch);
    compute(&batch, springs->damping);
    for (size_t i = 0; i < count; i++) {
      size_t a = 3 * (size_t)springs->nodes[2 * (first + i)], b = 3 * (size_t)springs->nodes[2 * (first + i) + 1];
      for (int k = 0; k < 3; k++) f[a + k] += batch.w[k][i], f[b + k] -= batch.w[k][i];
    }
  }
}

static SporeVec3 difference(const SporeSprings *springs, size_t s, const double *q) {
  return spore_vec3_sub(spore_vec3_load(q + 3 * (size_t)springs->nodes[2 * s]),
                        spore_vec3_load(q + 3 * (size_t)springs->nodes[2 * s + 1]));
}

double spore_springs_potential(const SporeSprings *springs, const double *q) {
  double sum = 0;
  for (size_t s = 0; s < springs->count; s++) {
    double stretch = spore_vec3_length(difference(springs, s, q)) - springs->length[s];
    sum += 0.5 * springs->stiffness[s] * stretch * stretch;
  }
  return sum;
}

bool spore_springs_pattern(const SporeSprings *springs, SporeBlockPattern *pattern) {
  for (size_t s = 0; s < springs->count; s++)
    if (!spore_block_pattern_add(pattern, springs->nodes[2 * s], springs->nodes[2 * s + 1])) return false;
  return true;
}

void spore_springs_jacobian(const SporeSprings *springs, const double *q, double stiffness_scale, double damping_scale,
                            SporeBlockMatrix *matrix) {
  for (size_t s = 0; s < springs->count; s++) {
    SporeVec3 d = difference(springs, s, q);
    double rest = springs->length[s], l = spore_vec3_length(d), k = stiffness_scale * springs->stiffness[s];
    bool directed = l > SHORT * rest;
    SporeVec3 n = directed ? spore_vec3_scale(1 / l, d) : spore_vec3_load(springs->direction + 3 * s);
    double across = rest == 0 ? k : directed ? k * fmax(0, 1 - rest / l) : 0;
    double along = k - across + damping_scale * springs->damping;
    SporeMat3 block =
        spore_mat3_add(spore_mat3_diagonal(across, across, across), spore_mat3_outer(spore_vec3_scale(along, n), n));
    const size_t *at = springs->blocks + 4 * s;
    double *aa = matrix->values + 9 * at[0], *bb = matrix->values + 9 * at[1];
    double *ab = matrix->values + 9 * at[2], *ba = matrix->values + 9 * at[3];
    for (int i = 0; i < 9; i++) {
      aa[i] += block.m[i], bb[i] += block.m[i];
      ab[i] -= block.m[i], ba[i] -= block.m[i];
    }
  }
}
