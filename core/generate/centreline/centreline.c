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
#define COILED 0.9        /* share of a solid near its centreline, if it has no lumen; less for the wall of a lumen */
#define SKIN 0.1          /* of the volume of wall and lumen: a wall with less is not a tube by itself */
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

/* Whether the solid without a lumen is already a tube. Its hidden surface then lies between its coils and is not the
 * wall of a lumen. filled: the solid with its lumen, as far as known. A very thin wall is not tested, because it would
 * need too many voxels. */
static bool is_coiled(const SporeSolid *solid, const SporeSolid *filled, bool *coiled,
                      const SporeProgressPart *progress, SporeError *error) {
  SporeVoxelTube tube;
  SporeVoxelPath path = {0};
  SporeCentrelineReport report = {0};
  *coiled = false;
  if (solid->volume < SKIN * filled->volume) return true;
  if (!spore_voxel_tube_create(&tube, solid, progress, error)) return false;
  bool done = spore_voxel_path_find(&path, &tube, NULL, &report, progress, error);
  *coiled = done && tube.share * report.cover >= COILED;
  spore_voxel_path_clear(&path);
  spore_voxel_tube_clear(&tube);
  return done;
}

static bool runs_inside(const SporeSolid *solid, const SporeCurve *curve) {
  SporeCentrelineReport report = {0};
  spore_centreline_figures(solid, curve, &report);
  return report.outside < 0.5;
}

static bool replace_solid(SporeSolid *solid, const SporeTriangleMesh *mesh, SporeError *error) {
  if (!mesh->triangle_count) return true;
  spore_solid_clear(solid);
  return spore_solid_create(solid, mesh, error);
}

/* The solid whose centreline is sought, without inner walls. If there is a lumen, this is the solid of the outer
 * wall. curve: a curve that is known to run in the middle; NULL: none. */
static bool make_solid(SporeSolid *solid, const SporeTriangleMesh *mesh, const SporeCurve *curve, double *inner_wall,
                       const SporeProgressPart *progress, SporeError *error) {
  SporeOuterWall wall;
  SporeSolid filled = {0};
  SporeProgressPart looking = {progress->whole, progress->first, progress->share / 2};
  SporeProgressPart trying = {progress->whole, progress->first + progress->share / 2, progress->share / 2};
  if (!spore_solid_create(solid, mesh, error)) return false;
  bool done =
      spore_outer_wall(&solid->mesh, solid->bvh, &wall, &looking, error) && replace_solid(solid, &wall.solid, error);
  bool coiled = !done || !(wall.hidden > 0) || (curve && runs_inside(solid, curve));
  if (!coiled) {
    done = replace_solid(&filled, &wall.filled, error);
    if (done && !curve) done = is_coiled(solid, &filled, &coiled, &trying, error);
  }
  *inner_wall = coiled ? 0 : wall.hidden;
  if (done && !coiled && filled.mesh.triangle_count) {
    spore_solid_clear(solid);
    *solid = filled;
    filled = (SporeSolid){0};
  }
  spore_solid_clear(&filled);
  spore_outer_wall_clear(&wall);
  if (!done) spore_solid_clear(solid);
  return done;
}

/* Voxels of the ends that were asked for. */
static bool find_ends(const SporeVoxelTube *tube, const SporeCentrelineOptions *options, uint32_t ends[2],
                      SporeError *error) {
  for (int i = 0; i < 2; i++) {
    SporeVec3 end = spore_vec3_load(options->ends[i]);
    if (!spore_vec3_is_finite(end))
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("end %d is no place; three numbers in metres were expected; correct them"), i + 1);
    ends[i] = spore_voxel_nearest(tube, end);
    double distance = spore_vec3_distance(end, spore_voxel_middle(tube, ends[i]));
    if (distance > BESIDE * tube->edge)
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("end %d (%g %g %g) lies %g m outside of the organ or in a piece that does not hang "
                               "together with the largest; a place in it, in metres, was expected; move it"),
                             i + 1, end.x, end.y, end.z, distance);
  }
  if (ends[0] != ends[1]) return true;
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("the two ends lie in the same place; two ends of a tube were expected; move one of them"));
}

