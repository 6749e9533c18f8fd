/* Cubic B-splines with clamped knots: the functions that weigh control points along a line. */
#ifndef SPORE_MATH_SPLINE_H
#define SPORE_MATH_SPLINE_H

#include <assert.h>
#include <math.h>
#include <stddef.h>

/* The four functions of a span, and what they become by derivation. */
typedef struct SporeSplineBasis {
  double value[4], first[4], second[4];
} SporeSplineBasis;

/* Where the spans of a spline meet: span i lies between breaks[i] and breaks[i + 1] of its parameter, which begins with
 * 0. NULL: at whole numbers. */
typedef struct SporeSplineKnots {
  size_t span_count;
  const double *breaks; /* span_count + 1, borrowed */
} SporeSplineKnots;

/* Spans of length 1. */
static inline SporeSplineKnots spore_spline_uniform(size_t span_count) { return (SporeSplineKnots){span_count, NULL}; }
/* Parameter at which span i begins; of i = span_count, where the line ends. */
static inline double spore_spline_break(SporeSplineKnots knots, size_t i) {
  assert(i <= knots.span_count);
  return knots.breaks ? knots.breaks[i] : (double)i;
}
/* Parameter at which the line ends. */
static inline double spore_spline_end(SporeSplineKnots knots) { return spore_spline_break(knots, knots.span_count); }
/* Length of a span in the parameter. */
static inline double spore_spline_width(SporeSplineKnots knots, size_t span) {
  return spore_spline_break(knots, span + 1) - spore_spline_break(knots, span);
}
/* Parameter of Gauss' points of a span, 0 and 1. */
static inline double spore_spline_gauss_parameter(SporeSplineKnots knots, size_t span, int point) {
  assert(point == 0 || point == 1);
  double half = 0.5 * spore_spline_width(knots, span);
  return spore_spline_break(knots, span) + half + (point ? half : -half) / sqrt(3);
}
/* Parameter of number `i` of so many places a span, evenly: 0 .. parts span_count. */
static inline double spore_spline_part(SporeSplineKnots knots, size_t parts, size_t i) {
  assert(parts > 0 && i <= parts * knots.span_count);
  size_t span = i < parts * knots.span_count ? i / parts : knots.span_count - 1;
  return spore_spline_break(knots, span) + (double)(i - parts * span) / (double)parts * spore_spline_width(knots, span);
}
/* The last span that begins at `parameter` or before. */
size_t spore_spline_span(SporeSplineKnots knots, double parameter);

/* At `parameter` from 0 to the end; *span: control points span .. span + 3 have the weights. */
SporeSplineBasis spore_spline_basis(SporeSplineKnots knots, double parameter, size_t *span);

/* The same line with one knot more, inside a span (W. Boehm, "Inserting new knots into B-spline curves", 1980): its
 * control points are those of before, but for number span + 1 + i, i = 0 .. 2, which is ratio[i] of the one that had
 * that number and the rest of the one before; those behind have moved on by one. */
void spore_spline_insert(SporeSplineKnots knots, size_t span, double parameter, double ratio[3]);

/* Solves B x = x in place by Cholesky's L L^T within the band: B is symmetric positive definite of half-width 3, its
 * entry (i, i + k) in band[4 i + k], which is overwritten; x: count x 3. */
void spore_spline_solve_band(size_t count, double *band, double *x);

#endif
