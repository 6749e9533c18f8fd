/* Basis functions of cubic B-splines, the insertion of a knot, and the solver of what is fitted by them. */
#include "core/math/spline.h"

#include <assert.h>
#include <math.h>

#include "core/math/vec3.h"

static double knot(SporeSplineKnots knots, size_t i) {
  return i < 3 ? 0 : spore_spline_break(knots, i - 3 < knots.span_count ? i - 3 : knots.span_count);
}

size_t spore_spline_span(SporeSplineKnots knots, double parameter) {
  assert(knots.span_count > 0);
  if (!knots.breaks) return (size_t)fmin(floor(parameter), (double)knots.span_count - 1);
  size_t low = 0, high = knots.span_count;
  while (high - low > 1) {
    size_t middle = (low + high) / 2;
    if (knots.breaks[middle] <= parameter) low = middle;
    else high = middle;
  }
  return low;
}

/* From the functions of one degree less (or their derivatives) to those of `degree` that are not 0 in the span. */
static void derive(SporeSplineKnots knots, size_t span, size_t degree, const double *lower, double *upper) {
  assert(degree >= 1 && degree <= 3);
  for (size_t j = 0; j <= degree; j++) {
    size_t i = span + 3 - degree + j;
    double before = knot(knots, i + degree) - knot(knots, i);
    double behind = knot(knots, i + degree + 1) - knot(knots, i + 1);
    upper[j] = (double)degree * ((j > 0 ? lower[j - 1] / before : 0) - (j < degree ? lower[j] / behind : 0));
  }
}

static void raise(SporeSplineKnots knots, size_t span, double u, size_t degree, const double *lower, double *upper) {
  for (size_t j = 0; j <= degree; j++) {
    size_t i = span + 3 - degree + j;
    double from = knot(knots, i), to = knot(knots, i + degree + 1);
    upper[j] = 0;
    if (j > 0) upper[j] += (u - from) / (knot(knots, i + degree) - from) * lower[j - 1];
    if (j < degree) upper[j] += (to - u) / (to - knot(knots, i + 1)) * lower[j];
  }
}

/* Cox and de Boor's recursion. */
SporeSplineBasis spore_spline_basis(SporeSplineKnots knots, double parameter, size_t *span) {
  double u = fmin(fmax(parameter, 0), spore_spline_end(knots)), constant = 1, linear[2], slope[3], quadratic[3];
  SporeSplineBasis basis;
  *span = spore_spline_span(knots, u);
  raise(knots, *span, u, 1, &constant, linear);
  raise(knots, *span, u, 2, linear, quadratic);
  raise(knots, *span, u, 3, quadratic, basis.value);
  derive(knots, *span, 3, quadratic, basis.first);
  derive(knots, *span, 2, linear, slope);
  derive(knots, *span, 3, slope, basis.second);
  return basis;
}

void spore_spline_insert(SporeSplineKnots knots, size_t span, double parameter, double ratio[3]) {
  assert(span < knots.span_count);
  assert(parameter > spore_spline_break(knots, span) && parameter < spore_spline_break(knots, span + 1));
  for (size_t i = 0; i < 3; i++) {
    double from = knot(knots, span + 1 + i), to = knot(knots, span + 4 + i);
    ratio[i] = (parameter - from) / (to - from);
  }
}

void spore_spline_solve_band(size_t count, double *band, double *x) {
  assert(count == 0 || (band && x && band != x));
  for (size_t i = 0; i < count; i++) {
    double pivot = sqrt(band[4 * i]);
    for (size_t k = 0; k < 4; k++) band[4 * i + k] /= pivot;
    for (size_t k = 1; k < 4 && i + k < count; k++)
      for (size_t l = k; l < 4; l++) band[4 * (i + k) + l - k] -= band[4 * i + k] * band[4 * i + l];
    spore_vec3_store(x + 3 * i, spore_vec3_scale(1 / band[4 * i], spore_vec3_load(x + 3 * i)));
    for (size_t k = 1; k < 4 && i + k < count; k++)
      for (size_t c = 0; c < 3; c++) x[3 * (i + k) + c] -= band[4 * i + k] * x[3 * i + c];
  }
  for (size_t i = count; i-- > 0;)
    for (size_t c = 0; c < 3; c++) {
      for (size_t k = 1; k < 4 && i + k < count; k++) x[3 * i + c] -= band[4 * i + k] * x[3 * (i + k) + c];
      x[3 * i + c] /= band[4 * i];
    }
}
