/* Relocations of weighted balls: those whose weight is missed least go where the sum is too small. */
#include <math.h>

#include "core/base/memory.h"
#include "core/generate/spheres_weighted_parts.h"

#define LOOKS 200       /* places that are looked at */
#define SAMPLE_TRIES 50 /* samples that are drawn until one lacks depth */
#define WORTH_SHARE 0.3 /* of a ball's worth: what a newcomer must gain, for the others come to fit either */
#define APART 0.7       /* of the radii together: nearer newcomers would gain the same */

static double missing(const SporeWeightedFit *fit, size_t sample) {
  return fmax(fit->samples.depth[sample], 0) - fit->sum[sample];
}

/* What the sum of errors rises by when a ball is taken away, of each. */
static void find_worth(const SporeWeightedFit *fit, double *worth) {
  for (size_t i = 0; i < fit->balls.count; i++) worth[i] = 0;
  for (size_t p = 0; p < fit->pair_count; p++) {
    const SporeWeightedPair *pair = &fit->pairs[p];
    double lack = missing(fit, pair->sample), part = fit->weights[pair->ball] * (double)pair->depth;
    worth[pair->ball] += fit->samples.weight[pair->sample] * (fabs(lack + part) - fabs(lack));
  }
}

/* A ball that would lower the sum of errors, the others as they are. */
typedef struct Newcomer {
  SporeVec3 centre;
  double radius, weight, gain;
} Newcomer;

/* With the best of a few weights. */
static Newcomer weigh_newcomer(const SporeWeightedFit *fit, SporeVec3 c, double radius) {
  static const double weights[] = {0.25, 0.5, 0.9};
  enum { WEIGHTS = sizeof weights / sizeof *weights };
  const SporePoints *points = &fit->samples.points;
  double gains[WEIGHTS] = {0};
  for (size_t b = 0; b < points->block_count; b++) {
    const double *block = points->block + 4 * b;
    if (spore_vec3_distance(spore_vec3_load(block), c) >= radius + block[3]) continue;
    size_t end = (b + 1) * SPORE_BLOCK < points->count ? (b + 1) * SPORE_BLOCK : points->count;
    for (size_t k = b * SPORE_BLOCK; k < end; k++) {
      double depth = radius - spore_vec3_distance(spore_vec3(points->x[k], points->y[k], points->z[k]), c);
      if (depth <= 0) continue;
      double lack = missing(fit, k);
      for (int w = 0; w < WEIGHTS; w++)
        gains[w] += fit->samples.weight[k] * (fabs(lack) - fabs(lack - weights[w] * depth));
    }
  }
  Newcomer best = {c, radius, weights[0], 0};
  for (int w = 0; w < WEIGHTS; w++)
    if (gains[w] > best.gain) best.gain = gains[w], best.weight = weights[w];
  return best;
}

/* The best of a few radii about a sample that lacks depth. */
static Newcomer find_newcomer(SporeWeightedFit *fit) {
  static const double radii[] = {0.5, 0.8, 1.2, 1.8}; /* of the typical one */
  const SporePoints *points = &fit->samples.points;
  Newcomer best = {.gain = 0};
  size_t k = 0;
  for (int t = 0; t < SAMPLE_TRIES; t++) {
    k = (size_t)(spore_random_unit(&fit->random) * (double)points->count);
    if (missing(fit, k) > fit->smoothing) break;
  }
  double most = fmax(fit->samples.depth[k], 0) + fit->samples.band;
  for (size_t i = 0; i < sizeof radii / sizeof *radii; i++) {
    Newcomer one = weigh_newcomer(fit, spore_vec3(points->x[k], points->y[k], points->z[k]),
                                  fmin(radii[i] * fit->samples.typical, most));
    if (one.gain > best.gain) best = one;
  }
  return best;
}

static void put(SporeWeightedFit *fit, size_t ball, const Newcomer *one) {
  spore_balls_set(&fit->balls, ball, spore_weighted_confine(fit, ball, one->centre), one->radius);
  fit->weights[ball] = fmax(one->weight, SPORE_WEIGHT_LEAST);
}

bool spore_weighted_replace(SporeWeightedFit *fit, size_t most, size_t *replaced) {
  Newcomer *found = SPORE_NEW_ARRAY(Newcomer, LOOKS);
  double *worth = SPORE_NEW_ARRAY(double, fit->balls.count);
  bool done = found && worth;
  *replaced = 0;
  if (done) find_worth(fit, worth);
  for (size_t t = 0; done && t < LOOKS; t++) found[t] = find_newcomer(fit);
  for (; done && *replaced < most; ++*replaced) {
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
  spore_free(found);
  spore_free(worth);
  return done;
}
