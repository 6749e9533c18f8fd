/* Stains: how much of the colour of fluids the surface of each body has taken on. Part of the picture alone: nothing of
 * the motion reads a stain. */
#ifndef SPORE_SIM_EFFECT_STAIN_H
#define SPORE_SIM_EFFECT_STAIN_H

#include "core/sim/state/state.h"

/* The places on a body's spheres that may be stained. */
typedef struct SporeStainUnit {
  size_t start, count;  /* of its places among all */
  double *rest;         /* count x 3, body's frame at rest, m */
  float *out;           /* count x 3: unit vectors out of the spheres that the places are on */
  uint32_t *first;      /* of each sphere the first of its places, and one more */
  SporeMapping mapping; /* of the places, or of the middles of their spheres */
  double *lean; /* count x 3: from there to the places, in the scene's axes; NULL: the mapping is of the places */
} SporeStainUnit;

/* What wets a place in a step. */
typedef struct SporeWetting {
  float dyeing, washing; /* 1/s */
} SporeWetting;

/* The stains of the world. Without a fluid and something that it may touch there are none. */
typedef struct SporeStains {
  SporeStainUnit *units; /* one a body; NULL: there are no stains */
  size_t count;          /* places of all bodies */
  float *amount;         /* count, 0..1 */
  uint64_t number;       /* changes whenever an amount changes; 0: nothing was ever stained */
  size_t wet_count;      /* places that are wet in this step */
  uint32_t *wet;         /* count */
  SporeWetting *wetting; /* count; all 0 between steps */
} SporeStains;

/* Makes what is stained while the world runs. False: no memory. */
bool spore_world_create_stains(SporeWorld *world, const SporeWorldDescription *description);
void spore_world_clear_stains(SporeWorld *world);
/* Nothing is stained any more. */
void spore_world_reset_stains(SporeWorld *world);
/* Whether something may be stained, or washed. */
bool spore_world_may_stain(const SporeWorld *world);
/* Steps from one look at what is wet to the next. */
double spore_stain_pace(const SporeWorld *world);
/* Stage: what drops lie on takes on their colour, or loses it. */
void spore_world_stain(SporeWorld *world);

#endif
