/* Spheres along a curve. Between two spheres of radius r at a distance h, the tube's wall lies h^2 / (8 r) outside the
 * spheres. On the outer side of a bend of curvature k, this gap is larger by the factor 1 + k r. The spheres are placed
 * so that the gap is the same between all neighbours. */
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/spheres/private.h"

#define PIECES_A_RADIUS 8. /* the curve is divided into this many pieces per radius */
#define PIECES_MOST 64.    /* between two points */

typedef struct Pieces {
  SporeCurve curve; /* points close together */
  double *need;     /* points: number of spheres before the point, up to a factor */
} Pieces;

static SporeVec3 point(const SporeCurve *curve, size_t i) { return spore_vec3_load(curve->points + 4 * i); }

/* Curvature at a point, from the circle through it and its neighbours. */
static double curvature(const SporeCurve *curve, size_t i) {
  if (i == 0 || i + 1 >= curve->count) return 0;
  SporeVec3 a = spore_vec3_sub(point(curve, i), point(curve, i - 1));
  SporeVec3 b = spore_vec3_sub(point(curve, i + 1), point(curve, i));
  double product = spore_vec3_length(a) * spore_vec3_length(b) * spore_vec3_length(spore_vec3_add(a, b));
  return product > 0 ? 2 * spore_vec3_length(spore_vec3_cross(a, b)) / product : 0;
}

static size_t pieces_between(const SporeCurve *curve, size_t i) {
  const double *a = curve->points + 4 * i, *b = a + 4;
  double length = spore_vec3_distance(point(curve, i), point(curve, i + 1));
  return (size_t)fmin(ceil(length / fmin(a[3], b[3]) * PIECES_A_RADIUS), PIECES_MOST);
}

/* Wanted density of spheres at a point of the input curve, per metre, up to a factor. */
static double density(const SporeCurve *curve, size_t i) {
  double r = curve->points[4 * i + 3];
  return sqrt((1 + fmin(curvature(curve, i) * r, 1)) / r);
}

static bool divide(const SporeCurve *curve, Pieces *pieces, SporeError *error) {
  size_t count = 1, at = 0;
  for (size_t i = 0; i + 1 < curve->count; i++) count += pieces_between(curve, i);
  *pieces = (Pieces){0};
  if (!spore_curve_allocate(&pieces->curve, count, error)) return false;
  pieces->need = SPORE_NEW_ARRAY(double, count);
  if (!pieces->need) {
    spore_curve_clear(&pieces->curve);
    return spore_generate_no_memory(error);
  }
  for (size_t i = 0; i < curve->count; i++) {
    const double *a = curve->points + 4 * i, *b = i + 1 < curve->count ? a + 4 : a;
    size_t steps = i + 1 < curve->count ? pieces_between(curve, i) : 1;
    for (size_t k = 0; k < steps; k++, at++) {
      double t = (double)k / (double)steps, *to = pieces->curve.points + 4 * at;
      for (int c = 0; c < 4; c++) to[c] = a[c] + t * (b[c] - a[c]);
      if (at == 0) continue;
      double here = density(curve, i) * (1 - t) + (i + 1 < curve->count ? density(curve, i + 1) * t : 0);
      pieces->need[at] =
          pieces->need[at - 1] + here * spore_vec3_distance(spore_vec3_load(to), spore_vec3_load(to - 4));
    }
  }
  return true;
}

/* The sphere where `need` is reached. */
static void sphere_at(const Pieces *pieces, double need, double sphere[4]) {
  size_t low = 0, high = pieces->curve.count - 1;
  while (high - low > 1) {
    size_t middle = low + (high - low) / 2;
    if (pieces->need[middle] > need) high = middle;
    else low = middle;
  }
  double span = pieces->need[high] - pieces->need[low], t = span > 0 ? (need - pieces->need[low]) / span : 0;
  t = fmin(fmax(t, 0), 1);
  const double *a = pieces->curve.points + 4 * low, *b = pieces->curve.points + 4 * high;
  for (int c = 0; c < 4; c++) sphere[c] = a[c] + t * (b[c] - a[c]);
}

/* Grows each sphere so that half of the wall towards its neighbours lies inside the sphere and half outside: on the
 * wall of a tube of radius r, at a quarter of the distance h to the neighbour, r'^2 = r^2 + h^2 / 16. The end spheres
 * stay, as they have one neighbour only. */
static void grow(SporeSphereSet *set) {
  double before = 0;
  for (size_t i = 0; i + 1 < set->count; i++) {
    double *s = set->spheres + 4 * i;
    double after = spore_vec3_distance(spore_vec3_load(s), spore_vec3_load(s + 4));
    double h = i == 0 ? 0 : fmin(before, after); /* the round end needs no growth */
    s[3] = sqrt(s[3] * s[3] + fmin(h, 2 * s[3]) * fmin(h, 2 * s[3]) / 16);
    before = after;
  }
}

static bool copy_balls(SporeBalls *balls, const double *spheres, size_t count) {
  if (!spore_balls_create(balls, count)) return false;
  for (size_t i = 0; i < count; i++) spore_balls_set(balls, i, spore_vec3_load(spheres + 4 * i), spheres[4 * i + 3]);
  return true;
}

/* Measures against balls at the points of `pieces`. The points are so close that the tube's wall lies only a few
 * thousandths of the radius outside these balls. */
static bool measure(const Pieces *pieces, const SporeSphereSet *set, SporeSpheresReport *report,
                    const SporeProgressPart *progress, SporeError *error) {
  SporeBalls whole = {0}, balls = {0};
  bool ready =
      copy_balls(&whole, pieces->curve.points, pieces->curve.count) && copy_balls(&balls, set->spheres, set->count);
  bool done = ready ? spore_balls_compare(&whole, &balls, report, progress, error) : spore_generate_no_memory(error);
  spore_balls_clear(&whole);
  spore_balls_clear(&balls);
  return done;
}

bool spore_spheres_along(const SporeCurve *curve, size_t count, SporeSphereSet *set, SporeSpheresReport *report,
                         const SporeProgressPart *progress, SporeError *error) {
  Pieces pieces;
  *set = (SporeSphereSet){0};
  bool done = spore_progress_part(progress, 0, _("Stringing spheres"), error) && divide(curve, &pieces, error);
  if (!done) return false;
  done = spore_sphere_set_allocate(set, count, error);
  double all = pieces.need[pieces.curve.count - 1];
  for (size_t i = 0; done && i < count; i++)
    sphere_at(&pieces, count > 1 ? all * (double)i / (double)(count - 1) : all / 2, set->spheres + 4 * i);
  if (done) grow(set);
  SporeProgressPart measuring = {progress->whole, progress->first + 0.2 * progress->share, 0.8 * progress->share};
  done = done && measure(&pieces, set, report, &measuring, error);
  spore_curve_clear(&pieces.curve);
  spore_free(pieces.need);
  if (!done) spore_sphere_set_clear(set);
  return done;
}
