/* A chain of mass points and springs, whose rest state under gravity is known in closed form. */
#include "tests/stability/chain.h"

#include <glib.h>
#include <string.h>

#include "models/common/nodal.h"
#include "models/net/springs.h"

typedef struct Chain {
  SporeModel base;
  double *rest;
  size_t count;          /* of runs of springs that are equally stiff */
  SporeSprings *springs; /* one a run */
} Chain;

static void destroy(SporeModel *model) {
  Chain *chain = (Chain *)model;
  for (size_t i = 0; i < chain->count; i++) spore_springs_clear(&chain->springs[i]);
  g_free(chain->springs);
  g_free(chain->rest);
  spore_model_clear(&chain->base);
  g_free(chain);
}

static void place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q, double *v) {
  spore_nodal_place(((const Chain *)model)->rest, model->block_count, pose, velocity, spin, q, v);
}

static void force(const SporeModel *model, const double *q, const double *shape, const double *v, double *f) {
  const Chain *chain = (const Chain *)model;
  spore_springs_force(chain->springs, chain->count, model->pool, q, shape, v, 0, f);
}

static double potential(const SporeModel *model, const double *q) {
  const Chain *chain = (const Chain *)model;
  double sum = 0;
  for (size_t i = 0; i < chain->count; i++) sum += spore_springs_potential(&chain->springs[i], q);
  return sum;
}

static bool pattern(const SporeModel *model, SporeBlockPattern *blocks) {
  for (uint32_t i = 0; i + 1 < model->block_count; i++)
    if (!spore_block_pattern_add(blocks, i, i + 1)) return false;
  return true;
}

static void tangent(const SporeModel *model, const SporeTangent *at, SporeBlockMatrix *matrix) {
  const Chain *chain = (const Chain *)model;
  spore_springs_jacobian(chain->springs, chain->count, model->pool, at, matrix);
}

static void jacobian(const SporeModel *model, const double *q, const double *shape, const double *v,
                     double stiffness_scale, double damping_scale, SporeBlockMatrix *matrix) {
  const SporeTangent at = {
      .q = q, .shape = shape, .v = v, .stiffness_scale = stiffness_scale, .damping_scale = damping_scale};
  tangent(model, &at, matrix);
}

static bool prepare_sweep(SporeModel *model, const SporeCancel *cancel) {
  const Chain *chain = (const Chain *)model;
  bool ordered = true;
  for (size_t i = 0; i < chain->count; i++)
    ordered = ordered && spore_springs_order(&chain->springs[i], model->block_count);
  return ordered;
}

static double sweep_part(const SporeModel *model) {
  const Chain *chain = (const Chain *)model;
  return spore_springs_sweep_part(chain->springs, chain->count);
}

static void sweep(SporeModel *model, const SporeSweep *at) {
  const Chain *chain = (const Chain *)model;
  spore_springs_sweep(chain->springs, chain->count, at);
}

static bool map(const SporeModel *model, const double *points, size_t count, const SporeCancel *cancel,
                SporeMapping *mapping, SporeError *error) {
  const Chain *chain = (const Chain *)model;
  g_assert_true(count == 0 ||
                (count == model->block_count && !memcmp(points, chain->rest, 3 * count * sizeof(double))));
  return spore_mapping_init_identity(mapping, count);
}

static const SporeModelSweep sweeping = {.prepare = prepare_sweep, .part = sweep_part, .sweep = sweep};

static const SporeModelType type = {.name = "chain",
                                    .label = "Chain",
                                    .doc = "A chain for tests.",
                                    .destroy = destroy,
                                    .place = place,
                                    .force = force,
                                    .potential = potential,
                                    .map = map,
                                    .pattern = pattern,
                                    .jacobian = jacobian,
                                    .sweep = &sweeping,
                                    .tangent = tangent};

static void find_blocks(Chain *chain) {
  SporeBlockPattern blocks;
  SporeBlockMatrix matrix;
  spore_block_pattern_init(&blocks, chain->base.block_count);
  g_assert_true(pattern(&chain->base, &blocks) && spore_block_matrix_create(&matrix, &blocks));
  for (size_t i = 0; i < chain->count; i++) spore_springs_find_blocks(&chain->springs[i], &matrix);
  spore_block_pattern_clear(&blocks);
  spore_block_matrix_clear(&matrix);
}

SporeModel *chain_new(size_t count, double spacing, const double *stiffness, const double *mass, double damping) {
  Chain *chain = g_new0(Chain, 1);
  g_assert_true(spore_model_init(&chain->base, &type, count + 1, false, NULL));
  chain->rest = g_new0(double, 3 * (count + 1));
  chain->springs = g_new0(SporeSprings, count);
  for (size_t i = 0; i <= count; i++) {
    chain->rest[3 * i + 1] = -spacing * (double)i;
    chain->base.block_mass[i] = mass[i];
  }
  uint64_t *keys = g_new(uint64_t, count);
  for (size_t i = 0; i < count; i++) keys[i] = (uint64_t)i << 32 | (i + 1);
  for (size_t first = 0, end; first < count; first = end) {
    for (end = first + 1; end < count && stiffness[end] == stiffness[first];) end++;
    SporeSprings *run = &chain->springs[chain->count++];
    g_assert_true(spore_springs_create(run, keys + first, end - first, chain->rest, count + 1));
    run->stiffness = stiffness[first];
    run->damping = damping;
  }
  g_free(keys);
  find_blocks(chain);
  return &chain->base;
}

void chain_hang(size_t count, double spacing, const double *stiffness, const double *mass, double g, double *height) {
  height[0] = 0;
  for (size_t i = 0; i < count; i++) {
    double below = 0;
    for (size_t j = count; j > i; j--) below += mass[j];
    height[i + 1] = height[i] - spacing - below * g / stiffness[i];
  }
}
