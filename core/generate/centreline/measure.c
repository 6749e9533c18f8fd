/* Sections of an organ perpendicular to its centreline, and the measurements of the centreline. */
#include <string.h>
#include <stdlib.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/generate/centreline/private.h"

#define SECTION_REACH 2.5 /* radii */
#define NEIGHBOUR 3.0     /* sums of two points' radii: points nearer than this along the line are neighbours */
#define RIM 1.5           /* radii from an end within which the offset is not measured */

static SporeVec3 point(const SporeCurve *curve, size_t i) { return spore_vec3_load(curve->points + 4 * i); }

static void measure_radii(const SporeCurve *curve, SporeCentrelineReport *report) {
  report->length = spore_curve_length(curve);
  report->radius_min = HUGE_VAL;
  for (size_t i = 0; i < curve->count; i++) {
    double radius = curve->points[4 * i + 3];
    report->radius_min = fmin(report->radius_min, radius);
    report->radius_max = fmax(report->radius_max, radius);
    if (i > 0)
      report->radius_mean += 0.5 * (radius + curve->points[4 * i - 1]) / report->length *
                             spore_vec3_distance(point(curve, i - 1), point(curve, i));
  }
}

static void measure_places(const SporeSolid *solid, const SporeCurve *curve, SporeCentrelineReport *report) {
  double along = 0;
  size_t asked = 0;
  for (size_t i = 0; i < curve->count; i++) {
    SporeVec3 p = point(curve, i), before = point(curve, i > 0 ? i - 1 : i);
    SporeVec3 after = point(curve, i + 1 < curve->count ? i + 1 : i);
    double radius = curve->points[4 * i + 3];
    along += spore_vec3_distance(before, p);
    if (!spore_bvh_inside(solid->bvh, p)) report->outside += 1 / (double)curve->count;
    else if (along > RIM * radius && report->length - along > RIM * radius) {
      SporeVec3 across = spore_vec3_normalise(spore_vec3_sub(after, before), spore_vec3(1, 0, 0));
      SporeVec3 middle = spore_section_middle(solid, p, across, SECTION_REACH * radius);
      report->offset += spore_vec3_distance(middle, p) / radius;
      asked++;
    }
  }
  if (asked > 0) report->offset /= (double)asked;
}

static double distance_of_pieces(const SporeCurve *curve, size_t i, size_t k) {
  return spore_vec3_distance(point(curve, i), point(curve, k)) / (curve->points[4 * i + 3] + curve->points[4 * k + 3]);
}

static void measure_approach(const SporeCurve *curve, SporeCentrelineReport *report) {
  report->approach = HUGE_VAL;
  for (size_t i = 0; i < curve->count; i++) {
    double along = 0;
    for (size_t k = i + 1; k < curve->count; k++) {
      along += spore_vec3_distance(point(curve, k - 1), point(curve, k));
      if (along > NEIGHBOUR * (curve->points[4 * i + 3] + curve->points[4 * k + 3]))
        report->approach = fmin(report->approach, distance_of_pieces(curve, i, k));
    }
  }
}

void spore_centreline_figures(const SporeSolid *solid, const SporeCurve *curve, SporeCentrelineReport *report) {
  report->radius_mean = report->radius_max = report->offset = report->outside = 0;
  measure_radii(curve, report);
  measure_places(solid, curve, report);
  measure_approach(curve, report);
}

#define OUTLIER 1.25 /* of the median distance to the wall: largest distance that counts in a section */

/* Whether the ray leaves through the triangle's front. A triangle that the ray enters from outside lies within the
 * organ, or has the wrong orientation. */
static bool leaves(const SporeSolid *solid, uint32_t triangle, SporeVec3 d) {
  return spore_vec3_dot(spore_triangle_across(&solid->mesh, triangle), d) > 0;
}

double spore_section_wall(const SporeSolid *solid, SporeVec3 p, SporeVec3 d, double reach) {
  double gone = 0, beyond = 1e-3 * reach, t;
  uint32_t triangle;
  while (gone < reach && spore_bvh_ray(solid->bvh, spore_vec3_add_scaled(p, gone, d), d, &t, &triangle)) {
    gone += t;
    if (gone >= reach) return reach;
    if (leaves(solid, triangle, d) || !spore_bvh_inside(solid->bvh, spore_vec3_add_scaled(p, gone + beyond, d)))
      return gone;
    gone += beyond;
  }
  return reach;
}

static int by_size(const void *a, const void *b) {
  double one = *(const double *)a, other = *(const double *)b;
  return (one > other) - (one < other);
}

/* Where two loops touch, rays pass through the neck into the other loop. So no distance counts for more than
 * slightly over the median. */
static void cut_outliers(double wall[SPORE_SECTION_RAYS]) {
  double sorted[SPORE_SECTION_RAYS];
  memcpy(sorted, wall, sizeof sorted);
  qsort(sorted, SPORE_SECTION_RAYS, sizeof *sorted, by_size);
  double most = OUTLIER * sorted[SPORE_SECTION_RAYS / 2];
  for (int i = 0; i < SPORE_SECTION_RAYS; i++) wall[i] = fmin(wall[i], most);
}

SporeVec3 spore_section_middle(const SporeSolid *solid, SporeVec3 p, SporeVec3 across, double reach) {
  SporeVec3 axis = fabs(across.x) < 0.6 ? spore_vec3(1, 0, 0) : spore_vec3(0, 1, 0);
  SporeVec3 u = spore_vec3_normalise(spore_vec3_cross(across, axis), axis), v = spore_vec3_cross(across, u);
  double wall[SPORE_SECTION_RAYS], area = 0;
  SporeVec3 ray[SPORE_SECTION_RAYS], sum = {0, 0, 0};
  for (int i = 0; i < SPORE_SECTION_RAYS; i++) {
    double angle = 2 * M_PI * i / SPORE_SECTION_RAYS;
    ray[i] = spore_vec3_add_scaled(spore_vec3_scale(cos(angle), u), sin(angle), v);
    wall[i] = spore_section_wall(solid, p, ray[i], reach);
  }
  cut_outliers(wall);
  for (int i = 0; i < SPORE_SECTION_RAYS; i++) { /* triangles from p to two neighbouring rays */
    int next = (i + 1) % SPORE_SECTION_RAYS;
    double share = wall[i] * wall[next];
    area += share;
    sum = spore_vec3_add_scaled(sum, share * wall[i] / 3, ray[i]);
    sum = spore_vec3_add_scaled(sum, share * wall[next] / 3, ray[next]);
  }
  return area > 0 ? spore_vec3_add_scaled(p, 1 / area, sum) : p;
}
