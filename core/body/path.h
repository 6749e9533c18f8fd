/* A path that something slides along: a smooth line (a cubic B-spline with clamped knots) led by points that may
 * move: points 0 .. span_count + 2. */
#ifndef SPORE_CONSTRAINT_PATH_H
#define SPORE_CONSTRAINT_PATH_H

#include "core/math/spline.h"
#include "core/math/vec3.h"

#define SPORE_PATH_WIDTH 4   /* points that lead it in one place */
#define SPORE_PATH_REACH 2.0 /* of the parameter, of what is followed along it */

/* A place on it: where, by which points (first .. first + 3, with their weights). */
typedef struct SporePathPlace {
  double parameter;
  size_t first;
  double weight[SPORE_PATH_WIDTH], slope_weight[SPORE_PATH_WIDTH];
  SporeVec3 position, slope, bend; /* m; derived by the parameter, once and twice */
} SporePathPlace;

/* -1 at its start, 1 at its end, 0 between. */
static inline double spore_path_end(SporeSplineKnots knots, double parameter) {
  return parameter <= 0 ? -1 : parameter >= spore_spline_end(knots) ? 1 : 0;
}
/* points: (knots.span_count + 3) x 3, m. A parameter beyond an end is that end. */
SporePathPlace spore_path_at(SporeSplineKnots knots, const double *points, double parameter);
/* The place nearest to p among those near `start`: SPORE_PATH_REACH at most to either side, downhill all the way.
 * Newton's method to rounding, so that it is a smooth function of points and p. */
SporePathPlace spore_path_follow(SporeSplineKnots knots, const double *points, double start, SporeVec3 p);
/* Where the search for the nearest of all begins. samples: count x 3, m. */
size_t spore_path_sample_count(SporeSplineKnots knots);
void spore_path_sample(SporeSplineKnots knots, const double *points, double *samples);
/* The nearest of all. samples: of spore_path_sample, for who asks for many p; NULL: made on the way. */
SporePathPlace spore_path_seek(SporeSplineKnots knots, const double *points, const double *samples, SporeVec3 p);
/* Length from one parameter to another, m; negative where it goes back. By Gauss' rule of three points a span or part
 * of one: to rounding's neighbourhood over a fraction of a span, to 1e-4 of the length over bent ones. */
double spore_path_length(SporeSplineKnots knots, const double *points, double from, double to);

#endif
