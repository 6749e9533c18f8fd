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
  double *worth;              /* balls: loss that removing the ball adds, its samples going to the second best ball */
  double *burden;             /* balls: loss of the samples it owns */
  double *spread;             /* balls x 10: weight, first and second moments of the samples it owns */
  double *known;              /* balls x 4: place where the depth of a centre was last computed, and that depth */
  uint32_t *order, *heaviest; /* balls */
  const SporeBalls *candidates;
  double *missing;               /* candidates scored: depth that each would add */
  uint32_t *scored, *by_missing; /* candidates scored */
  size_t scored_count;
  const uint8_t *bound; /* balls: bits of the mirror planes that each stays on; or NULL */
  bool *marked;         /* 2 x balls: handled in this pass; refitted in this trial */
  double smoothing, loss, best_loss, damping;
  SporeRandom random;
} SporeFit;

static inline double spore_fit_sample_loss(const SporeFit *fit, double error) {
  return sqrt(error * error + fit->smoothing * fit->smoothing);
}

/* The allowed centre for the ball: folded by the symmetry and projected on the planes to which the ball is bound. */
static inline SporeVec3 spore_fit_confine(const SporeFit *fit, size_t ball, SporeVec3 centre) {
  const SporeSymmetry *symmetry = &fit->solid->symmetry;
  if (!symmetry->count) return centre;
  return spore_symmetry_bind(symmetry, fit->bound ? fit->bound[ball] : 0, spore_symmetry_fold(symmetry, centre));
}

/* Moves the balls of least worth to candidates that would add more. `turn` selects the candidates that are scored. Does
 * not evaluate the field. Returns how many balls moved. */
size_t spore_fit_fill(SporeFit *fit, size_t turn);
/* Sums up each ball's worth and burden, and the moments of the samples it owns (spread). */
void spore_fit_weigh(SporeFit *fit);
/* Sorts the balls: `order` by ascending worth, `heaviest` by descending burden. `shake` in [0, 1) perturbs both at
 * random. */
void spore_fit_rank(SporeFit *fit, double shake);
/* Puts `target` and `spare` on opposite sides of the middle of the samples that `target` owns. */
void spore_fit_split(SporeFit *fit, size_t target, size_t spare);
/* sphere: the ball after a damped step by its normal equations (14 numbers). The radius is limited so that the ball
 * reaches no farther out of the solid than the band. */
void spore_fit_step_ball(SporeFit *fit, size_t ball, const double *normal, double damping, double sphere[4]);
/* Adds the sample to the normal equations of its owner. */
void spore_fit_add_normal(const SporeFit *fit, size_t sample, double *normal);
/* Relocates single balls as long as that lowers the loss, and refits only the balls around. The field must be up to
 * date on entry; it is on return. False: cancelled or no memory. */
bool spore_fit_relocate(SporeFit *fit, const SporeProgressPart *progress, SporeError *error);

#endif
