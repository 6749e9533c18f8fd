/* Cubic B-splines with clamped, uniform knots: the functions that weigh control points along a line. */
#ifndef SPORE_MATH_SPLINE_H
#define SPORE_MATH_SPLINE_H

#include <stddef.h>

/* The four functions of a span, and what they become by derivation. */
typedef struct SporeSplineBasis {
  double value[4], first[4], second[4];
} SporeSplineBasis;

/* At `parameter` from 0 to span_count; *span: control points span .. span + 3 have the weights. */
SporeSplineBasis spore_spline_basis(size_t span_count, double parameter, size_t *span);

#endif
