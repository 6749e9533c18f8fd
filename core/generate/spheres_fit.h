/* State of the fit, shared by its rounds and its relocations. */
#ifndef SPORE_GENERATE_SPHERES_FIT_H
#define SPORE_GENERATE_SPHERES_FIT_H

#include <math.h>

#include "core/generate/spheres_parts.h"

typedef struct SporeFit {
  const SporeSolid *solid;
  const SporeSamples *samples;
  SporeBalls balls, trial, best;
  SporeField field, trial_field;
  double *normal;             /* balls x 14: lower triangle of the 4x4 matrix, and the right-hand side */
  double *worth;              /* balls: loss that its removal adds, its samples going to the second best */
  double *burden;             /* balls: loss of the samples it owns */
  double *spread;             /* balls x 10: weight, first and second moments of the samples it owns */
  uint32_t *order, *heaviest; /* balls */
  const SporeBalls *candidates;
  double *missing;               /* candidates scored: depth that each would add */
  uint32_t *scored, *by_missing; /* candidates scored */
  size_t scored_count;
  bool *marked; /* balls */
  double smoothing, loss, best_loss, damping;
  SporeRandom random;
} SporeFit;

static inline double spore_fit_sample_loss(const SporeFit *fit, double error) {
  return sqrt(error * error + fit->smoothing * fit->smoothing);
}

/* Moves the balls that are worth least to those candidates that would add more. `turn` chooses which candidates are
 * scored. Evaluates nothing. Returns how many moved. */
size_t spore_fit_fill(SporeFit *fit, size_t turn);
/* Takes up to `wanted` balls that are worth least and splits with them those that bear most; `shake` in [0, 1) blurs
 * the order. Evaluates nothing. Returns how many moved. */
size_t spore_fit_relocate(SporeFit *fit, size_t wanted, double shake);

#endif
