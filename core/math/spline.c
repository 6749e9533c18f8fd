#include "core/math/spline.h"

#include <math.h>

static double knot(size_t span_count, size_t i) { return i < 3 ? 0 : fmin((double)(i - 3), (double)span_count); }

/* From the functions of one degree less (or their derivatives) to those of `degree` that are not 0 in the span. */
static void derive(size_t span_count, size_t span, size_t degree, const double *lower, double *upper) {
  for (size_t j = 0; j <= degree; j++) {
    size_t i = span + 3 - degree + j;
    double before = knot(span_count, i + degree) - knot(span_count, i);
    double behind = knot(span_count, i + degree + 1) - knot(span_count, i + 1);
    upper[j] = (double)degree * ((j > 0 ? lower[j - 1] / before : 0) - (j < degree ? lower[j] / behind : 0));
  }
}

static void raise(size_t span_count, size_t span, double u, size_t degree, const double *lower, double *upper) {
  for (size_t j = 0; j <= degree; j++) {
    size_t i = span + 3 - degree + j;
    double from = knot(span_count, i), to = knot(span_count, i + degree + 1);
    upper[j] = 0;
    if (j > 0) upper[j] += (u - from) / (knot(span_count, i + degree) - from) * lower[j - 1];
    if (j < degree) upper[j] += (to - u) / (to - knot(span_count, i + 1)) * lower[j];
  }
}

/* Cox and de Boor's recursion. */
SporeSplineBasis spore_spline_basis(size_t span_count, double parameter, size_t *span) {
  double u = fmin(fmax(parameter, 0), (double)span_count), constant = 1, linear[2], slope[3], quadratic[3];
  SporeSplineBasis basis;
  *span = (size_t)fmin(floor(u), (double)span_count - 1);
  raise(span_count, *span, u, 1, &constant, linear);
  raise(span_count, *span, u, 2, linear, quadratic);
  raise(span_count, *span, u, 3, quadratic, basis.value);
  derive(span_count, *span, 3, quadratic, basis.first);
  derive(span_count, *span, 2, linear, slope);
  derive(span_count, *span, 3, slope, basis.second);
  return basis;
}
