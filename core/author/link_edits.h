/* Links made of places that an author picks. No GTK. */
#ifndef SPORE_AUTHOR_LINK_EDITS_H
#define SPORE_AUTHOR_LINK_EDITS_H

#include "core/scene/document.h"

#define SPORE_LINK_MOST_ENDS 2

/* An end of a link. */
typedef struct SporeLinkEnd {
  SporeObject *body; /* NULL: the scene */
  SporeVec3 place;   /* in the scene at time 0, m */
} SporeLinkEnd;

/* Whether the object is a link. NULL is none. */
gboolean spore_link_is(const SporeObject *object);
/* How many ends a kind of link has: as many as it names bodies. */
guint spore_link_end_count(const SporeObjectType *type);
/* What the end is, translated, as the kind's table says: "Body at the second end; none: the end is fixed in the
 * scene.". Borrowed. */
const char *spore_link_end_doc(const SporeObjectType *type, guint end);

/* Adds a link of that element between the ends, as one undo step, named after its first body. An end that is missing
 * is the scene. What a kind holds at one place it holds at the first end, a port at the second, which is the place of
 * the port. An axis or line runs from the first end to the second, if these are apart. A pin holds a part of the body
 * that is proportional to the size of the body, with the node nearest to the click at least. NULL with a GError: no
 * link of that kind, or the first end has no body, or the ends of a seam are of one body. */
SporeObject *spore_edit_add_link(SporeDocument *document, const char *element, const SporeLinkEnd *ends, guint count,
                                 GError **error);
/* Ties an existing link to other ends, as one undo step. Its other parameters stay. */
gboolean spore_edit_tie_link(SporeDocument *document, SporeObject *link, const SporeLinkEnd *ends, guint count,
                             GError **error);
/* Places of a link at time 0, one for each end; both are the same where a link holds at one place. A seam holds all
 * over its bodies: the places are the middles of the meshes that these show. Returns the number, 0: a body is missing
 * or is nowhere. */
guint spore_link_places(SporeDocument *document, const SporeObject *link, SporeVec3 places[SPORE_LINK_MOST_ENDS]);

#endif
