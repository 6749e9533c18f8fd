/* State of the fit of weighted spheres, shared by its rounds and its relocations. */
#ifndef SPORE_GENERATE_SPHERES_WEIGHTED_PARTS_H
#define SPORE_GENERATE_SPHERES_WEIGHTED_PARTS_H

#include "core/generate/spheres_weighted.h"

#define SPORE_WEIGHT_LEAST 0.01

/* Where a ball says something: a sample in it. */
typedef struct SporeWeightedPair {
  uint32_t sample, ball;
  float out[3]; /* from the centre to the sample, of length 1 */
  float depth;  /* m */
} SporeWeightedPair;

typedef struct SporeWeightedFit {
  const SporeSolid *solid; /* whose symmetry the balls follow: they stand for their images, samples are folded */
  const uint8_t *bound;    /* balls: mirror planes that they stay on, as bits */
  SporeSamples samples;
  SporeBalls balls, trial;
  double *weights, *trial_weights;
  SporeWeightedPair *pairs;
  size_t pair_count, pair_capacity;
  double *sum, *importance, *along;                                    /* a sample: f; weight of its square; scratch */
  double *gradient, *diagonal, *step, *residual, *direction, *product; /* UNKNOWNS x balls */
  SporeRandom random;
  double smoothing, damping, loss;
  bool weights_only;
} SporeWeightedFit;

/* Pairs, f and the loss of the balls. False: no memory. */
bool spore_weighted_evaluate(SporeWeightedFit *fit, const SporeBalls *balls, const double *weights);
/* The centre, or its image, that the ball may have. */
SporeVec3 spore_weighted_confine(const SporeWeightedFit *fit, size_t ball, SporeVec3 centre);
/* Puts up to `most` balls of little worth where others would gain more. Evaluates nothing; *replaced: how many. False:
 * no memory. */
bool spore_weighted_replace(SporeWeightedFit *fit, size_t most, size_t *replaced);

#endif
