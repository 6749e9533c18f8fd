/* Which triangles of a drawn surface a cut goes through. */
#ifndef SPORE_SCENE_CUT_EDGES_H
#define SPORE_SCENE_CUT_EDGES_H

#include <glib.h>

#include "core/body/model.h"

/* The edges of the body that were cut, sorted: keys for spore_triangle_is_cut. g_array_unref. */
GArray *spore_cut_edges_of(const SporeCuts *cuts, guint32 body);
/* Whether the triangle follows nodes on both sides of one of these edges. mapping: of the surface's vertices, an
 * identity or linear. triangle: 3 vertices. */
gboolean spore_triangle_is_cut(const SporeMapping *mapping, const guint32 *triangle, const GArray *edges);

#endif
