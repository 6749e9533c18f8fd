/* Fitting a spline to a curve; memory and pattern of a spline. */
#include "models/spline/spline.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"

static SporeVec3 point(const SporeCurve *curve, size_t i) { return spore_vec3_load(curve->points + 4 * i); }

static size_t piece_at(const SporeSplineCourse *course, double length) {
  size_t low = 0, high = course->curve.count - 1;
  while (high - low > 1) {
    size_t middle = (low + high) / 2;
    if (course->length[middle] <= length) low = middle;
    else high = middle;
  }
  return low;
}

static SporeVec3 slope_of_piece(const SporeSplineCourse *course, size_t i) {
  assert(i + 1 < course->curve.count);
  return spore_vec3_scale(1 / (course->length[i + 1] - course->length[i]),
                          spore_vec3_sub(point(&course->curve, i + 1), point(&course->curve, i)));
}

/* Slope at a point, of the parabola through it and its neighbours. */
static SporeVec3 slope_at(const SporeSplineCourse *course, size_t i) {
  assert(i < course->curve.count);
  size_t last = course->curve.count - 1, middle = i == 0 ? 1 : i == last ? last - 1 : i;
  if (last < 2) return slope_of_piece(course, 0);
  double before = course->length[middle] - course->length[middle - 1],
         behind = course->length[middle + 1] - course->length[middle];
  SporeVec3 a = slope_of_piece(course, middle - 1), b = slope_of_piece(course, middle);
  SporeVec3 bend = spore_vec3_scale(1 / (before + behind), spore_vec3_sub(b, a));
  double offset = i < middle ? -before : i > middle ? before + 2 * behind : before;
  return spore_vec3_add_scaled(a, offset, bend);
}

/* A smooth line through the curve's points. */
static SporeVec3 line_at(const SporeSplineCourse *course, double length) {
  size_t i = piece_at(course, length);
  double h = course->length[i + 1] - course->length[i], t = fmin(fmax((length - course->length[i]) / h, 0), 1),
         s = 1 - t;
  SporeVec3 p = spore_vec3_scale(s * s * (1 + 2 * t), point(&course->curve, i));
  p = spore_vec3_add_scaled(p, t * t * (3 - 2 * t), point(&course->curve, i + 1));
  p = spore_vec3_add_scaled(p, h * s * s * t, slope_at(course, i));
  return spore_vec3_add_scaled(p, -h * t * t * s, slope_at(course, i + 1));
}

bool spore_spline_course_init(SporeSplineCourse *course, const SporeCurve *curve) {
  size_t count = curve->count;
  *course = (SporeSplineCourse){.length = SPORE_NEW_ARRAY(double, count)};
  if (!course->length || !spore_curve_allocate(&course->curve, count, NULL)) return false;
  memcpy(course->curve.points, curve->points, 4 * count * sizeof *curve->points);
  for (size_t i = 1; i < count; i++)
    course->length[i] = course->length[i - 1] + spore_vec3_distance(point(curve, i - 1), point(curve, i));
  return true;
}

void spore_spline_course_clear(SporeSplineCourse *course) {
  spore_curve_clear(&course->curve);
  spore_free(course->length);
  *course = (SporeSplineCourse){0};
}

/* Products of the functions (band: i x 4, with i + k) and of them with the line (in control). */
static void add_products(const SporeSplineCourse *course, SporeSplineKnots knots, double *band, double *control) {
  double whole = spore_spline_course_length(course);
  for (size_t n = 0; n < SPORE_SPLINE_SAMPLES * knots.span_count; n++) {
    size_t span = n / SPORE_SPLINE_SAMPLES;
    double width = spore_spline_width(knots, span), part = (double)(n % SPORE_SPLINE_SAMPLES) + 0.5;
    double u = spore_spline_break(knots, span) + part / SPORE_SPLINE_SAMPLES * width;
    SporeSplineBasis basis = spore_spline_basis(knots, u, &span);
    SporeVec3 p = line_at(course, u / spore_spline_end(knots) * whole);
    for (size_t i = 0; i < 4; i++) {
      for (size_t j = i; j < 4; j++) band[4 * (span + i) + j - i] += width * basis.value[i] * basis.value[j];
      double *sum = control + 3 * (span + i);
      spore_vec3_store(sum, spore_vec3_add_scaled(spore_vec3_load(sum), width * basis.value[i], p));
    }
  }
}

