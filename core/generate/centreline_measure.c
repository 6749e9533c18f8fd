#include <math.h>

#include "core/base/memory.h"
#include "core/generate/centreline_parts.h"

#define SECTION_REACH 2.5 /* radii */
#define NEIGHBOUR 3.0     /* sums of two points' radii: on the line, points nearer than that are neighbours */
#define RIM 1.5           /* radii from an end that are not asked for their middle */

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
    if (!(spore_bvh_winding(solid->bvh, p) > 0.5)) report->outside += 1 / (double)curve->count;
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
