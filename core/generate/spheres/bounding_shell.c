/* The volume that a ball adds to the union of the others, measured along rays from its centre. Where all of the solid
 * must be covered, sets differ only in this volume. Rays detect thin caps that sample points would miss. */
#include <math.h>

#include "core/base/memory.h"
#include "core/generate/spheres/bounding_search.h"
#include "core/generate/spheres/kernels.h"

#define GOLDEN_ANGLE 2.399963229728653 /* rad: rays on a Fibonacci spiral */

bool spore_bounding_shell_create(SporeBoundingShell *shell) {
  float *memory = SPORE_NEW_ARRAY(float, 5 * SPORE_BOUNDING_RAYS);
  *shell = (SporeBoundingShell){memory, memory + SPORE_BOUNDING_RAYS, memory + 2 * SPORE_BOUNDING_RAYS,
                                memory + 3 * SPORE_BOUNDING_RAYS, memory + 4 * SPORE_BOUNDING_RAYS};
  if (!memory) *shell = (SporeBoundingShell){0};
  return memory;
}

void spore_bounding_shell_clear(SporeBoundingShell *shell) {
  spore_free(shell->x);
  *shell = (SporeBoundingShell){0};
}

void spore_bounding_shell_turn(SporeBoundingShell *shell, SporeRandom *random) {
  SporeVec3 a = spore_random_direction(random), b = spore_random_direction(random);
  b = spore_vec3_normalise(spore_vec3_cross(a, b), spore_vec3(1, 0, 0));
  SporeVec3 c = spore_vec3_cross(a, b);
  for (int i = 0; i < SPORE_BOUNDING_RAYS; i++) {
    double z = 1 - (2 * i + 1.0) / SPORE_BOUNDING_RAYS, ring = sqrt(1 - z * z), turn = i * GOLDEN_ANGLE;
    SporeVec3 u =
        spore_vec3_add_scaled(spore_vec3_add_scaled(spore_vec3_scale(z, a), ring * cos(turn), b), ring * sin(turn), c);
    shell->x[i] = (float)u.x, shell->y[i] = (float)u.y, shell->z[i] = (float)u.z;
  }
}

/* Ends the rays at the mirror planes, in radii: beyond a plane are the images. */
static void end_at_planes(SporeBoundingShell *shell, const SporeSymmetry *symmetry, SporeVec3 middle, double radius) {
  for (int i = 0; i < SPORE_BOUNDING_RAYS; i++) shell->to[i] = HUGE_VALF;
  for (unsigned k = 0; k < symmetry->count; k++) {
    SporeVec3 n = symmetry->normal[k];
    float height = (float)(fmax(spore_vec3_dot(spore_vec3_sub(middle, symmetry->point), n), 0) / radius);
    for (int i = 0; i < SPORE_BOUNDING_RAYS; i++) {
      float down = -(shell->x[i] * (float)n.x + shell->y[i] * (float)n.y + shell->z[i] * (float)n.z);
      if (down > 0) shell->to[i] = fminf(shell->to[i], height / down);
    }
  }
}

void spore_bounding_shell_look(SporeBoundingShell *shell, const SporeSymmetry *symmetry, const SporeBalls *balls,
                               size_t i, double reach) {
  SporeVec3 middle = spore_balls_centre(balls, i);
  double radius = balls->r[i];
  shell->middle = middle, shell->radius = radius;
  end_at_planes(shell, symmetry, middle, radius);
  for (int k = 0; k < SPORE_BOUNDING_RAYS; k++) shell->from[k] = 0;
  for (size_t j = 0; j < balls->count; j++) {
    SporeVec3 away = spore_vec3_sub(spore_balls_centre(balls, j), middle);
    if (j == i || spore_vec3_length(away) >= radius + reach + balls->r[j]) continue;
    const float ball[4] = {(float)(away.x / radius), (float)(away.y / radius), (float)(away.z / radius),
                           (float)(balls->r[j] / radius)};
    SPORE_KERNEL(spore_rays_leave)(shell->x, shell->y, shell->z, SPORE_BOUNDING_RAYS, ball, shell->from);
  }
}

double spore_bounding_shell_volume(const SporeBoundingShell *shell, SporeVec3 centre, double radius) {
  SporeVec3 away = spore_vec3_sub(centre, shell->middle);
  double r = shell->radius;
  const float ball[4] = {(float)(away.x / r), (float)(away.y / r), (float)(away.z / r), (float)(radius / r)};
  float sum;
  SPORE_KERNEL(spore_rays_volume)
  (shell->x, shell->y, shell->z, shell->from, shell->to, SPORE_BOUNDING_RAYS, ball, &sum);
  return (double)sum * r * r * r * (4 * M_PI / 3 / SPORE_BOUNDING_RAYS);
}
