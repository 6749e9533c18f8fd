/* Cubic B-splines with clamped knots: the line that a thread or a tube follows. */
#ifndef SPORE_MODELS_SPLINE_SPLINE_H
#define SPORE_MODELS_SPLINE_SPLINE_H

#include "core/linalg/block_matrix.h"
#include "core/math/simd.h"
#include "core/math/spline.h"
#include "core/mesh/mesh.h"
#include "core/body/mapping.h"
#include "core/body/model.h"

#define SPORE_SPLINE_POINTS 2  /* Gauss points a span */
#define SPORE_SPLINE_SAMPLES 8 /* a span, of what a spline is fitted to */

/* The curve that a spline follows, with the length up to each of its points: a place is found by bisection. */
typedef struct SporeSplineCourse {
  SporeCurve curve; /* a copy */
  double *length;   /* up to each point, along the straight pieces, m */
} SporeSplineCourse;
/* False: no memory; clear it in either case. */
bool spore_spline_course_init(SporeSplineCourse *course, const SporeCurve *curve);
void spore_spline_course_clear(SporeSplineCourse *course);
/* Length of the whole curve, m. */
static inline double spore_spline_course_length(const SporeSplineCourse *course) {
  return course->length[course->curve.count - 1];
}
/* Control points (knots.span_count + 3, three entries each) of the spline nearest to the curve in the mean square:
 * through its ends, and along a smooth line through its points. False: no memory. */
bool spore_spline_fit(const SporeSplineCourse *course, SporeSplineKnots knots, double *control);
/* Radius of the curve where the spline has this parameter. */
double spore_spline_radius(const SporeSplineCourse *course, SporeSplineKnots knots, double parameter);

/* One Gauss point of each of SPORE_LANES spans; behind the last span all is 0. With a = dr/dS and b = d2r/dS2 by the
 * length S at rest, where |a| = 1:
 *   U = sum young (area / 2 (|a| - 1)^2 + bending inertia / 2 c(|b|^2)),  c(s) = (s - s0)^2 / (s + 3 s0)
 * s0 is the square of the curvature at rest, and c = s where that is 0: near rest c is (|b| - |b0|)^2, and it is smooth
 * where a line is straight. Where the line keeps its length, |b| is its curvature. */
typedef struct SporeSplineGauss {
  double first[4][SPORE_LANES], second[4][SPORE_LANES]; /* a and b by the span's control points */
  double area[SPORE_LANES], inertia[SPORE_LANES];       /* times the length for which the point stands: m^3, m^5 */
  double rest[SPORE_LANES];                             /* s0, 1/m^2 */
} SporeSplineGauss;

typedef struct SporeSpline {
  size_t span_count, group_count; /* groups of SPORE_LANES spans */
  SporeSplineGauss *gauss;        /* group x SPORE_SPLINE_POINTS */
  uint32_t *upper, *lower;        /* control point i x 4: where blocks (i, i + k) and (i + k, i) lie */
  double young, bending, viscous; /* Pa; factor on the stiffness against bending; s */
  double straight;                /* 1/m^2: |b|^2 below which a line hardly drags as it bends */
} SporeSpline;

bool spore_spline_allocate(SporeSpline *spline, size_t span_count);
void spore_spline_clear(SporeSpline *spline);
bool spore_spline_pattern(const SporeSpline *spline, SporeBlockPattern *pattern);
/* In a matrix of the model's whole pattern; the control points are its first blocks. */
void spore_spline_find_blocks(SporeSpline *spline, const SporeBlockMatrix *matrix);

/* Rows that give points by control points (in the body's frame). A point on the line follows the four control points of
 * its span. A point off the line follows the arms of the twist too (their ends at each knot, which are the nodes behind
 * the control points; NULL: the line has none), or as few more control points around it as span its offset. Where the
 * line is too straight for that, a point no further off than slack (m) is put onto the line, and any other point is
 * refused. follows: the rows may be made anew for other knots. */
bool spore_spline_map(SporeSplineKnots knots, const double *control, const double *arms, const double *points,
                      size_t count, const SporeCancel *cancel, double slack, bool follows, SporeMapping *mapping,
                      SporeError *error);
/* Makes them, for the same line and arms by other knots. Allocates nothing. */
void spore_spline_map_follow(SporeSplineKnots knots, const double *control, const double *arms, SporeMapping *mapping);
/* SPORE_SPLINE_SAMPLES points of the line a span, and its end; 3 each; room for `more` behind them, which are not
 * counted. NULL: no memory. */
double *spore_spline_sample(SporeSplineKnots knots, const double *control, size_t more, size_t *count);

/* The largest |a| - 1 of all Gauss points. */
double spore_spline_strain(const SporeSpline *spline, const double *q);

/* Forces, energy and stiffness as SporeModelType says. Viscous: the speed of |a| and that of |b| across the line, each
 * times viscous and its stiffness; the second fades out where the line is straight, and has no direction to bend in. */
SPORE_DECLARE_KERNEL(void, spore_spline_force, const SporeSpline *spline, const double *q, const double *shape,
                     const double *v, double *f);
SPORE_DECLARE_KERNEL(double, spore_spline_potential, const SporeSpline *spline, const double *q);
SPORE_DECLARE_KERNEL(void, spore_spline_jacobian, const SporeSpline *spline, const SporeTangent *at,
                     SporeBlockMatrix *matrix);

#endif
