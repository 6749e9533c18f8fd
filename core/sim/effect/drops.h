/* A fluid as an effect. Private to the room. */
#ifndef SPORE_SIM_EFFECT_DROPS_H
#define SPORE_SIM_EFFECT_DROPS_H

#include "core/sim/effect/effect.h"

/* Makes room for the drops of a body that may be poured. */
bool spore_body_make_drops(SporeBody *body, SporeError *error);
/* Moves the drops in the next state. */
void spore_body_pour(SporeWorld *world, SporeBody *body);

/* settle.c */
bool spore_drops_make_rest(SporeWorld *world, SporeBody *body); /* false: no memory */
void spore_drops_clear_rest(SporeDropRest *rest);
/* Whether the drops stay where they are in this step: they sleep, or have just woken. */
bool spore_drops_stay(SporeWorld *world, SporeBody *body);
/* After they were moved: lets them sleep once they lie still. */
void spore_drops_watch(SporeWorld *world, SporeBody *body);
/* They are moved again, from the next step on. Allowed for any body. */
void spore_drops_wake(SporeWorld *world, SporeBody *body);

#endif
