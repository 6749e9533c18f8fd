/* Points of a path, the nearest of them, and lengths along it. */
#include "core/body/path.h"

#include <assert.h>
#include <math.h>

#define SAMPLES 8      /* a span, of the search for the nearest of all */
#define ROUNDS 20      /* of Newton's method */
#define ROUNDING 1e-14 /* of the parameter */

static SporeVec3 combine(const double *points, size_t first, const double weight[SPORE_PATH_WIDTH]) {
  SporeVec3 sum = {0, 0, 0};
  for (size_t k = 0; k < SPORE_PATH_WIDTH; k++)
    sum = spore_vec3_add_scaled(sum, weight[k], spore_vec3_load(points + 3 * (first + k)));
  return sum;
}

SporePathPlace spore_path_at(SporeSplineKnots knots, const double *points, double parameter) {
  assert(knots.span_count > 0 && points);
  SporePathPlace place = {.parameter = fmin(fmax(parameter, 0), spore_spline_end(knots))};
  SporeSplineBasis basis = spore_spline_basis(knots, place.parameter, &place.first);
  for (size_t k = 0; k < SPORE_PATH_WIDTH; k++) {
    place.weight[k] = basis.value[k];
    place.slope_weight[k] = basis.first[k];
  }
  place.position = combine(points, place.first, basis.value);
  place.slope = combine(points, place.first, basis.first);
  place.bend = combine(points, place.first, basis.second);
  return place;
}

/* Newton's step toward where p is square to the path. */
static double newton_step(SporeSplineKnots knots, const double *points, double parameter, SporeVec3 p) {
  size_t first;
  SporeSplineBasis basis = spore_spline_basis(knots, parameter, &first);
  SporeVec3 off = spore_vec3_sub(combine(points, first, basis.value), p), slope = combine(points, first, basis.first);
  double square = spore_vec3_dot(slope, slope), bend = spore_vec3_dot(off, combine(points, first, basis.second));
  double change = -spore_vec3_dot(off, slope) / fmax(square + bend, 0.5 * square);
  double most = 0.5 * spore_spline_width(knots, first);
  return isfinite(change) ? fmin(fmax(change, -most), most) : 0;
}

SporePathPlace spore_path_follow(SporeSplineKnots knots, const double *points, double start, SporeVec3 p) {
  assert(isfinite(start));
  double low = fmax(start - SPORE_PATH_REACH, 0), high = fmin(start + SPORE_PATH_REACH, spore_spline_end(knots)),
         parameter = start;
  for (int round = 0; round < ROUNDS; round++) {
    double next = fmin(fmax(parameter + newton_step(knots, points, parameter, p), low), high);
    double change = fabs(next - parameter);
    parameter = next;
    if (change <= ROUNDING * (1 + parameter)) break;
  }
  return spore_path_at(knots, points, parameter);
}

static double sample_parameter(SporeSplineKnots knots, size_t i) {
  return fmin(fmax(spore_spline_part(knots, SAMPLES, i), 0), spore_spline_end(knots));
}

size_t spore_path_sample_count(SporeSplineKnots knots) { return SAMPLES * knots.span_count + 1; }

void spore_path_sample(SporeSplineKnots knots, const double *points, double *samples) {
  size_t count = spore_path_sample_count(knots);
  for (size_t i = 0; i < count; i++)
    spore_vec3_store(samples + 3 * i, spore_path_at(knots, points, sample_parameter(knots, i)).position);
}

SporePathPlace spore_path_seek(SporeSplineKnots knots, const double *points, const double *samples, SporeVec3 p) {
  assert(knots.span_count > 0);
  size_t best = 0, count = spore_path_sample_count(knots);
  double least = HUGE_VAL;
  for (size_t i = 0; i < count; i++) {
    SporeVec3 sample =
        samples ? spore_vec3_load(samples + 3 * i) : spore_path_at(knots, points, sample_parameter(knots, i)).position;
    double distance = spore_vec3_distance(p, sample);
    if (distance < least) least = distance, best = i;
  }
  return spore_path_follow(knots, points, sample_parameter(knots, best), p);
}

/* Within one span. */
static double part_length(SporeSplineKnots knots, const double *points, double from, double to) {
  assert(from < to);
  static const double weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  double sum = 0;
  for (int g = 0; g < 3; g++) {
    double at = 0.5 + 0.5 * sqrt(0.6) * (g - 1);
    sum += weight[g] * spore_vec3_length(spore_path_at(knots, points, from + at * (to - from)).slope);
  }
  return (to - from) * sum;
}

double spore_path_length(SporeSplineKnots knots, const double *points, double from, double to) {
  if (from > to) return -spore_path_length(knots, points, to, from);
  double sum = 0;
  while (from < to) {
    double next = fmin(spore_spline_break(knots, spore_spline_span(knots, from) + 1), to);
    sum += part_length(knots, points, from, next);
    from = next;
  }
  return sum;
}
