/* Deleting objects with what is nothing without them. No GTK. */
#ifndef SPORE_AUTHOR_REMOVAL_H
#define SPORE_AUTHOR_REMOVAL_H

#include "core/scene/document.h"

/* Deletes the objects of these ids (of guint32) that are there and have a name, as one undo step. With a body go the
 * links and emitters that name it. With the body of an instrument go its tool, the other bodies of the tool, what hangs
 * on it (the film of a bag), its cameras, and assets that nothing else uses. FALSE with a GError: an object belongs to
 * every scene. */
gboolean spore_edit_delete(SporeDocument *document, const GArray *ids, GError **error);

#endif
