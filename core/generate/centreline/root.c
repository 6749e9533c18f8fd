/* Proposes where the mesentery of a bowel begins, and measures a mesentery. */
#include <assert.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/centreline/centreline.h"
#include "core/generate/common/common.h"
#include "core/linalg/dense.h"
#include "core/math/vec3.h"
#include "core/mesh/mesentery.h"

#define POINTS 33    /* of a root */
#define THIN 0.2     /* radius of a root, of the line's mean radius */
#define SHORTEST 1.0 /* length of a root, in mean radii */
#define TERMS (SPORE_CENTRELINE_ROOT_DEGREE + 1)
_Static_assert(TERMS <= SPORE_LANES, "the system's rows lie SPORE_LANES apart");

/* Bernstein's polynomials of that degree. */
static void bernstein(size_t degree, double u, double *value) {
  assert(degree < TERMS);
  value[0] = 1;
  for (size_t n = 1; n <= degree; n++) {
    value[n] = u * value[n - 1];
    for (size_t k = n - 1; k > 0; k--) value[k] = (1 - u) * value[k] + u * value[k - 1];
    value[0] *= 1 - u;
  }
}

/* The normal equations of the least squares: rows and right sides (a coordinate each). */
typedef struct Fit {
  double matrix[TERMS * SPORE_LANES], side[3][TERMS];
} Fit;

/* Adds a point of the line: how far along, as a part of the length, and the length it stands for. */
static void add_point(Fit *fit, size_t degree, double part, double length, const double *point) {
  double value[TERMS];
  bernstein(degree, part, value);
  for (size_t i = 0; i <= degree; i++) {
    for (size_t j = 0; j <= degree; j++) fit->matrix[i * SPORE_LANES + j] += length * value[i] * value[j];
    for (int k = 0; k < 3; k++) fit->side[k][i] += length * value[i] * point[k];
  }
}

/* Simpson's rule on each straight piece, so that a line of few points is enough. Returns the mean radius. */
static double collect(const SporeCurve *line, size_t degree, Fit *fit) {
  double length = spore_curve_length(line), walked = 0, sum = 0;
  for (size_t i = 1; i < line->count; i++) {
    const double *a = line->points + 4 * (i - 1), *b = a + 4;
    double piece = spore_vec3_distance(spore_vec3_load(a), spore_vec3_load(b));
    const double middle[3] = {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
    add_point(fit, degree, walked / length, piece / 6, a);
    add_point(fit, degree, (walked + 0.5 * piece) / length, 4 * piece / 6, middle);
    add_point(fit, degree, fmin((walked + piece) / length, 1), piece / 6, b);
    sum += 0.5 * (a[3] + b[3]) * piece;
    walked += piece;
  }
  return sum / length;
}

bool spore_centreline_root(const SporeCurve *line, size_t degree, SporeCurve *root, SporeError *error) {
  assert(degree > 0 && degree < TERMS && line->count > 1);
  Fit fit = {0};
  uint32_t order[TERMS];
  double radius = collect(line, degree, &fit), value[TERMS];
  bool solved = SPORE_KERNEL(spore_dense_factorise)(degree + 1, SPORE_LANES, fit.matrix, order);
  for (int k = 0; solved && k < 3; k++)
    SPORE_KERNEL(spore_dense_solve)(degree + 1, SPORE_LANES, fit.matrix, order, fit.side[k]);
  if (!spore_curve_allocate(root, POINTS, error)) return false;
  for (size_t i = 0; i < POINTS; i++) {
    bernstein(degree, (double)i / (POINTS - 1), value);
    for (int k = 0; k < 3; k++)
      for (size_t j = 0; j <= degree; j++) root->points[4 * i + (size_t)k] += value[j] * fit.side[k][j];
    root->points[4 * i + 3] = THIN * radius;
  }
  if (solved && spore_curve_length(root) > SHORTEST * radius) return true;
  spore_curve_clear(root);
  return spore_error_set(
      error, SPORE_ERROR_INPUT, NULL,
      _("the loops go around one place, so that no root of a mesentery can be proposed; give one, or "
        "ask for none by a degree of 0"));
}

/* Each point stands for half of the line to either side. */
static void weigh(const SporeCurve *line, double *points, double *weight) {
  for (size_t i = 0; i < line->count; i++) {
    SporeVec3 p = spore_vec3_load(line->points + 4 * i);
    spore_vec3_store(points + 3 * i, p);
    if (i == 0) continue;
    double half = 0.5 * spore_vec3_distance(p, spore_vec3_load(points + 3 * (i - 1)));
    weight[i - 1] += half;
    weight[i] += half;
  }
}

bool spore_centreline_root_measure(const SporeCurve *line, const SporeCurve *root, SporeCentrelineRoot *figures,
                                   SporeError *error) {
  double *points = SPORE_NEW_ARRAY(double, 3 * line->count), *weight = SPORE_NEW_ARRAY(double, line->count);
  double *feet = SPORE_NEW_ARRAY(double, 3 * line->count), length = spore_curve_length(line);
  *figures = (SporeCentrelineRoot){.length = spore_curve_length(root), .shortest = HUGE_VAL};
  bool spread = points && weight && feet;
  if (spread) {
    weigh(line, points, weight);
    spread = spore_mesentery_spread(root, points, weight, line->count, feet);
  }
  for (size_t i = 0; spread && i < line->count; i++) {
    double away = spore_vec3_distance(spore_vec3_load(points + 3 * i), spore_vec3_load(feet + 3 * i));
    figures->shortest = fmin(figures->shortest, away);
    figures->longest = fmax(figures->longest, away);
    figures->mean += away * weight[i] / length;
  }
  spore_free(points);
  spore_free(weight);
  spore_free(feet);
  return spread || spore_generate_no_memory(error);
}
