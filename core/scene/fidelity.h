/* Physical or effect: what the scene says of a body, and what was advised. */
#ifndef SPORE_SCENE_FIDELITY_H
#define SPORE_SCENE_FIDELITY_H

#include "core/scene/document.h"

/* What the fidelity of a body comes to. */
typedef enum SporeFidelityState {
  SPORE_FIDELITY_IS_PHYSICAL,
  SPORE_FIDELITY_IS_EFFECT,
  SPORE_FIDELITY_NOT_ADVISED, /* auto, without advice: physical */
  SPORE_FIDELITY_OUTDATED     /* auto, with advice for another state of the scene: physical */
} SporeFidelityState;
/* fidelity: NULL: physical. */
SporeFidelityState spore_fidelity_state(SporeDocument *document, const SporeObject *fidelity);
/* Sets the mode, as commands. */
gboolean spore_fidelity_set_mode(SporeDocument *document, SporeObject *body, const char *mode, GError **error);
/* Gives all bodies of mode auto the mode that this comes to now, so that it stays when the scene is varied. */
gboolean spore_fidelity_resolve(SporeDocument *document, GError **error);
/* Sets mode auto and the advice for the scene as it is, as commands. */
gboolean spore_fidelity_advise(SporeDocument *document, SporeObject *body, gboolean effect, GError **error);

#endif
