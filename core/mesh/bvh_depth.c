/* Distances by what is known beside, and the depth: the distance with the sign of the side. */
#include <math.h>

#include "core/mesh/bvh_node.h"

#define ROUND (1 + 1e-9)

double spore_bvh_depth(const SporeBvh *bvh, SporeVec3 p) {
  double distance = spore_bvh_distance(bvh, p, NULL, NULL);
  return spore_bvh_inside(bvh, p) ? distance : -distance;
}

double spore_bvh_distance_beside(const SporeBvh *bvh, SporeVec3 p, SporeVec3 *nearest) {
  double below = ROUND * spore_vec3_distance(p, *nearest),
         distance = spore_bvh_distance_below(bvh, p, below, nearest, NULL);
  return distance >= below ? spore_bvh_distance(bvh, p, nearest, NULL) : distance; /* both are 0 */
}

SporeBvhKnown spore_bvh_depth_beside(const SporeBvh *bvh, SporeVec3 p, const SporeBvhKnown *known) {
  SporeBvhKnown here = {.place = p, .nearest = known->nearest};
  here.depth = known->depth != 0 ? spore_bvh_distance_beside(bvh, p, &here.nearest)
                                 : spore_bvh_distance(bvh, p, &here.nearest, NULL);
  bool same = spore_vec3_distance(p, known->place) < fabs(known->depth);
  if (same ? known->depth < 0 : !spore_bvh_inside(bvh, p)) here.depth = -here.depth;
  return here;
}
