/* State of the fit of weighted spheres, shared by its rounds and its relocations. */
#ifndef SPORE_GENERATE_SPHERES_WEIGHTED_PARTS_H
#define SPORE_GENERATE_SPHERES_WEIGHTED_PARTS_H

#include "core/generate/spheres/weighted.h"

#define SPORE_WEIGHTED_UNKNOWNS 5 /* of a ball: centre, radius, weight */
#define SPORE_WEIGHTED_COLUMNS 5  /* of a sample: place, depth, weight */
#define SPORE_WEIGHTED_REGION 16  /* groups: balls are ruled out for a region, then for a group, then for a block */
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
  SporeWeightedImages images, near_region, near_group, near_block; /* all; scratch: those that reach each */
  double *region;   /* SPORE_WEIGHTED_REGION groups each, x 4: centre and radius */
  uint8_t *reaches; /* scratch, images */
  uint32_t *listed; /* scratch, images     */
  float *loaded;    /* blocks x COLUMNS x SPORE_BLOCK: samples relative to the block's middle, lengths in `typical` */
  float *distance;  /* scratch, images x SPORE_BLOCK */
  float *columns, *slopes; /* images x UNKNOWNS, for a block; slopes also has the level's slope */
  size_t image_count;      /* most */
  SporeRandom random;
  double smoothing, level; /* m */
  bool levelled;           /* the level is an unknown; else it is 0 */
} SporeWeightedFit;

/* Room for `most` images; false: no memory. */
bool spore_weighted_images_create(SporeWeightedImages *images, size_t most);
void spore_weighted_images_clear(SporeWeightedImages *images);
/* Fills `loaded` from the samples, whose weights are set. */
void spore_weighted_load_samples(SporeWeightedFit *fit);
/* Fills `region` from the groups of samples. */
void spore_weighted_bound_regions(SporeWeightedFit *fit);
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
