/* Finds balls of a fit that are worth little and places where depth is missing, and moves balls there. */
#include <math.h>
#include <string.h>

#include "core/generate/spheres/fit.h"
#include "core/generate/spheres/kernels.h"
#include "core/math/mat3.h"

#define MOST_FILLED 256
#define CROWDED 0.7       /* of the larger radius */
#define SPLIT_SPACING 0.8 /* standard deviations of the owned samples, each way */

void spore_fit_weigh(SporeFit *fit) {
  const SporeSamples *s = fit->samples;
  size_t n = fit->balls.count;
  memset(fit->worth, 0, n * sizeof *fit->worth);
  memset(fit->burden, 0, n * sizeof *fit->burden);
  memset(fit->spread, 0, 10 * n * sizeof *fit->spread);
  for (size_t i = 0; i < s->points.count; i++) {
    uint32_t ball = fit->field.owner[i];
    double now = spore_fit_sample_loss(fit, fit->field.best[i] - s->depth[i]);
    double then = spore_fit_sample_loss(fit, fmax(fit->field.second[i], -1e30) - s->depth[i]);
    fit->worth[ball] += s->weight[i] * (then - now);
    fit->burden[ball] += s->weight[i] * (now - fit->smoothing);
    if (s->depth[i] < 0) continue;
    double w = s->weight[i], *m = fit->spread + 10 * (size_t)ball;
    double x = s->points.x[i] - fit->balls.x[ball], y = s->points.y[i] - fit->balls.y[ball],
           z = s->points.z[i] - fit->balls.z[ball];
    const double terms[10] = {w, w * x, w * y, w * z, w * x * x, w * y * y, w * z * z, w * x * y, w * x * z, w * y * z};
    for (int k = 0; k < 10; k++) m[k] += terms[k];
  }
}

/* Numbers 0 .. count - 1 by ascending sign x value, equal ones in order (shell sort: counts are small). */
static void order_by(const double *value, double sign, uint32_t *order, size_t count) {
  size_t gap = 1;
  for (size_t i = 0; i < count; i++) order[i] = (uint32_t)i;
  while (gap < count / 3) gap = 3 * gap + 1;
  for (; gap; gap /= 3)
    for (size_t i = gap; i < count; i++) {
      uint32_t item = order[i];
      size_t j = i;
      for (; j >= gap; j -= gap) {
        double difference = sign * (value[item] - value[order[j - gap]]);
        if (difference > 0 || (difference == 0 && item > order[j - gap])) break;
        order[j] = order[j - gap];
      }
      order[j] = item;
    }
}

/* Sum of weight x (value of the candidate - the field) over the samples in it where that is positive. */
static double missing_depth(const SporeFit *fit, size_t candidate) {
  const SporePoints *points = &fit->samples->points;
  double x = fit->candidates->x[candidate], y = fit->candidates->y[candidate], z = fit->candidates->z[candidate];
  double r = fit->candidates->r[candidate], sum = 0, value[SPORE_BLOCK];
  for (size_t b = 0; b < points->block_count; b++) {
    const double *block = points->block + 4 * b;
    double dx = block[0] - x, dy = block[1] - y, dz = block[2] - z, reach = r + block[3];
    if (dx * dx + dy * dy + dz * dz > reach * reach) continue;
    size_t first = b * SPORE_BLOCK;
    SPORE_KERNEL(spore_block_depths)
    (points->x + first, points->y + first, points->z + first, (const double[3]){x, y, z}, r, value);
    for (size_t k = 0; k < SPORE_BLOCK; k++) {
      double more = value[k] - fit->field.best[first + k];
      more = value[k] > 0 && more > 0 ? more : 0;
      sum += fit->samples->weight[first + k] * more;
    }
  }
  return sum;
}

