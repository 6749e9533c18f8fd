/* What a hand may lead: the active bodies of the scene, but jaws, which go with their tool. No GTK. */
#ifndef SPORE_UI_DOCUMENT_HANDS_H
#define SPORE_UI_DOCUMENT_HANDS_H

#include "core/scene/document.h"

/* Bodies that a device moves, in the order of the scene: of SporeObject *, borrowed. g_ptr_array_unref. */
GPtrArray *spore_hands(SporeDocument *document);
/* The body that a device moves when the user chooses this object: a body, a part of one, or a tool. NULL: the object,
 * which may be NULL, is of nothing that is led. */
SporeObject *spore_hand_of(SporeDocument *document, SporeObject *object);
/* The two bodies that close on each other, of which one may be the hand itself. FALSE: it has no jaws. */
gboolean spore_hand_jaws(SporeDocument *document, const SporeObject *hand, SporeObject *jaws[2]);
/* Whether it stays closed until a second button opens it. */
gboolean spore_hand_latches(SporeDocument *document, const SporeObject *hand);
/* Whether something comes out of it while a second button is down. */
gboolean spore_hand_pours(SporeDocument *document, const SporeObject *hand);

#endif
