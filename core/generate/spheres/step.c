/* One Gauss-Newton step of a ball towards the depth of the samples that the ball owns. */
#include <math.h>

#include "core/generate/spheres/fit.h"

#define LEAST_RADIUS 0.02 /* of the typical radius */
#define LONGEST_STEP 0.3  /* of the typical radius */

/* The weights make a least-squares step follow the nearly linear loss. */
void spore_fit_add_normal(const SporeFit *fit, size_t sample, double *m) {
  const SporeSamples *s = fit->samples;
  size_t ball = fit->field.owner[sample];
  double e = fit->field.best[sample] - s->depth[sample];
  double w = s->weight[sample] / spore_fit_sample_loss(fit, e);
  double u[4] = {s->points.x[sample] - fit->balls.x[ball], s->points.y[sample] - fit->balls.y[ball],
                 s->points.z[sample] - fit->balls.z[ball], 1};
  double length = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]), inverse = length > 1e-300 ? 1 / length : 0;
  for (int k = 0; k < 3; k++) u[k] *= inverse;
  for (int r = 0, at = 0; r < 4; r++) {
    for (int c = 0; c <= r; c++) m[at++] += w * u[r] * u[c];
    m[10 + r] -= w * u[r] * e;
  }
}

/* Solves (A + shift I) x = b by Cholesky; A is the packed lower triangle m[0..9], b is m[10..13]. */
static void solve_damped(const double *m, double shift, double x[4]) {
  double l[10], y[4];
  for (int r = 0, at = 0; r < 4; r++)
    for (int c = 0; c <= r; c++, at++) {
      double sum = m[at] + (r == c ? shift : 0);
      for (int k = 0; k < c; k++) sum -= l[r * (r + 1) / 2 + k] * l[c * (c + 1) / 2 + k];
      l[at] = r == c ? sqrt(fmax(sum, 1e-300)) : sum / l[c * (c + 1) / 2 + c];
    }
  for (int r = 0; r < 4; r++) {
    y[r] = m[10 + r];
    for (int k = 0; k < r; k++) y[r] -= l[r * (r + 1) / 2 + k] * y[k];
    y[r] /= l[r * (r + 1) / 2 + r];
  }
  for (int r = 3; r >= 0; r--) {
    x[r] = y[r];
    for (int k = r + 1; k < 4; k++) x[r] -= l[k * (k + 1) / 2 + r] * x[k];
    x[r] /= l[r * (r + 1) / 2 + r];
  }
}

/* A lower bound of the depth at a ball's new centre if the radius is surely within the bound plus the band, else the
 * depth itself. The bound holds because the depth changes by no more than the centre moves. */
static double depth_for(SporeFit *fit, size_t ball, SporeVec3 centre, double radius) {
  double *known = fit->known + 4 * ball, band = fit->samples->band;
  double least = fmax(known[3] - spore_vec3_distance(centre, spore_vec3_load(known)), 0);
  if (radius <= least + band) return least;
  spore_vec3_store(known, centre);
  return known[3] = fmax(spore_bvh_depth(fit->solid->bvh, centre), 0);
}

void spore_fit_step_ball(SporeFit *fit, size_t ball, const double *normal, double damping, double sphere[4]) {
  double typical = fit->samples->typical, x[4];
  solve_damped(normal, damping * (normal[0] + normal[2] + normal[5] + normal[9]), x);
  double length = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3]);
  double scale = fmin(1, LONGEST_STEP * typical / fmax(length, 1e-300));
  const SporeBalls *b = &fit->balls;
  SporeVec3 c = spore_vec3(b->x[ball] + scale * x[0], b->y[ball] + scale * x[1], b->z[ball] + scale * x[2]);
  double radius = fmax(b->r[ball] + scale * x[3], LEAST_RADIUS * typical);
  c = spore_fit_confine(fit, ball, c);
  spore_vec3_store(sphere, c);
  sphere[3] = fmin(radius, depth_for(fit, ball, c, radius) + fit->samples->band);
}
