/* Copies of bodies, plain and mirrored. No GTK. */
#ifndef SPORE_AUTHOR_MIRROR_EDITS_H
#define SPORE_AUTHOR_MIRROR_EDITS_H

#include "core/math/vec3.h"
#include "core/scene/document.h"

/* Adds a copy of the body, mirrored at the plane across that axis of the scene (0: x) at that coordinate, m, as one
 * undo step: with mirrored assets of its own, and with the links that tie the body to the scene alone. "left" in its
 * name becomes "right", and the other way round. Returns the copy. NULL with a GError: the body is an instrument, or an
 * asset cannot be read. */
SporeObject *spore_edit_mirror(SporeDocument *document, SporeObject *body, int axis, double at, GError **error);
/* Adds copies of the bodies (of SporeObject *), that much farther in the scene, m, as one undo step: they share the
 * assets, and each has copies of the links that tie its body to the scene alone. Returns the copies in the same order;
 * g_ptr_array_unref. NULL with a GError: one is an instrument. */
GPtrArray *spore_edit_copy(SporeDocument *document, const GPtrArray *bodies, SporeVec3 offset, GError **error);
/* So far along x that copies stand beside the bodies, m. */
SporeVec3 spore_copy_offset(SporeDocument *document, const GPtrArray *bodies);
/* The coordinate of the middle of what all bodies show that no device moves; m. */
double spore_scene_middle(SporeDocument *document, int axis);

#endif
