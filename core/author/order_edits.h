/* The order in which a scene lists its objects. No GTK. */
#ifndef SPORE_AUTHOR_ORDER_EDITS_H
#define SPORE_AUTHOR_ORDER_EDITS_H

#include "core/scene/document.h"

/* Moves the objects of these ids (of guint32), which belong to the section of the target, to stand just before it
 * (after: just behind it), in the order that they have; one undo step. The target may be one of them. FALSE with a
 * GError: nothing was moved, since one of them belongs elsewhere. */
gboolean spore_edit_reorder(SporeDocument *document, const GArray *ids, SporeObject *target, gboolean after,
                            GError **error);

#endif
