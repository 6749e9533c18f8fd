/* State of the fit of weighted spheres, shared by its rounds and its relocations. */
#ifndef SPORE_GENERATE_SPHERES_WEIGHTED_PARTS_H
#define SPORE_GENERATE_SPHERES_WEIGHTED_PARTS_H

#include "core/generate/spheres/weighted.h"

#define SPORE_WEIGHTED_UNKNOWNS 5 /* of a ball: centre, radius, weight */
#define SPORE_WEIGHT_LEAST 0.01

/* A ball, or its image in the planes. */
typedef struct SporeWeightedImage {
  uint32_t ball;
  uint8_t planes; /* bits */
} SporeWeightedImage;

typedef struct SporeWeightedFit {
  const SporeSolid *solid; /* whose symmetry the balls follow: they stand for their images, samples are folded */
  const uint8_t *bound;    /* balls: mirror planes that they stay on, as bits */
  SporeSamples samples;    /* their weights are shares in the loss */
  SporeBalls balls;
  double *weights;
  double *sum;                                 /* samples: the sum less the level, m */
  double *slope, *running;                     /* balls x UNKNOWNS, x 2: of the loss; means of it and its square */
  double level_slope, level_running[2];        /* the same of the level */
  double *known;                               /* balls x 4: where a centre's depth was last asked for, and that */
  SporeWeightedImage *near_group, *near_block; /* images */
  float *columns, *slopes;                     /* images x UNKNOWNS, of a block; and the level's slope */
  size_t image_count;                          /* most */
  SporeRandom random;
  double smoothing, level; /* m */
  bool levelled;           /* the level is an unknown; else it is 0 */
} SporeWeightedFit;

/* The sum at the samples, and the slopes of the loss, of each `parts`th block, the first of them `part`. */
void spore_weighted_evaluate(SporeWeightedFit *fit, size_t part, size_t parts);
/* The centre, or its image, that the ball may have. */
SporeVec3 spore_weighted_confine(const SporeWeightedFit *fit, size_t ball, SporeVec3 centre);
/* How far out of the solid a ball may reach, m. */
double spore_weighted_reach(const SporeWeightedFit *fit);
/* Puts up to `most` balls of little worth where others would gain more, by the sum at all samples. Evaluates nothing.
 * False: no memory. */
bool spore_weighted_replace(SporeWeightedFit *fit, size_t most);

#endif
