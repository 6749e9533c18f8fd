/* Balls with their images in a solid's mirror planes. */
#include "core/base/memory.h"
#include "core/generate/spheres_parts.h"

size_t spore_balls_images(const SporeSymmetry *symmetry, const SporeBalls *balls, const uint8_t *bound,
                          double *spheres) {
  size_t count = 0;
  for (size_t i = 0; i < balls->count; i++)
    for (unsigned planes = 0; planes < 1u << symmetry->count; planes++) {
      if (bound && planes & bound[i]) continue;
      double *sphere = spheres ? spheres + 4 * count : NULL;
      count++;
      if (!sphere) continue;
      spore_vec3_store(sphere, spore_symmetry_mirror(symmetry, planes, spore_balls_centre(balls, i)));
      sphere[3] = balls->r[i];
    }
  return count;
}

void spore_progress_show_images(const SporeProgressPart *part, const SporeSymmetry *symmetry, const SporeBalls *balls,
                                const uint8_t *bound) {
  if (!part->whole || !part->whole->show) return;
  size_t count = spore_balls_images(symmetry, balls, bound, NULL);
  double *spheres = SPORE_NEW_ARRAY(double, 4 * count);
  if (!spheres) return; /* a look that is missed */
  spore_balls_images(symmetry, balls, bound, spheres);
  part->whole->show(part->whole->data, spheres, count);
  spore_free(spheres);
}
