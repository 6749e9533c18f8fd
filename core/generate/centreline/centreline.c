/* The centreline of a tubular organ: the steps from its surface to a curve, and the refusal of shapes that are not
 * tubes. */
#include "core/generate/centreline/centreline.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/profile.h"
#include "core/base/text.h"
#include "core/generate/centreline/private.h"

#define LEAST_SLENDER 4.5 /* least length of a tube, in diameters */
#define MOST_OFFSET 0.4   /* radii from the centroids of its sections: farther off, a line is no centreline */
#define LEAST_COVER 0.4   /* least share of a tube's volume within two radii of its centreline */
#define RING 0.8          /* of a line, between the two places that a loop joins: more in a closed ring */
#define BESIDE 1.5        /* largest distance of an end from the organ, in voxels */

static bool check_options(const SporeCentrelineOptions *options, SporeError *error) {
  if (options->points == 1 || options->points > SPORE_CENTRELINE_MOST_POINTS)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("%zu points were asked for; 2 to %u were expected; ask for another number"),
                           options->points, SPORE_CENTRELINE_MOST_POINTS);
  if (options->points || (options->tolerance >= 0 && options->tolerance < 1)) return true;
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("the tolerance is %g; a fraction of the radius such as %g was expected; give one"),
                         options->tolerance, SPORE_CENTRELINE_TOLERANCE);
}

/* Voxels of the ends that were asked for. */
static bool find_ends(const SporeVoxelTube *tube, const SporeCentrelineOptions *options, uint32_t ends[2],
                      SporeError *error) {
  for (int i = 0; i < 2; i++) {
    SporeVec3 end = spore_vec3_load(options->ends[i]);
    if (!spore_vec3_is_finite(end))
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("end %d is no place; three numbers in metres were expected; correct them"), i + 1);
    ends[i] = spore_voxel_of_place(tube, end);
    uint32_t beside = ends[i] == SPORE_NO_VOXEL ? spore_voxel_nearest(tube, end) : ends[i];
    double distance = spore_vec3_distance(end, spore_voxel_middle(tube, beside));
    if (ends[i] == SPORE_NO_VOXEL || distance > BESIDE * tube->edge)
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("end %d (%g %g %g) lies %g m outside of the organ or in a piece that does not hang "
                               "together with the largest; a place in it, in metres, was expected; move it"),
                             i + 1, end.x, end.y, end.z, distance);
  }
  if (ends[0] != ends[1]) return true;
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("the two ends lie in the same place; two ends of a tube were expected; move one of them"));
}

static bool refuse_shape(const SporeCentrelineOptions *options, const SporeCentrelineReport *report,
                         const SporeVoxelPath *path, double volume, SporeError *error) {
  double diameter = 2 * sqrt(report->share * volume / (M_PI * report->length)), slender = report->length / diameter;
  if (options->ends_given) return true;
  if (slender < LEAST_SLENDER)
    return spore_error_set(
        error, SPORE_ERROR_INPUT, NULL,
        _("this is not a tube: its longest way inside is %g m, %.1f times its mean diameter; at least "
          "%g times was expected; give two ends, or make spheres or tetrahedra of it"),
        report->length, slender, LEAST_SLENDER);
  bool tube = path->followed >= LEAST_COVER && report->offset <= MOST_OFFSET;
  if (tube && path->ring <= RING) return true;
  if (tube)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("this is a closed ring, which has no ends; a tube with two ends was expected; give two "
                             "ends, or cut the ring open"));
  return spore_error_set(
      error, SPORE_ERROR_INPUT, NULL,
      _("this is not a tube: %.0f %% of it lies around its longest way inside, which runs %.2f radii "
        "off the middle of its sections; it is flat, or has many branches; give two ends, or make "
        "spheres or tetrahedra of it"),
      100 * path->followed, report->offset);
}

