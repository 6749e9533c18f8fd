/* Physical or effect: what the scene says of a body, a tool or an emitter, and what was advised. */
#ifndef SPORE_SCENE_FIDELITY_H
#define SPORE_SCENE_FIDELITY_H

#include "core/scene/document.h"

/* What fidelity comes to. */
typedef enum SporeFidelityState {
  SPORE_FIDELITY_IS_PHYSICAL,
  SPORE_FIDELITY_IS_EFFECT,
  SPORE_FIDELITY_NOT_ADVISED, /* auto, without advice: physical */
  SPORE_FIDELITY_OUTDATED     /* auto, with advice for another state of the scene: physical */
} SporeFidelityState;
/* fidelity: NULL: physical. */
SporeFidelityState spore_fidelity_state(SporeDocument *document, const SporeObject *fidelity);
/* The objects that may be effects: bodies, tools and emitters that hold fidelity. GPtrArray of SporeObject *, to be
 * unreffed. */
GPtrArray *spore_fidelity_holders(SporeDocument *document);
/* Whether it is an effect as the scene says. */
gboolean spore_fidelity_is_effect(SporeDocument *document, const SporeObject *holder);
/* Whether the element has a form as an effect, and something of that would be seen: an emitter stains its source. */
gboolean spore_fidelity_is_seen(const SporeObject *holder);
/* Sets the mode, as commands. */
gboolean spore_fidelity_set_mode(SporeDocument *document, SporeObject *holder, const char *mode, GError **error);
/* Gives all that have mode auto the mode that this comes to now, so that it stays when the scene is varied. */
gboolean spore_fidelity_resolve(SporeDocument *document, GError **error);
/* Sets mode auto and the advice for the scene as it is, as commands. */
gboolean spore_fidelity_advise(SporeDocument *document, SporeObject *holder, gboolean effect, GError **error);

#endif
