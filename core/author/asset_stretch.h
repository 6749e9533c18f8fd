/* The content of assets, stretched along the axes of their frame. No GTK. */
#ifndef SPORE_AUTHOR_ASSET_STRETCH_H
#define SPORE_AUTHOR_ASSET_STRETCH_H

#include "core/scene/document.h"

/* The text of the mesh, tetrahedra, spheres or curve with each coordinate multiplied by the factor of its axis, not 0;
 * radii grow by the mean of the factors (of equal size, else spheres would be none). An odd number of negative factors
 * mirrors: elements are turned, so that none is inside out. *extension: of the file that holds such a text. NULL with a
 * GError: the asset cannot be read. g_free. */
char *spore_asset_stretched(SporeDocument *document, SporeObject *asset, const double factors[3],
                            const char **extension, gsize *size, GError **error);
/* Whether the asset is of an element that can be stretched: a label map is not. */
gboolean spore_asset_is_stretchable(const SporeObject *asset);

#endif
