/* Reduces a dense curve to a given number of points or to a tolerance. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/centreline/private.h"

/* Cubic through four successive points (Catmull and Rom 1974), between the middle two; straight beyond an end. */
static void between(const SporeCurve *curve, size_t i, double part, double result[4]) {
  const double *b = curve->points + 4 * i, *c = b + 4;
  for (int k = 0; k < 4; k++) {
    double a = i > 0 ? b[k - 4] : 2 * b[k] - c[k], d = i + 2 < curve->count ? c[k + 4] : 2 * c[k] - b[k];
    double first = 0.5 * (c[k] - a), last = 0.5 * (d - b[k]), t = part;
    result[k] =
        b[k] + t * (first + t * (3 * (c[k] - b[k]) - 2 * first - last + t * (2 * (b[k] - c[k]) + first + last)));
  }
  result[3] = fmax(result[3], fmin(b[3], c[3]));
}

static double piece(const SporeCurve *curve, size_t i) {
  return spore_vec3_distance(spore_vec3_load(curve->points + 4 * i), spore_vec3_load(curve->points + 4 * i + 4));
}

static bool even(const SporeCurve *dense, size_t count, SporeCurve *curve, SporeError *error) {
  if (!spore_curve_allocate(curve, count, error)) return false;
  double whole = spore_curve_length(dense), walked = 0, step = piece(dense, 0);
  size_t at = 0;
  for (size_t i = 0; i < count; i++) {
    double wanted = whole * (double)i / (double)(count - 1);
    while (walked + step < wanted && at + 2 < dense->count) {
      walked += step;
      step = piece(dense, ++at);
    }
    between(dense, at, step > 0 ? fmin((wanted - walked) / step, 1) : 0, curve->points + 4 * i);
  }
  return true;
}

/* Distance of point i from the segment between two others, or the error of the interpolated radius, whichever is
 * larger, over the radius of point i. */
static double error_of(const SporeCurve *dense, size_t from, size_t to, size_t i) {
  SporeVec3 a = spore_vec3_load(dense->points + 4 * from), b = spore_vec3_load(dense->points + 4 * to),
            p = spore_vec3_load(dense->points + 4 * i), ab = spore_vec3_sub(b, a);
  double square = spore_vec3_dot(ab, ab);
  double part = square > 0 ? fmin(fmax(spore_vec3_dot(ab, spore_vec3_sub(p, a)) / square, 0), 1) : 0;
  double radius = dense->points[4 * i + 3];
  double straight = dense->points[4 * from + 3] + part * (dense->points[4 * to + 3] - dense->points[4 * from + 3]);
  return fmax(spore_vec3_distance(p, spore_vec3_add_scaled(a, part, ab)), fabs(radius - straight)) / radius;
}

/* Keeps the worst point of a piece while its error is over the tolerance (Douglas and Peucker 1973). stack: 2 count. */
static size_t choose(const SporeCurve *dense, double tolerance, bool *kept, size_t *stack) {
  size_t waiting = 0, count = 2;
  kept[0] = kept[dense->count - 1] = true;
  stack[waiting++] = 0, stack[waiting++] = dense->count - 1;
  while (waiting) {
    size_t to = stack[--waiting], from = stack[--waiting], worst = from;
    double most = tolerance;
    for (size_t i = from + 1; i < to; i++) {
      double error = error_of(dense, from, to, i);
      if (error > most) most = error, worst = i;
    }
    if (worst == from) continue;
    kept[worst] = true;
    count++;
    stack[waiting++] = from, stack[waiting++] = worst;
    stack[waiting++] = worst, stack[waiting++] = to;
  }
  return count;
}

bool spore_centreline_thin(const SporeCurve *dense, const SporeCentrelineOptions *options, SporeCurve *curve,
                           SporeError *error) {
  if (options->points) return even(dense, options->points, curve, error);
  double tolerance = options->tolerance > 0 ? options->tolerance : SPORE_CENTRELINE_TOLERANCE;
  bool *kept = SPORE_NEW_ARRAY(bool, dense->count);
  size_t *stack = SPORE_NEW_ARRAY(size_t, 2 * dense->count + 2), next = 0;
  bool done = (kept && stack) || spore_generate_no_memory(error);
  done = done && spore_curve_allocate(curve, choose(dense, tolerance, kept, stack), error);
  for (size_t i = 0; done && i < dense->count; i++)
    if (kept[i]) memcpy(curve->points + 4 * next++, dense->points + 4 * i, 4 * sizeof *curve->points);
  spore_free(kept);
  spore_free(stack);
  return done;
}