static bool refuse_shape(const SporeCentrelineOptions *options, const SporeCentrelineReport *report, double volume,
                         SporeError *error) {
  double diameter = 2 * sqrt(report->share * volume / (M_PI * report->length)), slender = report->length / diameter;
  if (options->ends_given) return true;
  if (slender < LEAST_SLENDER)
    return spore_error_set(
        error, SPORE_ERROR_INPUT, NULL,
        _("this is not a tube: its longest way inside is %g m, %.1f times its mean diameter; at least "
          "%g times was expected; give two ends, or make spheres or tetrahedra of it"),
        report->length, slender, LEAST_SLENDER);
  if (report->cover >= LEAST_COVER && report->offset <= MOST_OFFSET) return true;
  return spore_error_set(
      error, SPORE_ERROR_INPUT, NULL,
      _("this is not a tube: %.0f %% of it lies around its longest way inside, which runs %.2f radii "
        "off the middle of its sections; it is flat, or has many branches; give two ends, or make "
        "spheres or tetrahedra of it"),
      100 * report->cover, report->offset);
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

static bool find(const SporeSolid *solid, const SporeCentrelineOptions *options, SporeCurve *curve,
                 SporeCentrelineReport *report, const SporeProgress *progress, SporeError *error) {
  SporeVoxelTube tube;
  SporeVoxelPath path = {0};
  SporeCurve dense = {0};
  uint32_t ends[2];
  SporeProgressPart filling = {progress, 0.3, 0.2}, finding = {progress, 0.5, 0.2}, refining = {progress, 0.7, 0.3};
  if (!spore_voxel_tube_create(&tube, solid, &filling, error)) return false;
  report->components = tube.component_count;
  report->share = tube.share;
  bool done = (!options->ends_given || find_ends(&tube, options, ends, error)) &&
              spore_voxel_path_find(&path, &tube, options->ends_given ? ends : NULL, report, &finding, error) &&
              spore_centreline_refine(solid, &tube, &path, options, &dense, &refining, error);
  if (done) {
    spore_centreline_figures(solid, &dense, report);
    place_branches(&dense, report);
    done = refuse_shape(options, report, solid->volume, error) && spore_centreline_thin(&dense, options, curve, error);
  }
  if (done && progress && progress->show) progress->show(progress->data, curve->points, curve->count);
  spore_curve_clear(&dense);
  spore_voxel_path_clear(&path);
  spore_voxel_tube_clear(&tube);
  return done;
}

bool spore_centreline_from_mesh(const SporeTriangleMesh *mesh, const SporeCentrelineOptions *options, SporeCurve *curve,
                                SporeCentrelineReport *report, const SporeProgress *progress, SporeError *error) {
  uint64_t start = spore_clock_ns();
  SporeSolid solid;
  SporeProgressPart looking = {progress, 0, 0.3};
  *curve = (SporeCurve){0};
  *report = (SporeCentrelineReport){0};
  if (!check_options(options, error) || !make_solid(&solid, mesh, NULL, &report->inner_wall, &looking, error))
    return false;
  bool done = find(&solid, options, curve, report, progress, error);
  spore_solid_clear(&solid);
  if (!done) spore_curve_clear(curve);
  report->seconds = (double)(spore_clock_ns() - start) * 1e-9;
  return done;
}

bool spore_centreline_measure(const SporeTriangleMesh *mesh, SporeCurve *curve, SporeCentrelineReport *report,
                              SporeError *error) {
  uint64_t start = spore_clock_ns();
  SporeSolid solid;
  SporeProgressPart none = {NULL, 0, 1};
  *report = (SporeCentrelineReport){0};
  if (!spore_curve_validate(curve, error) || !make_solid(&solid, mesh, curve, &report->inner_wall, &none, error))
    return false;
  spore_centreline_set_radii(&solid, curve);
  spore_centreline_figures(&solid, curve, report);
  spore_solid_clear(&solid);
  report->seconds = (double)(spore_clock_ns() - start) * 1e-9;
  return true;
}
