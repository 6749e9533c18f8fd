/* Which voxel a place in or on the organ belongs to. */
#include <math.h>

#include "core/generate/centreline/private.h"

#define LIFT 1e-3 /* of a voxel: a place on the surface is moved inward by this */
#define NEAR 3.0  /* voxels: farther voxels do not belong to a place */

/* The place itself if it is inside; else the nearest place of the surface, a little further in. */
static SporeVec3 move_inside(const SporeSolid *solid, SporeVec3 p, double lift) {
  SporeVec3 foot;
  uint32_t triangle;
  if (spore_bvh_depth(solid->bvh, p) > lift) return p;
  spore_bvh_distance(solid->bvh, p, &foot, &triangle);
  return spore_vec3_add_scaled(
      foot, -lift, spore_vec3_normalise(spore_triangle_across(&solid->mesh, triangle), spore_vec3(0, 0, 0)));
}

uint32_t spore_voxel_of_place(const SporeVoxelTube *tube, SporeVec3 p) {
  uint32_t nearest = SPORE_NO_VOXEL;
  double least = NEAR * tube->edge;
  SporeVec3 from = move_inside(tube->solid, p, LIFT * tube->edge);
  for (uint32_t i = 0; i < tube->count; i++) {
    if (tube->component[i]) continue;
    SporeVec3 middle = spore_voxel_middle(tube, i);
    double distance = spore_vec3_distance(from, middle);
    if (distance < least && spore_passage_open(tube, from, middle)) least = distance, nearest = i;
  }
  return nearest;
}

/* Voxel within `width` voxels along each axis that is nearest to a place inside and can be seen from it. */
static uint32_t seen_from(const SporeVoxelTube *tube, SporeVec3 p, int width) {
  const double at[3] = {p.x, p.y, p.z};
  int64_t middle[3];
  uint32_t nearest = SPORE_NO_VOXEL;
  double least = HUGE_VAL;
  int side = 2 * width + 1;
  for (int k = 0; k < 3; k++) middle[k] = (int64_t)floor((at[k] - tube->lower[k]) / tube->edge);
  for (int i = 0; i < side * side * side; i++) {
    const int64_t place[3] = {middle[0] + i / (side * side) - width, middle[1] + i / side % side - width,
                              middle[2] + i % side - width};
    uint32_t voxel = spore_voxel_at(tube, place);
    if (voxel == SPORE_NO_VOXEL) continue;
    SporeVec3 centre = spore_voxel_middle(tube, voxel);
    double distance = spore_vec3_distance(p, centre);
    if (distance < least && spore_passage_open(tube, p, centre)) least = distance, nearest = voxel;
  }
  return nearest;
}

/* Within one voxel, or else two, along each axis. */
static uint32_t nearest_seen(const SporeVoxelTube *tube, SporeVec3 p) {
  uint32_t voxel = seen_from(tube, p, 1);
  return voxel == SPORE_NO_VOXEL ? seen_from(tube, p, 2) : voxel;
}

uint32_t spore_voxel_beside(const SporeVoxelTube *tube, SporeVec3 p) {
  return nearest_seen(tube, move_inside(tube->solid, p, LIFT * tube->edge));
}

uint32_t spore_voxel_under(const SporeVoxelTube *tube, SporeVec3 p, uint32_t triangle, bool *within) {
  SporeVec3 outward = spore_vec3_normalise(spore_triangle_across(&tube->solid->mesh, triangle), spore_vec3(0, 0, 0));
  SporeVec3 from = spore_vec3_add_scaled(p, -LIFT * tube->edge, outward);
  SporeVec3 across = spore_vec3_add_scaled(p, LIFT * tube->edge, outward);
  *within = !tube->of_one_piece && spore_bvh_inside(tube->solid->bvh, across);
  return nearest_seen(tube, from);
}
