/* Corotational tetrahedra moved all at once by a matrix that stays. */
#include "models/tetrahedra/prefactored.h"

#include <assert.h>
#include <string.h>

#include "core/base/memory.h"

void spore_prefactored_clear(SporePrefactored *prefactored) {
  for (int k = 0; k < SPORE_PREFACTORS; k++) {
    spore_point_factor_clear(&prefactored->kept[k].factor);
    spore_free(prefactored->kept[k].weight);
  }
  spore_block_matrix_clear(&prefactored->matrix);
  spore_point_pattern_clear(&prefactored->pattern);
  spore_free(prefactored->numbers);
  spore_free(prefactored->q);
  spore_free(prefactored->v);
  spore_free(prefactored->f);
  spore_free(prefactored->row);
  *prefactored = (SporePrefactored){0};
}

bool spore_prefactored_create(SporePrefactored *prefactored, SporeBlockMatrix *matrix, const SporeCancel *cancel) {
  size_t n = matrix->block_count;
  *prefactored = (SporePrefactored){.matrix = *matrix};
  *matrix = (SporeBlockMatrix){0};
  if (!spore_point_pattern_create(&prefactored->pattern, &prefactored->matrix, cancel)) return false;
  bool made = true;
  for (int k = 0; k < SPORE_PREFACTORS; k++) {
    made = spore_point_factor_create(&prefactored->kept[k].factor, &prefactored->pattern) && made;
    made = (prefactored->kept[k].weight = SPORE_NEW_ARRAY(double, n)) && made;
  }
  prefactored->numbers = SPORE_NEW_ARRAY(double, prefactored->matrix.row_start[n]);
  prefactored->q = SPORE_NEW_ARRAY(double, 3 * n);
  prefactored->v = SPORE_NEW_ARRAY(double, 3 * n);
  prefactored->f = SPORE_NEW_ARRAY(double, 3 * n);
  prefactored->row = SPORE_NEW_ARRAY(double, 4 * n);
  return made && prefactored->numbers && prefactored->q && prefactored->v && prefactored->f && prefactored->row;
}

void spore_prefactored_forget(SporePrefactored *prefactored) {
  for (int k = 0; k < SPORE_PREFACTORS; k++) prefactored->kept[k].h = 0;
}

/* What the elements of the lane add to A, but for held nodes. weight: h^2 V k. */
static void add_element(SporePrefactored *prefactored, const SporeTetrahedronBatch *batch, size_t lane, double weight,
                        const double *give) {
  SporeVec3 b[4];
  for (size_t k = 0; k < 3; k++)
    b[k + 1] =
        spore_vec3(batch->inverse[3 * k][lane], batch->inverse[3 * k + 1][lane], batch->inverse[3 * k + 2][lane]);
  b[0] = spore_vec3_scale(-1, spore_vec3_add(spore_vec3_add(b[1], b[2]), b[3]));
  for (size_t i = 0; i < 4; i++)
    for (size_t j = 0; j < 4; j++) {
      uint32_t row = batch->node[i][lane], column = batch->node[j][lane];
      if (give[row] == 0 || give[column] == 0) continue;
      prefactored->numbers[spore_block_matrix_find(&prefactored->matrix, row, column)] +=
          weight * spore_vec3_dot(b[i], b[j]);
    }
}

static bool factorise(SporePrefactored *prefactored, SporePrefactor *factor, const SporeTetrahedra *tetrahedra,
                      const SporeCancel *cancel) {
  const SporeBlockMatrix *matrix = &prefactored->matrix;
  memset(prefactored->numbers, 0, matrix->row_start[matrix->block_count] * sizeof(double));
  for (size_t n = 0; n < matrix->block_count; n++)
    prefactored->numbers[matrix->diagonal[n]] = factor->weight[n] > 0 ? 1 / factor->weight[n] : 1;
  double whole = factor->h * factor->h * factor->stiffness;
  for (size_t n = 0; n < tetrahedra->batch_count; n++)
    for (size_t lane = 0; lane < tetrahedra->lanes[n]; lane++)
      add_element(prefactored, &tetrahedra->batches[n], lane, whole * tetrahedra->batches[n].volume[lane],
                  factor->weight);
  return spore_point_factorise(&factor->factor, &prefactored->pattern, matrix, prefactored->numbers, cancel);
}

static bool serves(const SporePrefactored *prefactored, const SporePrefactor *factor, const SporeSweep *at,
                   double stiffness) {
  if (factor->h != at->h || factor->stiffness != stiffness) return false;
  size_t other = 0;
  for (size_t n = 0; n < prefactored->pattern.count; n++) other += factor->weight[n] != at->now[4 * n + 3];
  return other == 0;
}

SporePrefactor *spore_prefactored_find(SporePrefactored *prefactored, const SporeTetrahedra *tetrahedra,
                                       SporeElasticity elasticity, const SporeSweep *at) {
  assert(at->h > 0 && prefactored->pattern.count > 0 && elasticity.viscosity == 0);
  double stiffness = 2 * elasticity.mu + 3 * elasticity.lambda;
  SporePrefactor *oldest = &prefactored->kept[0];
  prefactored->uses++;
  for (int k = 0; k < SPORE_PREFACTORS; k++) {
    SporePrefactor *factor = &prefactored->kept[k];
    if (serves(prefactored, factor, at, stiffness)) {
      factor->used = prefactored->uses;
      return factor;
    }
    if (factor->used < oldest->used) oldest = factor;
  }
  for (size_t n = 0; n < prefactored->pattern.count; n++) oldest->weight[n] = at->now[4 * n + 3];
  oldest->h = at->h, oldest->stiffness = stiffness, oldest->used = prefactored->uses;
  if (factorise(prefactored, oldest, tetrahedra, at->cancel)) return oldest;
  oldest->h = 0;
  return NULL;
}

void spore_prefactored_load(SporePrefactored *prefactored, const SporeSweep *at) {
  size_t n = prefactored->pattern.count;
  double rate = 1 / at->h;
  memset(prefactored->f, 0, 3 * n * sizeof(double));
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < 3; k++) {
      double x = prefactored->q[3 * i + k] = at->now[4 * i + k];
      prefactored->v[3 * i + k] = rate * (x - at->before[3 * i + k]);
    }
}

void spore_prefactored_move(SporePrefactored *prefactored, const SporePrefactor *factor, const SporeSweep *at) {
  const SporePointPattern *pattern = &prefactored->pattern;
  double square = at->h * at->h;
  for (size_t j = 0; j < pattern->count; j++) {
    size_t n = pattern->order[j];
    double *row = prefactored->row + 4 * j, scale = factor->weight[n] > 0 ? square : 0;
    for (size_t k = 0; k < 3; k++) row[k] = scale * prefactored->f[3 * n + k];
    row[3] = 0;
  }
  spore_point_solve(&factor->factor, pattern, prefactored->row);
  for (size_t j = 0; j < pattern->count; j++) {
    size_t n = pattern->order[j];
    for (size_t k = 0; k < 3; k++) at->now[4 * n + k] += prefactored->row[4 * j + k];
  }
}
