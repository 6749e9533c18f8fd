/* Regions: balls, placed or painted, in which a body has another stiffness, or a generator makes a finer result. Each
 * change is one undo step. No GTK. */
#ifndef SPORE_AUTHOR_REGION_EDITS_H
#define SPORE_AUTHOR_REGION_EDITS_H

#include "core/scene/document.h"

gboolean spore_region_is(const SporeObject *object);
gboolean spore_region_is_dab(const SporeObject *object);
/* Adds a region in the middle of the body, a quarter of the body wide. holder: path of the object that gets the region
 * as a child; it may be a unit that the body lacks. NULL with an error. */
SporeObject *spore_edit_add_region(SporeDocument *document, SporeObject *body, const char *holder, GError **error);
/* Gives the region these balls (core/author/brush.h): the first is its own, the others are its dabs. count: at least 1.
 */
gboolean spore_edit_paint_region(SporeDocument *document, SporeObject *region, const double *balls, gsize count,
                                 GError **error);
/* A new region with these balls. name: NULL: one that is free; holder: as of spore_edit_add_region. */
SporeObject *spore_edit_add_painted_region(SporeDocument *document, const char *holder, const char *name,
                                           const double *balls, gsize count, GError **error);
/* The region of that path; NULL with an error: there is none. */
SporeObject *spore_edit_find_region(SporeDocument *document, const char *path, GError **error);
/* Removes a region by its path, and with it a `regions` unit that is left empty. */
gboolean spore_edit_remove_region(SporeDocument *document, const char *path, GError **error);
/* Sets centre (body's frame, m) and radius (m), where they are given and differ. */
gboolean spore_edit_place_region(SporeDocument *document, SporeObject *region, const double centre[3], double radius,
                                 GError **error);
/* Rings around the regions that the object holds, and crosses in the dabs of those that are painted; body's frame:
 * segments of 2 points of 3. g_free; *count segments. */
double *spore_region_marks(const SporeObject *holder, gsize *count);
/* With how many dabs it is painted, and how many of the body's tetrahedra it holds, in words; NULL: neither. g_free. */
char *spore_region_facts(SporeDocument *document, const SporeObject *region);

#endif
