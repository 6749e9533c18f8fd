/* A fluid as an effect. Private to the room. */
#ifndef SPORE_SIM_EFFECT_DROPS_H
#define SPORE_SIM_EFFECT_DROPS_H

#include "core/sim/effect/effect.h"

/* Makes room for the drops of a body that may be poured. */
bool spore_body_make_drops(SporeBody *body, SporeError *error);
/* Moves the drops in the next state. */
void spore_body_pour(SporeWorld *world, SporeBody *body);

#endif
