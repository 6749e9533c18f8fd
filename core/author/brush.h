/* A brush that paints balls: the dabs of a region. No document, no GTK. */
#ifndef SPORE_AUTHOR_BRUSH_H
#define SPORE_AUTHOR_BRUSH_H

#include <glib.h>

#include "core/math/vec3.h"

/* Balls that are painted: of 4 doubles each, centre and radius, m. g_array_unref. */
GArray *spore_brush_balls_new(const double *balls, gsize count);
/* Their numbers, borrowed until the balls change. */
static inline const double *spore_brush_numbers(const GArray *balls) {
  return (const double *)(const void *)balls->data;
}
/* Adds a dab of that radius (m, above 0). A dab is left out where it would add little: a ball that is at least as large
 * lies within half of the radius. Balls that the dab covers go. TRUE: the balls have changed. */
gboolean spore_brush_paint(GArray *balls, SporeVec3 place, double radius);
/* Takes away the balls whose middle lies within the radius of the place. TRUE: the balls have changed. */
gboolean spore_brush_erase(GArray *balls, SporeVec3 place, double radius);

#endif
