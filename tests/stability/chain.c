#include "tests/stability/chain.h"

#include <glib.h>
#include <string.h>

#include "models/nodal.h"
#include "models/springs.h"

typedef struct Chain {
  SporeModel base;
  double *rest;
  SporeSprings springs;
} Chain;

static void destroy(SporeModel *model) {
  Chain *chain = (Chain *)model;
  SporeSprings *springs = &chain->springs;
  g_free(chain->rest);
  g_free(springs->nodes);
  g_free(springs->length);
  g_free(springs->direction);
  g_free(springs->stiffness);
  g_free(springs->blocks);
  spore_model_clear(&chain->base);
  g_free(chain);
}

static void place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q, double *v) {
  spore_nodal_place(((const Chain *)model)->rest, model->block_count, pose, velocity, spin, q, v);
}

static void force(const SporeModel *model, const double *q, const double *v, double *f) {
  spore_springs_force(&((const Chain *)model)->springs, q, v, f);
}

static double potential(const SporeModel *model, const double *q) {
  return spore_springs_potential(&((const Chain *)model)->springs, q);
}

static bool pattern(const SporeModel *model, SporeBlockPattern *blocks) {
  return spore_springs_pattern(&((const Chain *)model)->springs, blocks);
}

static void jacobian(const SporeModel *model, const double *q, const double *v, double stiffness_scale,
                     double damping_scale, SporeBlockMatrix *matrix) {
  spore_springs_jacobian(&((const Chain *)model)->springs, q, stiffness_scale, damping_scale, matrix);
}

static bool map(const SporeModel *model, const double *points, size_t count, SporeMapping *mapping, SporeError *error) {
  const Chain *chain = (const Chain *)model;
  g_assert_true(count == 0 ||
                (count == model->block_count && !memcmp(points, chain->rest, 3 * count * sizeof(double))));
  return spore_mapping_init_identity(mapping, count);
}

static const SporeModelType type = {.name = "chain",
                                    .label = "Chain",
                                    .doc = "A chain for tests.",
                                    .destroy = destroy,
                                    .place = place,
                                    .mass = spore_nodal_mass,
                                    .force = force,
                                    .potential = potential,
                                    .map = map,
                                    .pattern = pattern,
                                    .jacobian = jacobian};

/* A chain's rows hold the node before, the node itself and the one after. */
static void set_blocks(size_t count, size_t *blocks) {
  for (size_t i = 0; i < count; i++) {
    size_t diagonal = i == 0 ? 0 : 3 * i, next = diagonal + 1;
    blocks[4 * i] = diagonal;
    blocks[4 * i + 1] = 3 * (i + 1);
    blocks[4 * i + 2] = next;
    blocks[4 * i + 3] = 3 * (i + 1) - 1;
  }
}

SporeModel *chain_new(size_t count, double spacing, const double *stiffness, const double *mass, double damping) {
  Chain *chain = g_new0(Chain, 1);
  g_assert_true(spore_model_init(&chain->base, &type, 3 * (count + 1), count + 1, NULL));
  chain->rest = g_new0(double, 3 * (count + 1));
  SporeSprings *springs = &chain->springs;
  springs->count = count;
  springs->damping = damping;
  springs->nodes = g_new(uint32_t, 2 * count);
  springs->length = g_new(double, count);
  springs->direction = g_new0(double, 3 * count);
  springs->stiffness = g_memdup2(stiffness, count * sizeof(double));
  springs->blocks = g_new(size_t, 4 * count);
  set_blocks(count, springs->blocks);
  for (size_t i = 0; i <= count; i++) {
    chain->rest[3 * i + 1] = -spacing * (double)i;
    chain->base.block_mass[i] = mass[i];
    if (i == count) break;
    springs->nodes[2 * i] = (uint32_t)i, springs->nodes[2 * i + 1] = (uint32_t)i + 1;
    springs->length[i] = spacing;
    springs->direction[3 * i + 1] = 1;
  }
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
