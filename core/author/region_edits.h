/* Regions: balls in which a body is of another stiffness, or a generator makes it finer. Each change is one undo step.
 * No GTK. */
#ifndef SPORE_AUTHOR_REGION_EDITS_H
#define SPORE_AUTHOR_REGION_EDITS_H

#include "core/scene/document.h"

/* Element of the regions that this kind of object holds: "region" of `regions`; NULL: it holds none. */
const char *spore_region_element(const SporeObjectType *holder);
/* A region in the middle of the body, as wide as a quarter of it. holder: path of the object that it becomes a child
 * of, which may be a unit that its body does not have yet. NULL with an error. */
SporeObject *spore_edit_add_region(SporeDocument *document, SporeObject *body, const char *holder, GError **error);
/* Takes away an object by its path; a holder of `regions` that is left empty goes too. */
gboolean spore_edit_remove_region(SporeDocument *document, const char *path, GError **error);
/* Rings around the regions that the object holds, body's frame: segments of 2 points of 3. g_free; *count segments. */
double *spore_region_rings(const SporeObject *holder, gsize *count);

#endif
