/* The spline sheet nearest to a mesh whose vertices have parameters: least squares, smoothed where that is asked for.
 */
#include "core/mesh/sheet_fit.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/math/spline.h"

#define SAMPLES 8 /* a span, each way */

/* The sheet at the middles of SAMPLES parts of each span, both ways. */
typedef struct Samples {
  size_t count[2];
  double *point, *within; /* x 3; the least weight of the three corners, greater for triangles that hold the sample */
} Samples;

static void sample_triangle(const SporeTriangleMesh *mesh, const double *parameters, const uint32_t *corner,
                            Samples *samples) {
  const double *at[3];
  size_t first[2], end[2];
  for (size_t k = 0; k < 3; k++) at[k] = parameters + 2 * (size_t)corner[k];
  for (size_t e = 0; e < 2; e++) {
    double n = (double)samples->count[e], low = fmin(at[0][e], fmin(at[1][e], at[2][e]));
    double high = fmax(at[0][e], fmax(at[1][e], at[2][e]));
    first[e] = (size_t)fmax(floor(low * n - 0.5), 0);
    end[e] = (size_t)fmin(ceil(high * n + 0.5), n);
  }
  double bx = at[1][0] - at[0][0], by = at[1][1] - at[0][1], cx = at[2][0] - at[0][0], cy = at[2][1] - at[0][1];
  double area = bx * cy - by * cx;
  for (size_t j = first[1]; j < end[1]; j++)
    for (size_t i = first[0]; i < end[0]; i++) {
      double x = ((double)i + 0.5) / (double)samples->count[0] - at[0][0];
      double y = ((double)j + 0.5) / (double)samples->count[1] - at[0][1];
      double b = (x * cy - y * cx) / area, c = (bx * y - by * x) / area;
      size_t n = j * samples->count[0] + i;
      double within = fmin(fmin(b, c), 1 - b - c);
      if (!(within > samples->within[n])) continue;
      samples->within[n] = within;
      SporeVec3 p = spore_vec3_scale(1 - b - c, spore_vec3_load(mesh->vertices + 3 * (size_t)corner[0]));
      p = spore_vec3_add_scaled(p, b, spore_vec3_load(mesh->vertices + 3 * (size_t)corner[1]));
      p = spore_vec3_add_scaled(p, c, spore_vec3_load(mesh->vertices + 3 * (size_t)corner[2]));
      spore_vec3_store(samples->point + 3 * n, p);
    }
}

static bool take_samples(const SporeTriangleMesh *mesh, const double *parameters, Samples *samples) {
  size_t n = samples->count[0] * samples->count[1];
  samples->point = SPORE_NEW_ARRAY(double, 3 * n);
  samples->within = SPORE_NEW_ARRAY(double, n);
  if (!samples->point || !samples->within) return false;
  for (size_t i = 0; i < n; i++) samples->within[i] = -HUGE_VAL;
  for (size_t t = 0; t < mesh->triangle_count; t++) sample_triangle(mesh, parameters, mesh->triangles + 3 * t, samples);
  return true;
}

/* Adds `weight` times the integral of the square of the second derivative, which is linear in a span. */
static void add_bending(size_t span_count, double weight, double *band) {
  for (size_t span = 0; weight > 0 && span < span_count; span++)
    for (int point = 0; point < 2; point++) {
      SporeSplineKnots knots = spore_spline_uniform(span_count);
      size_t first;
      SporeSplineBasis basis = spore_spline_basis(knots, spore_spline_gauss_parameter(knots, span, point), &first);
      for (size_t i = 0; i < 4; i++)
        for (size_t j = i; j < 4; j++)
          band[4 * (first + i) + j - i] += 0.5 * weight * basis.second[i] * basis.second[j];
    }
}

/* A line along u or v. */
typedef struct Line {
  size_t span_count;
  double bending; /* of add_bending, for one sample a span */
} Line;

/* The spline of a line nearest to SAMPLES points a span, `stride` doubles apart; both x y z. */
static void fit_line(const Line *line, const double *samples, size_t stride, double *band, double *control,
                     size_t control_stride, double *work) {
  size_t span_count = line->span_count, count = span_count + 3, span;
  memset(band, 0, 4 * count * sizeof *band);
  memset(work, 0, 3 * count * sizeof *work);
  add_bending(span_count, SAMPLES * line->bending, band);
  for (size_t n = 0; n < SAMPLES * span_count; n++) {
    SporeSplineBasis basis = spore_spline_basis(spore_spline_uniform(span_count), ((double)n + 0.5) / SAMPLES, &span);
    for (size_t i = 0; i < 4; i++) {
      for (size_t j = i; j < 4; j++) band[4 * (span + i) + j - i] += basis.value[i] * basis.value[j];
      for (size_t c = 0; c < 3; c++) work[3 * (span + i) + c] += basis.value[i] * samples[stride * n + c];
    }
  }
  spore_spline_solve_band(count, band, work);
  for (size_t i = 0; i < count; i++) memcpy(control + control_stride * i, work + 3 * i, 3 * sizeof *work);
}

/* Mean length of the samples' lines along u (way 0) or v (way 1), m. */
static double mean_length(const Samples *samples, int way) {
  size_t n = samples->count[way], lines = samples->count[1 - way], step = way ? samples->count[0] : 1, pieces = 0;
  double sum = 0;
  for (size_t line = 0; line < lines; line++)
    for (size_t i = 0; i + 1 < n; i++, pieces++) {
      const double *at = samples->point + 3 * (line * (way ? 1 : samples->count[0]) + i * step);
      sum += spore_vec3_distance(spore_vec3_load(at), spore_vec3_load(at + 3 * step));
    }
  return sum / (double)pieces * (double)n;
}

/* A wave of that length (m) comes to half its height: (length / 2 pi)^4 of the second derivative, in spans. */
static double bending_of(const Samples *samples, int way, size_t span_count, double smoothing) {
  if (!(smoothing > 0)) return 0;
  double spans = smoothing * (double)span_count / mean_length(samples, way), part = spans / (2 * M_PI);
  return part * part * part * part;
}

/* The least squares of a tensor product are those of its lines, one way and then the other. */
bool spore_sheet_fit(const SporeTriangleMesh *mesh, const double *parameters, const size_t span[2], double smoothing,
                     double *control) {
  assert(span[0] > 0 && span[1] > 0 && smoothing >= 0);
  size_t nodes_u = span[0] + 3, most = (span[0] > span[1] ? span[0] : span[1]) + 3;
  Samples samples = {.count = {SAMPLES * span[0], SAMPLES * span[1]}};
  double *rows = SPORE_NEW_ARRAY(double, 3 * nodes_u * samples.count[1]);
  double *band = SPORE_NEW_ARRAY(double, 4 * most), *work = SPORE_NEW_ARRAY(double, 3 * most);
  bool made = rows && band && work && take_samples(mesh, parameters, &samples);
  Line line[2] = {{0}};
  for (int way = 0; made && way < 2; way++)
    line[way] = (Line){span[way], bending_of(&samples, way, span[way], smoothing)};
  for (size_t j = 0; made && j < samples.count[1]; j++)
    fit_line(&line[0], samples.point + 3 * samples.count[0] * j, 3, band, rows + 3 * nodes_u * j, 3, work);
  for (size_t i = 0; made && i < nodes_u; i++)
    fit_line(&line[1], rows + 3 * i, 3 * nodes_u, band, control + 3 * i, 3 * nodes_u, work);
  spore_free(samples.point);
  spore_free(samples.within);
  spore_free(rows);
  spore_free(band);
  spore_free(work);
  return made;
}
