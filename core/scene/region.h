/* Regions of a scene as balls: the region's own, and one for each dab of the brush that it was painted with. */
#ifndef SPORE_SCENE_REGION_H
#define SPORE_SCENE_REGION_H

#include "core/scene/document.h"

#define SPORE_REGION_BALLS 1000u /* of one region, at most */

/* region: an object with a centre and a radius, whose children are its dabs. At least 1. */
guint spore_region_ball_count(const SporeObject *region);
/* Of a region, or of one of its dabs: centre and radius. */
void spore_region_read_ball(const SporeObject *object, double ball[4]);
/* balls: room for spore_region_ball_count x 4: centre and radius, m, in the frame that the region is in. */
void spore_region_read_balls(const SporeObject *region, double *balls);
/* FALSE with an error at the region: it has more than SPORE_REGION_BALLS. */
gboolean spore_region_check_balls(const SporeObject *region, GError **error);

#endif
