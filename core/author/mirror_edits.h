/* Mirrored copies of bodies. No GTK. */
#ifndef SPORE_AUTHOR_MIRROR_EDITS_H
#define SPORE_AUTHOR_MIRROR_EDITS_H

#include "core/math/vec3.h"
#include "core/scene/document.h"

/* Adds a copy of the body, mirrored at the plane across that axis of the scene (0: x) at that coordinate, m, as one
 * undo step: with mirrored assets of its own, and with the links that tie the body to the scene alone. "left" in its
 * name becomes "right", and the other way round. Returns the copy. NULL with a GError: the body is an instrument, or an
 * asset cannot be read. */
SporeObject *spore_edit_mirror(SporeDocument *document, SporeObject *body, int axis, double at, GError **error);
/* The coordinate of the middle of what all bodies show that no device moves; m. */
double spore_scene_middle(SporeDocument *document, int axis);

#endif
