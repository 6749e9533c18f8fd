/* One step of TR-BDF2 (Bank et al. 1985; Hosea and Shampine 1996), which BDF2 starts with too. */
#ifndef SPORE_INTEGRATE_TR_BDF2_H
#define SPORE_INTEGRATE_TR_BDF2_H

#include "core/integrate/stage.h"

#define SPORE_TR_BDF2_SCRATCH (7 + SPORE_STAGE_SCRATCH) /* vectors of 3 block_count */

/* What is wanted of a step beside its end: vectors of 3 block_count, or NULL. */
typedef struct SporeTrBdf2Extra {
  double start_s; /* in: this step's start after the time that `set_time` counts from */
  /* As velocities at q1: the step's mean momentum less that at its end, and that at its end less that at its start. */
  double *mean, *change;
  double *error; /* estimated local error of the displacement, m; to be measured with the M that the step leaves */
} SporeTrBdf2Extra;

/* M is to be that at q0, and is that of another place after it. */
SporeStepResult spore_tr_bdf2_step(const SporeDynamics *dynamics, const SporeSolverFields *fields,
                                   const SporeTrBdf2Extra *extra, double h, const double *q0, const double *v0,
                                   double *q1, double *v1, double *scratch);

#endif
