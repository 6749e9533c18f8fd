/* Estimates how wrong a coarser level is, beside the finest one under the same loads.
 *
 * When the world is made, the rest shape is bent, purely and by little, in six ways: by x^2 along y and -2xy along x,
 * and likewise for the other axes. Each level is fitted to the bent shape. A level gets a part of the bend wrong, since
 * it cannot take the shape (distance of the samples), and since it is stiffer or softer than the finest level: its
 * energy in the same bend differs, and the same load bends it by the inverse ratio. Both together, as a share of the
 * bend, are the level's `wrong`; of the six bends the worst counts. While the world runs, the estimated error of a
 * level is that share of how far the body is bent now. */
#include <assert.h>
#include <string.h>

#include "core/math/mat3.h"
#include "core/sim/world_private.h"

#define BEND 0.01      /* of the body's size: displacement of its furthest point */
#define BENDS 6        /* pairs of axes */
#define SLIGHT 0.1     /* a bend that moves points less than this part of the largest one is none */
#define NO_ENERGY 1e-6 /* of the largest energy of a bend: below, the body does not resist it */

/* The middle of samples, by their weights in the fit. */
static SporeVec3 middle(const SporeLod *levels, const double *at) {
  SporeVec3 sum = {0, 0, 0};
  double weight = 0;
  for (size_t s = 0; s < levels->sample_count; s++) {
    sum = spore_vec3_add_scaled(sum, levels->sample_weight[s], spore_vec3_load(at + 3 * s));
    weight += levels->sample_weight[s];
  }
  return spore_vec3_scale(1 / weight, sum);
}

/* The rotation that brings `rest` nearest to `at`, about the middles of both. */
static SporeMat3 turning(const SporeLod *levels, const double *rest, SporeVec3 rest_middle, const double *at,
                         SporeVec3 at_middle) {
  SporeMat3 sum = spore_mat3_diagonal(0, 0, 0), rotation, stretch;
  for (size_t s = 0; s < levels->sample_count; s++) {
    SporeVec3 r = spore_vec3_sub(spore_vec3_load(rest + 3 * s), rest_middle);
    SporeVec3 p = spore_vec3_sub(spore_vec3_load(at + 3 * s), at_middle);
    sum = spore_mat3_add(sum, spore_mat3_scale(levels->sample_weight[s], spore_mat3_outer(p, r)));
  }
  spore_mat3_polar(sum, &rotation, &stretch);
  return rotation;
}

/* Largest distance of a sample from where the turned and moved rest shape has it, m. */
static double bent_of(const SporeLod *levels, const double *rest, const double *at) {
  SporeVec3 rest_middle = middle(levels, rest), at_middle = middle(levels, at);
  SporeMat3 turn = turning(levels, rest, rest_middle, at, at_middle);
  double worst = 0;
  for (size_t s = 0; s < levels->sample_count; s++) {
    SporeVec3 r = spore_vec3_sub(spore_vec3_load(rest + 3 * s), rest_middle);
    SporeVec3 p = spore_vec3_sub(spore_vec3_load(at + 3 * s), at_middle);
    worst = fmax(worst, spore_vec3_distance(p, spore_mat3_apply(turn, r)));
  }
  return worst;
}

double spore_lod_bent(const SporeWorld *world, const SporeBody *body) {
  assert(body->lod);
  const SporeLod *levels = body->lod;
  const SporeLodLevel *level = &levels->level[body->grade];
  spore_mapping_positions(&level->samples, level->rest_q, levels->after);
  spore_mapping_positions(&level->samples, world->state.q + body->q_offset, levels->before);
  return bent_of(levels, levels->after, levels->before);
}

double spore_lod_estimate(const SporeLod *levels, SporeLodGrade level, double bent) {
  assert(levels->level[level].model);
  return levels->level[level].wrong * bent;
}

/* Displaces the samples of the rest shape, in levels->before, by bend `way`. Returns the largest displacement. */
static double bend_samples(const SporeLod *levels, int way) {
  static const int axes[BENDS][2] = {{0, 1}, {1, 0}, {1, 2}, {2, 1}, {2, 0}, {0, 2}};
  const int along = axes[way][0], across = axes[way][1];
  const SporeLodLevel *fine = &levels->level[SPORE_LOD_FINE];
  double *at = levels->before, *rest = levels->speed, size = 0, worst = 0;
  spore_mapping_positions(&fine->samples, fine->rest_q, rest);
  SporeVec3 centre = middle(levels, rest);
  for (size_t s = 0; s < levels->sample_count; s++)
    size = fmax(size, spore_vec3_distance(spore_vec3_load(rest + 3 * s), centre));
  const double origin[3] = {centre.x, centre.y, centre.z};
  memcpy(at, rest, 3 * levels->sample_count * sizeof *at);
  for (size_t s = 0; s < levels->sample_count; s++) {
    double x = rest[3 * s + along] - origin[along], y = rest[3 * s + across] - origin[across];
    at[3 * s + along] -= BEND / size * 2 * x * y;
    at[3 * s + across] += BEND / size * x * x;
    worst = fmax(worst, spore_vec3_distance(spore_vec3_load(at + 3 * s), spore_vec3_load(rest + 3 * s)));
  }
  return worst;
}

/* A bend as a level takes it. */
typedef struct Bent {
  double by;             /* m: how far the samples are bent */
  double missed, energy; /* m; J: of the level, beyond that at rest */
} Bent;

static Bent bend_level(const SporeLod *levels, SporeLodGrade grade, int way) {
  const SporeLodLevel *level = &levels->level[grade];
  const SporeModelType *type = level->model->type;
  bend_samples(levels, way);
  Bent bent = {.by = bent_of(levels, levels->speed, levels->before)};
  spore_lod_place(levels, grade);
  bent.missed = spore_lod_error(levels, grade);
  bent.energy = type->potential(level->model, levels->q) - type->potential(level->model, level->rest_q);
  if (type->forget) type->forget(level->model);
  return bent;
}

/* Share of a bend that a level gets wrong. resists: whether the finest level resists it. */
static double share_of(const Bent *fine, const Bent *coarse, bool resists) {
  double missed = coarse->missed / fine->by;
  if (!resists || !(coarse->energy > 0)) return missed;
  return missed + fabs(1 - fine->energy / coarse->energy);
}

void spore_lod_measure_levels(SporeLod *levels) {
  assert(levels->level[SPORE_LOD_FINE].model);
  Bent fine[BENDS];
  double most = 0, energy = 0;
  for (int way = 0; way < BENDS; way++) {
    fine[way] = bend_level(levels, SPORE_LOD_FINE, way);
    most = fmax(most, fine[way].by);
    energy = fmax(energy, fine[way].energy);
  }
  for (int k = 0; k < SPORE_LOD_FINE; k++) {
    if (!levels->level[k].model) continue;
    levels->level[k].wrong = 0;
    for (int way = 0; way < BENDS; way++) {
      if (!(fine[way].by > SLIGHT * most)) continue;
      Bent coarse = bend_level(levels, (SporeLodGrade)k, way);
      double share = share_of(&fine[way], &coarse, fine[way].energy > NO_ENERGY * energy);
      levels->level[k].wrong = fmax(levels->level[k].wrong, share);
    }
  }
}
