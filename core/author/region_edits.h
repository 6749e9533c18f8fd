/* Regions: balls in which a body is of another stiffness, or a generator makes it finer. Each change is one undo step.
 * No GTK. */
#ifndef SPORE_AUTHOR_REGION_EDITS_H
#define SPORE_AUTHOR_REGION_EDITS_H

#include "core/scene/document.h"

gboolean spore_region_is(const SporeObject *object);
/* A region in the middle of the body, as wide as a quarter of it. holder: path of the object that it becomes a child
 * of, which may be a unit that its body does not have yet. NULL with an error. */
SporeObject *spore_edit_add_region(SporeDocument *document, SporeObject *body, const char *holder, GError **error);
/* The region of that path; NULL with an error: there is none. */
SporeObject *spore_edit_find_region(SporeDocument *document, const char *path, GError **error);
/* Takes away an object by its path; a holder of `regions` that is left empty goes too. */
gboolean spore_edit_remove_region(SporeDocument *document, const char *path, GError **error);
/* Puts its centre (body's frame, m) and radius (m) where they are given, each where it differs. */
gboolean spore_edit_place_region(SporeDocument *document, SporeObject *region, const double centre[3], double radius,
                                 GError **error);
/* x y z r of it. */
void spore_region_ball(const SporeObject *region, double ball[4]);
/* Rings around the regions that the object holds, body's frame: segments of 2 points of 3. g_free; *count segments. */
double *spore_region_rings(const SporeObject *holder, gsize *count);

#endif
