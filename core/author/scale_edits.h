/* Making bodies larger and smaller. No GTK. */
#ifndef SPORE_AUTHOR_SCALE_EDITS_H
#define SPORE_AUTHOR_SCALE_EDITS_H

#include "core/scene/document.h"

/* The least and the greatest factor. */
#define SPORE_SCALE_LEAST 1e-3
#define SPORE_SCALE_GREATEST 1e3

/* FALSE with a GError where the bodies (of SporeObject *) cannot be scaled: one of them, or of those that their tools
 * tie to them, is an instrument, or generated data of theirs are frozen. */
gboolean spore_edit_may_scale(SporeDocument *document, const GPtrArray *bodies, GError **error);
/* Makes the bodies, with all that is placed on them, that many times as large about the middle of the box around them,
 * as one undo step: the meshes, cells, spheres and lines of all their units, lengths of their models and regions, ends
 * of links, radii of pins and mouths. What other bodies use, too, is copied first. Generated data stay fresh: their
 * sources and options are scaled with them. Densities and stiffnesses stay, so that masses grow with the volume. FALSE
 * with a GError: see spore_edit_may_scale; or the factor is out of range, or an asset cannot be read. */
gboolean spore_edit_scale(SporeDocument *document, const GPtrArray *bodies, double factor, GError **error);

#endif