/* The ends are known: their columns go to the right-hand side, their rows become x = end. */
static void hold(size_t count, size_t held, SporeVec3 at, double *band, double *control) {
  assert(held < count);
  for (size_t k = 1; k < 4; k++) {
    double *ahead = held + k < count ? band + 4 * held + k : NULL, *back = held >= k ? band + 4 * (held - k) + k : NULL;
    if (ahead) {
      double *x = control + 3 * (held + k);
      spore_vec3_store(x, spore_vec3_add_scaled(spore_vec3_load(x), -*ahead, at));
      *ahead = 0;
    }
    if (back) {
      double *x = control + 3 * (held - k);
      spore_vec3_store(x, spore_vec3_add_scaled(spore_vec3_load(x), -*back, at));
      *back = 0;
    }
  }
  band[4 * held] = 1;
  spore_vec3_store(control + 3 * held, at);
}

bool spore_spline_fit(const SporeSplineCourse *course, SporeSplineKnots knots, double *control) {
  assert(course->curve.count > 1 && knots.span_count > 0);
  size_t count = knots.span_count + 3;
  double *band = SPORE_NEW_ARRAY(double, 4 * count);
  if (!band) return false;
  memset(control, 0, 3 * count * sizeof *control);
  add_products(course, knots, band, control);
  hold(count, 0, point(&course->curve, 0), band, control);
  hold(count, count - 1, point(&course->curve, course->curve.count - 1), band, control);
  spore_spline_solve_band(count, band, control);
  spore_free(band);
  return true;
}

double spore_spline_radius(const SporeSplineCourse *course, SporeSplineKnots knots, double parameter) {
  assert(course->curve.count > 1);
  double length = parameter / spore_spline_end(knots) * spore_spline_course_length(course);
  size_t i = piece_at(course, length);
  double share = fmin((length - course->length[i]) / (course->length[i + 1] - course->length[i]), 1);
  const double *points = course->curve.points + 4 * i;
  return (1 - share) * points[3] + share * points[7];
}

bool spore_spline_allocate(SporeSpline *spline, size_t span_count) {
  assert(span_count > 0);
  spline->span_count = span_count;
  spline->group_count = (span_count + SPORE_LANES - 1) / SPORE_LANES;
  spline->gauss = SPORE_NEW_ARRAY(SporeSplineGauss, SPORE_SPLINE_POINTS * spline->group_count);
  spline->upper = SPORE_NEW_ARRAY(uint32_t, 4 * (span_count + 3));
  spline->lower = SPORE_NEW_ARRAY(uint32_t, 4 * (span_count + 3));
  return spline->gauss && spline->upper && spline->lower;
}

void spore_spline_clear(SporeSpline *spline) {
  spore_free(spline->gauss);
  spore_free(spline->upper);
  spore_free(spline->lower);
  *spline = (SporeSpline){0};
}

bool spore_spline_pattern(const SporeSpline *spline, SporeBlockPattern *pattern) {
  for (size_t i = 0; i < spline->span_count + 3; i++)
    for (size_t k = 1; k < 4 && i + k < spline->span_count + 3; k++)
      if (!spore_block_pattern_add(pattern, (uint32_t)i, (uint32_t)(i + k))) return false;
  return true;
}

void spore_spline_find_blocks(SporeSpline *spline, const SporeBlockMatrix *matrix) {
  assert(matrix->block_count >= spline->span_count + 3);
  size_t count = spline->span_count + 3;
  for (uint32_t i = 0; i < count; i++)
    for (uint32_t k = 0; k < 4 && i + k < count; k++) {
      spline->upper[4 * i + k] = (uint32_t)spore_block_matrix_find(matrix, i, i + k);
      spline->lower[4 * i + k] = (uint32_t)spore_block_matrix_find(matrix, i + k, i);
    }
}

double spore_spline_strain(const SporeSpline *spline, const double *q) {
  assert(spline->span_count > 0);
  double most = 0;
  for (size_t span = 0; span < spline->span_count; span++) {
    for (size_t point = 0; point < SPORE_SPLINE_POINTS; point++) {
      const SporeSplineGauss *gauss = &spline->gauss[span / SPORE_LANES * SPORE_SPLINE_POINTS + point];
      SporeVec3 a = {0, 0, 0};
      for (size_t k = 0; k < 4; k++)
        a = spore_vec3_add_scaled(a, gauss->first[k][span % SPORE_LANES], spore_vec3_load(q + 3 * (span + k)));
      most = fmax(most, spore_vec3_dot(a, a));
    }
  }
  return sqrt(most) - 1;
}
