/* A sheet that cubic B-splines make both ways: its points, derivatives, and the place on it that is nearest to a point.
 */
#ifndef SPORE_MATH_SPLINE_SHEET_H
#define SPORE_MATH_SPLINE_SHEET_H

#include "core/math/spline.h"
#include "core/math/vec3.h"

/* Uniform, clamped knots; u runs first. */
typedef struct SporeSplineSheet {
  size_t span[2];        /* along u and v */
  const double *control; /* (span[0] + 3) (span[1] + 3) x 3, borrowed */
} SporeSplineSheet;

/* The sixteen weights of a point, and those of its derivatives by u, v, uu, vv, uv. */
typedef struct SporeSheetPlace {
  size_t first[2]; /* of its control points, along u and v: four each way */
  double weight[6][16];
} SporeSheetPlace;

/* at: u and v, from 0 to the number of spans. */
SporeSheetPlace spore_spline_sheet_place(const SporeSplineSheet *sheet, const double at[2]);
/* The point (derivative 0), m, or its derivative by u (1), v (2), uu, vv, uv. */
SporeVec3 spore_spline_sheet_point(const SporeSplineSheet *sheet, const SporeSheetPlace *place, int derivative);
/* Moves `at` nearer to where the sheet is nearest to p: one step of Newton's method; where the square of the distance
 * is not convex, of Gauss's. Returns how far it moved, in spans. */
double spore_spline_sheet_approach(const SporeSplineSheet *sheet, SporeVec3 p, double at[2]);

#endif
