/* Adding what a scene does not have yet, by path. No GTK. */
#ifndef SPORE_AUTHOR_ADDITION_H
#define SPORE_AUTHOR_ADDITION_H

#include "core/scene/document.h"

/* Adds an object, as one undo step. path: that of its parent and its element, with a name where it has one:
 * "links/spring:cord", "bodies/liver/fidelity", "bodies/liver/mechanical/spline_1d". Units of a body on the way are
 * made. A model takes the place of the one that the body has. Without a name, or where another has that name, the
 * object gets one that is free. NULL with a GError that names what may be added there. */
SporeObject *spore_edit_add(SporeDocument *document, const char *path, GError **error);
/* How to add what a path names and the scene does not have, such as "links/spring:cord"; alternatives stand between
 * bars. NULL: nothing of that path can be added. g_free. */
char *spore_edit_addition_for(SporeDocument *document, const char *path);

#endif
