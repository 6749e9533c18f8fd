/* State of the fit of weighted spheres, shared by its rounds and its relocations. */
#ifndef SPORE_GENERATE_SPHERES_WEIGHTED_PARTS_H
#define SPORE_GENERATE_SPHERES_WEIGHTED_PARTS_H

#include "core/generate/spheres/weighted.h"

#define SPORE_WEIGHTED_UNKNOWNS 5 /* of a ball: centre, radius, weight */
#define SPORE_WEIGHT_LEAST 0.01

/* Balls and their images in the planes, as columns. */
typedef struct SporeWeightedImages {
  size_t count;
  double *x, *y, *z, *r;
  uint32_t *ball;
  uint8_t *planes; /* bits */
} SporeWeightedImages;

typedef struct SporeWeightedFit {
  const SporeSolid *solid; /* with its symmetry: each ball stands for its images too, and samples are folded */
  const uint8_t *bound;    /* balls: bits of the mirror planes that each stays on */
  SporeSamples samples;    /* their weights are shares in the loss */
  SporeBalls balls;
  double *weights;
  double *sum;             /* samples: the sum less the level, m */
  double *slope, *running; /* balls x UNKNOWNS: slope of the loss; x 2: running means of the slope and its square */
  double level_slope, level_running[2]; /* the same for the level */
  double *known; /* balls x 4: place where the depth of a centre was last computed, and that depth */
  SporeWeightedImages images, near_group, near_block; /* all; scratch: those that reach a group, and a block */
  uint8_t *reaches;                                   /* scratch, images */
  float *columns, *slopes; /* images x UNKNOWNS, for a block; slopes also has the level's slope */
  size_t image_count;      /* most */
  SporeRandom random;
  double smoothing, level; /* m */
  bool levelled;           /* the level is an unknown; else it is 0 */
} SporeWeightedFit;

/* Room for `most` images; false: no memory. */
bool spore_weighted_images_create(SporeWeightedImages *images, size_t most);
void spore_weighted_images_clear(SporeWeightedImages *images);
/* Computes the sum at the samples and the slopes of the loss for every `parts`th block, from block `part`. */
void spore_weighted_evaluate(SporeWeightedFit *fit, size_t part, size_t parts);
/* The allowed centre for the ball: folded by the symmetry and projected on the planes to which the ball is bound. */
SporeVec3 spore_weighted_confine(const SporeWeightedFit *fit, size_t ball, SporeVec3 centre);
/* How far out of the solid a ball may reach, m. */
double spore_weighted_reach(const SporeWeightedFit *fit);
/* Moves up to `most` balls of little worth to where a new ball would gain more. The sum must be up to date at all
 * samples. Does not evaluate. False: no memory. */
bool spore_weighted_replace(SporeWeightedFit *fit, size_t most);

#endif
