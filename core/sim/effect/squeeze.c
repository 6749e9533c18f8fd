/* Tissue that is drawn squeezed. */
#include "core/sim/world_private.h"

#define FAR 2.5 /* of the height: beyond, nothing is squeezed */

/* 1 at 0, 0 at 1 and beyond, smooth. */
static double fall(double x) {
  x = fmin(fmax(x, 0), 1);
  return 1 - x * x * (3 - 2 * x);
}

/* The factor across grows with the distance from the middle no faster than the distance does, so that no two points
 * change places. */
static void squeeze_point(const SporeSqueeze *squeeze, double *point) {
  SporeVec3 at = spore_pose_apply_inverse(squeeze->frame, spore_vec3_load(point));
  double margin = squeeze->height, across = fabs(at.z);
  double share = fall(fmax(-at.x, at.x - squeeze->length) / margin) * fall((fabs(at.y) - squeeze->width) / margin) *
                 fall((across - margin) / ((FAR - 1) * margin));
  if (!(share > 0)) return;
  at.z *= 1 - (1 - squeeze->ratio) * share;
  spore_vec3_store(point, spore_pose_apply(squeeze->frame, at));
}

void spore_squeeze_points(const SporeSqueeze *squeezes, size_t count, uint32_t body, double *points,
                          size_t point_count) {
  for (size_t i = 0; i < count; i++) {
    const SporeSqueeze *squeeze = &squeezes[i];
    if (squeeze->body != body || !(squeeze->height > 0)) continue;
    for (size_t k = 0; k < point_count; k++) squeeze_point(squeeze, points + 3 * k);
  }
}
