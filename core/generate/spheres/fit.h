/* State of the fit, shared by its rounds and its relocations. */
#ifndef SPORE_GENERATE_SPHERES_FIT_H
#define SPORE_GENERATE_SPHERES_FIT_H

#include <math.h>

#include "core/generate/spheres/private.h"

typedef struct SporeFit {
  const SporeSolid *solid;
  const SporeSamples *samples;
  SporeBalls balls, trial, best;
  SporeField field, trial_field;
  double *normal;             /* balls x 14: lower triangle of the 4x4 matrix, and the right-hand side */
  double *worth;              /* balls: loss that its removal adds, its samples going to the second best */
  double *burden;             /* balls: loss of the samples it owns */
  double *spread;             /* balls x 10: weight, first and second moments of the samples it owns */
  double *known;              /* balls x 4: where a centre's depth was last asked for, and that depth */
  uint32_t *order, *heaviest; /* balls */
  const SporeBalls *candidates;
  double *missing;               /* candidates scored: depth that each would add */
  uint32_t *scored, *by_missing; /* candidates scored */
  size_t scored_count;
  const uint8_t *bound; /* balls: planes that they stay on; or NULL */
  bool *marked;         /* 2 x balls: done with in this pass; refitted in this trial */
  double smoothing, loss, best_loss, damping;
  SporeRandom random;
} SporeFit;

static inline double spore_fit_sample_loss(const SporeFit *fit, double error) {
  return sqrt(error * error + fit->smoothing * fit->smoothing);
}

/* The centre or its image that the ball may have. */
static inline SporeVec3 spore_fit_confine(const SporeFit *fit, size_t ball, SporeVec3 centre) {
  const SporeSymmetry *symmetry = &fit->solid->symmetry;
  if (!symmetry->count) return centre;
  return spore_symmetry_bind(symmetry, fit->bound ? fit->bound[ball] : 0, spore_symmetry_fold(symmetry, centre));
}

/* Moves the balls that are worth least to those candidates that would add more. `turn` chooses which candidates are
 * scored. Evaluates nothing. Returns how many moved. */
size_t spore_fit_fill(SporeFit *fit, size_t turn);
/* Sums up what each ball is worth and bears, and how what it owns lies. */
void spore_fit_weigh(SporeFit *fit);
/* Orders the balls: the one worth least first, the one that bears most first; `shake` in [0, 1) blurs both. */
void spore_fit_rank(SporeFit *fit, double shake);
/* Puts `target` and `spare` on both sides of the middle of what `target` owns. */
void spore_fit_split(SporeFit *fit, size_t target, size_t spare);
/* A ball after a damped step by its normal equations (14 numbers), kept from ballooning: no deeper out than the band.
 */
void spore_fit_step_ball(SporeFit *fit, size_t ball, const double *normal, double damping, double sphere[4]);
/* Adds the sample to the normal equations of its owner. */
void spore_fit_add_normal(const SporeFit *fit, size_t sample, double *normal);
/* Moves single balls to where they are worth more, refitting those around alone, as long as that pays. The field has to
 * be that of the balls; it is when this returns. False: cancelled or no memory. */
bool spore_fit_relocate(SporeFit *fit, const SporeProgressPart *progress, SporeError *error);

#endif
