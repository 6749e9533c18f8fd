/* Momentum of a whole body, and velocities that have a given momentum. */
#ifndef SPORE_BODY_MOMENTUM_H
#define SPORE_BODY_MOMENTUM_H

#include "core/body/model.h"

typedef struct SporeMotion { /* of a whole body; angular momentum and inertia are about `centre` */
  double mass;               /* kg */
  SporeVec3 centre;          /* m */
  SporeVec3 momentum;        /* N s */
  SporeVec3 angular;         /* N m s */
  SporeMat3 inertia;         /* kg m^2 */
  double kinetic;            /* J */
} SporeMotion;

/* q, v: state of the model. centre: NULL takes the centre of mass. */
SporeMotion spore_model_motion(const SporeModel *model, const double *q, const double *v, const SporeVec3 *centre);
/* Gives the velocities v the momentum of `before`. Then motion besides that momentum is taken away until the kinetic
 * energy is at most `kinetic`, J, as far as the momentum allows. */
void spore_model_keep_momentum(const SporeModel *model, const double *q, const SporeMotion *before, double kinetic,
                               double *v);

#endif