/* Whether the candidate is close to one that is already used. */
static bool crowded(const SporeFit *fit, const size_t *used, size_t count, size_t c) {
  const SporeBalls *k = fit->candidates;
  for (size_t i = 0; i < count; i++) {
    size_t u = used[i];
    double dx = k->x[c] - k->x[u], dy = k->y[c] - k->y[u], dz = k->z[c] - k->z[u], r = CROWDED * fmax(k->r[c], k->r[u]);
    if (dx * dx + dy * dy + dz * dz <= r * r) return true;
  }
  return false;
}

static void score_candidates(SporeFit *fit, size_t turn) {
  size_t total = fit->candidates->count;
  for (size_t i = 0; i < fit->scored_count; i++) {
    fit->scored[i] = (uint32_t)((i * total / fit->scored_count + turn * 7919) % total);
    fit->missing[i] = missing_depth(fit, fit->scored[i]);
  }
  order_by(fit->missing, -1, fit->by_missing, fit->scored_count);
}

size_t spore_fit_fill(SporeFit *fit, size_t turn) {
  size_t used[MOST_FILLED], filled = 0, wanted = fit->balls.count / 25 + 1;
  if (wanted > MOST_FILLED) wanted = MOST_FILLED;
  spore_fit_weigh(fit);
  order_by(fit->worth, 1, fit->order, fit->balls.count);
  score_candidates(fit, turn);
  for (size_t i = 0; i < fit->scored_count && filled < wanted && filled < fit->balls.count; i++) {
    uint32_t at = fit->by_missing[i], ball = fit->order[filled];
    size_t c = fit->scored[at];
    if (crowded(fit, used, filled, c)) continue;
    if (fit->worth[ball] >= fit->missing[at]) break;
    SporeVec3 centre = spore_fit_confine(fit, ball, spore_balls_centre(fit->candidates, c));
    spore_balls_set(&fit->balls, ball, centre, fit->candidates->r[c]);
    used[filled++] = c;
  }
  return filled;
}

static void place(SporeFit *fit, size_t ball, SporeVec3 centre, double radius) {
  centre = spore_fit_confine(fit, ball, centre);
  double most = fmax(spore_bvh_depth(fit->solid->bvh, centre), 0) + fit->samples->band;
  spore_balls_set(&fit->balls, ball, centre, fmin(radius, most));
}

/* Along the axis of largest variance of the samples. */
void spore_fit_split(SporeFit *fit, size_t target, size_t spare) {
  const double *m = fit->spread + 10 * target;
  double w = fmax(m[0], 1e-300), x = m[1] / w, y = m[2] / w, z = m[3] / w, values[3];
  double xy = m[7] / w - x * y, xz = m[8] / w - x * z, yz = m[9] / w - y * z;
  SporeMat3 covariance = {{m[4] / w - x * x, xy, xz, xy, m[5] / w - y * y, yz, xz, yz, m[6] / w - z * z}}, axes;
  spore_mat3_eigen_symmetric(covariance, values, &axes);
  SporeVec3 offset = spore_vec3_scale(SPLIT_SPACING * sqrt(fmax(values[2], 0)), spore_mat3_column(axes, 2));
  SporeVec3 centre = spore_vec3(fit->balls.x[target], fit->balls.y[target], fit->balls.z[target]);
  centre = spore_vec3_add_scaled(centre, 0.5, spore_vec3(x, y, z));
  double radius = fit->balls.r[target];
  place(fit, spare, spore_vec3_add(centre, offset), radius);
  place(fit, target, spore_vec3_sub(centre, offset), radius);
}

void spore_fit_rank(SporeFit *fit, double shake) {
  size_t n = fit->balls.count;
  for (size_t i = 0; i < n; i++) {
    fit->worth[i] *= 1 + shake * (2 * spore_random_unit(&fit->random) - 1);
    fit->burden[i] *= 1 + shake * (2 * spore_random_unit(&fit->random) - 1);
  }
  order_by(fit->worth, 1, fit->order, n);
  order_by(fit->burden, -1, fit->heaviest, n);
}
