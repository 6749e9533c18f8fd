/* Regions of a scene as balls: the region's own, and one for each dab of the brush that it was painted with. */
#ifndef SPORE_SCENE_REGION_H
#define SPORE_SCENE_REGION_H

#include "core/scene/document.h"

#define SPORE_REGION_BALLS 1000u /* of one region, at most */

/* region: an object with a centre and a radius, whose children are its dabs. At least 1. */
guint spore_region_ball_count(const SporeObject *region);
/* Of a region, or of one of its dabs: centre and radius. */
void spore_region_read_ball(const SporeObject *object, double ball[4]);
/* The balls of a region: count x 4, centre and radius, m, in the frame that the region is in. g_free. NULL: no region,
 * and *count is 0. */
double *spore_region_balls(const SporeObject *region, guint *count);
/* FALSE with an error at the region: it has more than SPORE_REGION_BALLS. */
gboolean spore_region_check_balls(const SporeObject *region, GError **error);

#endif
