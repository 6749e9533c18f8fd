/* Deleting objects with what is nothing without them. No GTK. */
#ifndef SPORE_AUTHOR_REMOVAL_H
#define SPORE_AUTHOR_REMOVAL_H

#include "core/scene/document.h"

/* What went along with what was deleted, since nothing else used it. */
typedef struct SporeAlong {
  char *path;
  char *text; /* its kind and name, translated */
} SporeAlong;
GPtrArray *spore_along_new(void); /* of SporeAlong *, none yet. g_ptr_array_unref */

/* Deletes the objects of these ids (of guint32) that are there and have a name, as one undo step. With a body go the
 * links and emitters that name it. With the body of an instrument go its tool, the other bodies of the tool, what hangs
 * on it (the film of a bag), its cameras, and assets that nothing else uses. alone FALSE: with an organ go assets that
 * nothing else uses, with those they were made from and those that were made from them; and steps and metrics of the
 * exercise that name what goes; both are added to `along`. FALSE with a GError: an object belongs to every scene. */
gboolean spore_edit_delete(SporeDocument *document, const GArray *ids, gboolean alone, GPtrArray *along,
                           GError **error);

#endif
