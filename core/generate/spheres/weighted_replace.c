/* Relocations of weighted balls: a ball whose removal adds least to the loss goes where a new ball would gain more. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/spheres/kernels.h"
#include "core/generate/spheres/weighted_parts.h"

#define LOOKS 200       /* places that are tried */
#define WORTH_SHARE 0.3 /* of a ball's worth: least gain of a new ball; the other balls adapt to either change */
#define APART 0.7       /* of the sum of the radii: nearer new balls would gain the same */

enum { WEIGHTS = 3 };

/* The loss at the sample if the sum there is f. */
static double loss_at(const SporeWeightedFit *fit, size_t sample, double f) {
  double depth = fit->samples.depth[sample];
  return fit->samples.weight[sample] * (depth < 0 ? fmax(f, 0) : fabs(f - depth));
}

/* Adds to gains[w] what an additional ball of weights[w] would take off the loss in block b, the other balls unchanged.
 */
static void add_gains(const SporeWeightedFit *fit, size_t b, SporeVec3 c, double radius, const double *weights,
                      size_t count, double *gains) {
  const SporePoints *points = &fit->samples.points;
  size_t first = b * SPORE_BLOCK, end = first + SPORE_BLOCK < points->count ? first + SPORE_BLOCK : points->count;
  double depths[SPORE_BLOCK];
  SPORE_KERNEL(spore_block_depths)
  (points->x + first, points->y + first, points->z + first, (const double[3]){c.x, c.y, c.z}, radius, depths);
  for (size_t k = first; k < end; k++) {
    double depth = depths[k - first];
    if (depth <= 0) continue;
    double now = loss_at(fit, k, fit->sum[k]);
    for (size_t w = 0; w < count; w++) gains[w] += now - loss_at(fit, k, fit->sum[k] + weights[w] * depth);
  }
}

static void find_gains(const SporeWeightedFit *fit, SporeVec3 c, double radius, const double *weights, size_t count,
                       double *gains) {
  const SporePoints *points = &fit->samples.points;
  for (size_t w = 0; w < count; w++) gains[w] = 0;
  for (size_t g = 0; g < points->group_count; g++) {
    const double *group = points->group + 4 * g;
    if (spore_vec3_distance(spore_vec3_load(group), c) >= radius + group[3]) continue;
    for (size_t b = g * SPORE_GROUP; b < (g + 1) * SPORE_GROUP && b < points->block_count; b++) {
      const double *block = points->block + 4 * b;
      if (spore_vec3_distance(spore_vec3_load(block), c) < radius + block[3])
        add_gains(fit, b, c, radius, weights, count, gains);
    }
  }
}

/* A ball that would lower the loss, the other balls unchanged. */
typedef struct Newcomer {
  SporeVec3 centre;
  double radius, weight, gain;
} Newcomer;

/* The best of a few radii and weights, centred on the sample. */
static Newcomer find_newcomer(const SporeWeightedFit *fit, size_t sample) {
  static const double radii[] = {0.5, 0.8, 1.2, 1.8}; /* of the typical one */
  static const double weights[WEIGHTS] = {0.2, 0.4, 0.8};
  const SporePoints *points = &fit->samples.points;
  SporeVec3 c = {points->x[sample], points->y[sample], points->z[sample]};
  double gains[WEIGHTS], most = fmax(fit->samples.depth[sample], 0) + spore_weighted_reach(fit);
  Newcomer best = {.gain = 0};
  for (size_t i = 0; i < sizeof radii / sizeof *radii; i++) {
    double radius = fmin(radii[i] * fit->samples.typical, most);
    find_gains(fit, c, radius, weights, WEIGHTS, gains);
    for (size_t w = 0; w < WEIGHTS; w++)
      if (gains[w] > best.gain) best = (Newcomer){c, radius, weights[w], gains[w]};
  }
  return best;
}

/* Finds new balls at samples that are drawn in proportion to their loss. */
static void look_about(SporeWeightedFit *fit, Newcomer *found) {
  double all = 0, passed = 0;
  size_t k = 0, count = fit->samples.points.count;
  for (size_t i = 0; i < count; i++) all += loss_at(fit, i, fit->sum[i]);
  for (size_t t = 0; t < LOOKS; t++) {
    double wanted = all * ((double)t + spore_random_unit(&fit->random)) / LOOKS, one;
    while (k + 1 < count && passed + (one = loss_at(fit, k, fit->sum[k])) < wanted) passed += one, k++;
    found[t] = find_newcomer(fit, k);
  }
}

static void put(SporeWeightedFit *fit, size_t ball, const Newcomer *one) {
  size_t unknowns = 2 * SPORE_WEIGHTED_UNKNOWNS;
  spore_balls_set(&fit->balls, ball, spore_weighted_confine(fit, ball, one->centre), one->radius);
  fit->weights[ball] = one->weight;
  memset(fit->running + unknowns * ball, 0, unknowns * sizeof *fit->running);
}

static void replace(SporeWeightedFit *fit, size_t most, Newcomer *found, double *worth) {
  for (size_t replaced = 0; replaced < most; replaced++) {
    size_t spare = 0, which = 0;
    for (size_t i = 1; i < fit->balls.count; i++)
      if (worth[i] < worth[spare]) spare = i;
    for (size_t t = 1; t < LOOKS; t++)
      if (found[t].gain > found[which].gain) which = t;
    Newcomer one = found[which];
    if (one.gain <= WORTH_SHARE * worth[spare] || one.gain <= 0) break;
    put(fit, spare, &one);
    worth[spare] = HUGE_VAL;
    for (size_t t = 0; t < LOOKS; t++)
      if (spore_vec3_distance(found[t].centre, one.centre) < APART * (found[t].radius + one.radius)) found[t].gain = 0;
  }
}

bool spore_weighted_replace(SporeWeightedFit *fit, size_t most) {
  Newcomer *found = SPORE_NEW_ARRAY(Newcomer, LOOKS);
  double *worth = SPORE_NEW_ARRAY(double, fit->balls.count);
  bool done = found && worth;
  for (size_t i = 0; done && i < fit->balls.count; i++) {
    double taken = -fit->weights[i], gain;
    find_gains(fit, spore_balls_centre(&fit->balls, i), fit->balls.r[i], &taken, 1, &gain);
    worth[i] = -gain;
  }
  if (done) look_about(fit, found);
  if (done) replace(fit, most, found, worth);
  spore_free(found);
  spore_free(worth);
  return done;
}
