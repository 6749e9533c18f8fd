/* Tissue as an effect. Private to the room. */
#ifndef SPORE_SIM_EFFECT_SHAPE_H
#define SPORE_SIM_EFFECT_SHAPE_H

#include "core/sim/effect/effect.h"

/* Gives the body, whose blocks are all nodes and are those of time 0, its shape in the next state. False: the body has
 * the shape of time 0, and the next state was not written. */
bool spore_body_shape_effect(SporeWorld *world, SporeBody *body);

#endif