/* The voxel path is longer than the smooth line. Sets where along the smooth line each branch leaves. */
static void place_branches(const SporeCurve *curve, SporeCentrelineReport *report) {
  for (size_t i = 0; i < SPORE_CENTRELINE_NAMED && i < report->branches; i++) {
    SporeVec3 foot = spore_vec3_load(report->branch[i].foot);
    double least = HUGE_VAL, along = 0;
    for (size_t k = 1; k < curve->count; k++) {
      SporeVec3 from = spore_vec3_load(curve->points + 4 * (k - 1)), to = spore_vec3_load(curve->points + 4 * k);
      SporeVec3 step = spore_vec3_sub(to, from);
      double length = spore_vec3_length(step), square = length * length;
      double u = square > 0 ? spore_vec3_dot(spore_vec3_sub(foot, from), step) / square : 0;
      u = fmin(fmax(u, 0), 1);
      double distance = spore_vec3_distance(foot, spore_vec3_add_scaled(from, u, step));
      if (distance < least) least = distance, report->branch[i].from = along + u * length;
      along += length;
    }
  }
}

/* The path between the ends that were asked for, or the one that is known already. */
static bool find_path(SporeTubeOrgan *organ, const SporeCentrelineOptions *options, SporeCentrelineReport *report,
                      const SporeProgressPart *progress, SporeError *error) {
  uint32_t ends[2];
  if (!options->ends_given && organ->path.count) {
    memcpy(report->branch, organ->left.branch, sizeof report->branch);
    report->branches = organ->left.branches;
    return true;
  }
  spore_voxel_path_clear(&organ->path);
  return (!options->ends_given || find_ends(&organ->tube, options, ends, error)) &&
         spore_voxel_path_find(&organ->path, &organ->tube, options->ends_given ? ends : NULL, report, progress, error);
}

static bool find(SporeTubeOrgan *organ, const SporeTriangleMesh *mesh, const SporeCentrelineOptions *options,
                 SporeCurve *curve, SporeCentrelineReport *report, const SporeProgress *progress, SporeError *error) {
  SporeCurve dense = {0};
  SporeProgressPart finding = {progress, 0.5, 0.2}, refining = {progress, 0.7, 0.2},
                    reaching = {progress, 0.9, options->way ? 0.05 : 0.1}, going = {progress, 0.95, 0.05};
  report->components = organ->tube.component_count;
  report->share = organ->tube.share;
  report->inner_wall = organ->inner_wall;
  bool done = find_path(organ, options, report, &finding, error) &&
              spore_centreline_refine(&organ->solid, &organ->tube, &organ->path, options, &dense, &refining, error);
  if (done) {
    spore_centreline_figures(&organ->solid, &dense, report);
    place_branches(&dense, report);
    done = refuse_shape(options, report, &organ->path, organ->solid.volume, error) &&
           spore_voxel_path_cover(&organ->path, &organ->tube, &report->cover, &reaching, error) &&
           (!options->way || spore_voxel_path_ways(&organ->path, &organ->tube, mesh, options->way, &going, error)) &&
           spore_centreline_thin(&dense, options, curve, error);
  }
  if (done && progress && progress->show) progress->show(progress->data, curve->points, curve->count);
  spore_curve_clear(&dense);
  return done;
}

bool spore_centreline_from_mesh(const SporeTriangleMesh *mesh, const SporeCentrelineOptions *options, SporeCurve *curve,
                                SporeCentrelineReport *report, const SporeProgress *progress, SporeError *error) {
  uint64_t start = spore_clock_ns();
  SporeTubeOrgan organ;
  *curve = (SporeCurve){0};
  *report = (SporeCentrelineReport){0};
  if (!check_options(options, error) || !spore_tube_organ_create(&organ, mesh, progress, error)) return false;
  bool done = find(&organ, mesh, options, curve, report, progress, error);
  spore_tube_organ_clear(&organ);
  if (!done) spore_curve_clear(curve);
  report->seconds = (double)(spore_clock_ns() - start) * 1e-9;
  return done;
}

bool spore_centreline_measure(const SporeTriangleMesh *mesh, SporeCurve *curve, SporeCentrelineReport *report,
                              SporeError *error) {
  uint64_t start = spore_clock_ns();
  SporeSolid solid;
  *report = (SporeCentrelineReport){0};
  if (!spore_curve_validate(curve, error) || !spore_tube_solid_along(&solid, mesh, curve, &report->inner_wall, error))
    return false;
  spore_centreline_set_radii(&solid, curve);
  spore_centreline_figures(&solid, curve, report);
  spore_solid_clear(&solid);
  report->seconds = (double)(spore_clock_ns() - start) * 1e-9;
  return true;
}
