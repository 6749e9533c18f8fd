/* Lenses: what wets the front of an endoscope, and the haze before it. Part of the picture alone: nothing of the motion
 * reads a lens. */
#ifndef SPORE_SIM_EFFECT_LENS_H
#define SPORE_SIM_EFFECT_LENS_H

#include "core/sim/state/state.h"

/* The lens of an eye. */
typedef struct SporeLens {
  uint32_t body;          /* it moves with; SPORE_NO_BODY: it stands still */
  SporeVec3 point, sight; /* middle of the front, and the way it looks; in the body's frame */
  double radius, haze_s;  /* as in SporeEyeDescription */
  bool has_port;
  SporeVec3 pivot, inward; /* the port that it goes through, world; the way in along the shaft, in the body's frame */
} SporeLens;

/* One of each eye. */
typedef struct SporeLenses {
  size_t count;
  SporeLens *all;
  SporeLensState *state;
} SporeLenses;

/* Makes a lens for each eye. False: no memory. */
bool spore_world_create_lenses(SporeWorld *world, const SporeWorldDescription *description);
void spore_world_clear_lenses(SporeWorld *world);
/* All are clean, and nothing is before them. */
void spore_world_reset_lenses(SporeWorld *world);
/* Makes a lens clean. lens: any number; one that is not there is left alone. */
void spore_world_wipe_lens(SporeWorld *world, size_t lens);
/* Whether something may come onto a lens, or before it. */
bool spore_world_may_wet_lens(const SporeWorld *world);
/* Stage: drops wet the lenses that they touch, smoke hazes the view. */
void spore_world_wet_lenses(SporeWorld *world);

#endif
