/* Where a fluid goes that is put onto an organ: out of its surface, and clear of what is felt there. */
#ifndef SPORE_AUTHOR_FLUID_PLACE_H
#define SPORE_AUTHOR_FLUID_PLACE_H

#include "core/scene/document.h"

/* A place on a surface that a body shows, in the scene at time 0, m. */
typedef struct SporeSurfacePlace {
  SporeObject *body;
  SporeVec3 at, outward; /* outward: of length 1 */
  double size;           /* m: diagonal of the box around what the body shows */
} SporeSurfacePlace;

/* The place of a drawn surface that is nearest to a point: of that body's, or, body NULL, of all bodies' that no device
 * moves. FALSE: nothing is shown. */
gboolean spore_surface_nearest(SporeDocument *document, SporeObject *body, SporeVec3 point, SporeSurfacePlace *place);

/* How far along `outward` a ball of that radius, m, is clear of the body's spheres. */
double spore_surface_clear(SporeDocument *document, const SporeSurfacePlace *place, double radius);

/* The middle of a ball over the place, upward where the surface looks up and outward elsewhere, that touches no body's
 * spheres and no body's drawn surface. FALSE: there is no room within four radii. */
gboolean spore_surface_room(SporeDocument *document, const SporeSurfacePlace *place, double radius, SporeVec3 *middle);

#endif
