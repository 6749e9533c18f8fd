/* Depth inside a body that is given by spheres, smooth from sphere to sphere.
 *
 *   g(x) = (sum_i w_i max(0, m + r_i - d_i(x))^4)^(1/4) - m
 *
 * with d_i the distance to centre i and m the mean radius. It is a weighted sum of sphere depths, as in the depth
 * fields of Meseure and Chaillou; the spheres reach m beyond themselves, and the fourth power lets the nearest sphere
 * lead. For a single sphere it is the depth in that sphere. The weights are such that g is 0 where a sphere stands out
 * most among its neighbours; the gaps between spheres are filled to about that height.
 *
 * Spheres that come with weights of their own were fitted for the plain sum of that paper, which counts where it is
 * above a level:
 *
 *   g(x) = sum_i w_i max(0, r_i - d_i(x)) - level */
#ifndef SPORE_COLLIDE_DEPTH_FIELD_H
#define SPORE_COLLIDE_DEPTH_FIELD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/math/vec3.h"

typedef struct SporeDepthField {
  size_t count;
  bool plain;          /* weights came with the spheres */
  double level;        /* m; of a plain sum */
  double margin;       /* m; of a plain sum it only widens the neighbourhood */
  double mean_radius;  /* m */
  double half_width;   /* m: of the widest side of the box that the spheres fill */
  double *ball;        /* count x 4: x y z radius, in the body's frame, m */
  double *weight;      /* count */
  uint32_t *start;     /* count + 1 */
  uint32_t *neighbour; /* of sphere i: those that count anywhere on its surface, itself among them */
} SporeDepthField;

/* centre (3 a sphere), radius and weight (NULL: found here, and there is no level) are copied. False: no memory, *field
 * cleared. */
bool spore_depth_field_create(SporeDepthField *field, const double *centre, const double *radius, const double *weight,
                              double level, size_t count);
void spore_depth_field_clear(SporeDepthField *field);

/* g at a point near sphere `nearest`, and its gradient; where no sphere reaches, 0 or -level, and 0. */
double spore_depth_field_at(const SporeDepthField *field, uint32_t nearest, SporeVec3 point, SporeVec3 *gradient);
/* Depth of a ball in the body, m, and the normal out of the body at its deepest point. */
double spore_depth_field_ball(const SporeDepthField *field, uint32_t nearest, SporeVec3 centre, double radius,
                              SporeVec3 *normal);
/* How far out a sphere of a plain sum is felt, at most, where it stands out: its radius as a ball of its own, m. */
double spore_depth_field_felt_radius(const SporeDepthField *field, uint32_t sphere);

#endif
