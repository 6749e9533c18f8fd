/* Bodies made stiffer, heavier or harder to the touch, by a factor. */
#ifndef SPORE_SCENE_SCALING_H
#define SPORE_SCENE_SCALING_H

#include "core/scene/document.h"

/* What is scaled. Properties of models are found by their units, so that a new model needs nothing here. */
typedef enum SporeScaled {
  SPORE_SCALED_STIFFNESS, /* of models: N/m, N/m^2, N/m^3, Pa */
  SPORE_SCALED_MASS,      /* of models: kg, kg/m, kg/m^2, kg/m^3 */
  SPORE_SCALED_CONTACT    /* stiffness of the contact law */
} SporeScaled;

/* Multiplies the properties of the unit that holds them: a body's model, or its collision unit. A value stays within
 * its range. Values that are 0 stay 0: they are for "none" and "left open". Returns one of the properties that were
 * set, or -1 where there is none. */
int spore_object_scale(SporeDocument *document, SporeObject *body, SporeScaled what, double factor);
/* The unit of the body that holds such properties; NULL: none. */
SporeObject *spore_object_scaled_unit(const SporeObject *body, SporeScaled what);

#endif
