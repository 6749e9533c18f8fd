/* A body that is a spline sheet: the patch of a surface between four corners. No GTK. */
#ifndef SPORE_AUTHOR_SHEET_BODY_H
#define SPORE_AUTHOR_SHEET_BODY_H

#include "core/generate/sheet/sheet.h"
#include "core/scene/document.h"

/* The body becomes a spline sheet along the patch, a mesh asset, and shows the patch. Collision spheres of another
 * surface go; pins stay. Call it inside a group. */
gboolean spore_sheet_body_fill(SporeDocument *document, SporeObject *body, SporeObject *patch,
                               const SporeSheetReport *sheet, double smoothing, GError **error);
/* A new body where the organ is, named after it; without units. Call it inside a group. */
SporeObject *spore_sheet_body_beside(SporeDocument *document, SporeObject *organ, GError **error);

#endif
