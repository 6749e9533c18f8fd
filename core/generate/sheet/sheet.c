/* From a surface to a patch and its sheet: cutting, parameters, and how many control points it takes. */
#include "core/generate/sheet/sheet.h"

#include <math.h>

#include "core/base/cancel.h"
#include "core/base/memory.h"
#include "core/base/profile.h"
#include "core/base/text.h"
#include "core/generate/common/common.h"
#include "core/generate/sheet/private.h"
#include "core/mesh/common.h"
#include "core/mesh/sheet_parameters.h"

#define CUT 0.1      /* shares of the time that are done when the patch is cut, */
#define LAID_OUT 0.5 /* and laid out */

/* Asks the progress, for functions that ask whether to end. */
typedef struct Asking {
  const SporeProgress *progress;
  bool cancelled;
} Asking;

static bool asked(void *data) {
  Asking *asking = data;
  asking->cancelled = asking->cancelled || !spore_progress(asking->progress, CUT, _("laying out the patch"));
  return asking->cancelled;
}

/* The surface is the patch, unless the surface is closed: then corners are what is missing. */
static bool take_whole(const SporeTriangleMesh *mesh, SporeTriangleMesh *patch, SporeError *error) {
  SporeMeshReport figures;
  if (!spore_triangle_mesh_report(mesh, &figures, error)) return false;
  if (figures.boundary_edges > 0) return spore_triangle_mesh_copy(patch, mesh, error);
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("the surface is closed, and no corners are given; expected four corners, in turn around the "
                           "patch that becomes a sheet; name them"));
}

static bool cut_patch(const SporeTriangleMesh *mesh, const SporeSheetOptions *options, SporeTriangleMesh *patch,
                      SporeSheetReport *report, SporeError *error) {
  SporeSheetCut cut;
  if (!options->corners_given) return take_whole(mesh, patch, error);
  bool good = spore_sheet_cut_create(&cut, mesh, error) && spore_sheet_cut_sides(&cut, options, report, error) &&
              spore_sheet_take_patch(&cut, options, patch, error);
  spore_sheet_cut_clear(&cut);
  return good;
}

/* The places that the sheet has found itself. */
static void take_corners(const SporeSheetFitting *fitting, SporeSheetReport *report) {
  static const double at[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (size_t h = 0; h < 3 * fitting->patch->triangle_count; h++) {
    size_t i = fitting->patch->triangles[h];
    for (int k = 0; k < 4; k++)
      if (fitting->parameters[2 * i] == at[k][0] && fitting->parameters[2 * i + 1] == at[k][1])
        spore_vec3_store(report->corners[k], spore_vec3_load(fitting->patch->vertices + 3 * i));
  }
}

static bool lay_out(SporeSheetFitting *fitting, const SporeSheetOptions *options, SporeSheetReport *report,
                    const SporeProgress *progress, SporeError *error) {
  Asking asking = {progress, false};
  const SporeCancel cancel = {asked, &asking};
  fitting->parameters = SPORE_NEW_ARRAY(double, 2 * fitting->patch->vertex_count);
  if (!fitting->parameters) return spore_generate_no_memory(error);
  const double *corners = options->corners_given ? report->corners[0] : NULL;
  if (spore_sheet_parameters(fitting->patch, corners, fitting->parameters, &cancel, error)) {
    if (!corners) take_corners(fitting, report);
    return true;
  }
  return asking.cancelled ? spore_progress_step(progress, CUT, NULL, error) : false;
}

/* Mean length of the sides along u (way 0) and along v: of the edges of the patch that lie on them. */
static void side_lengths(const SporeSheetFitting *fitting, double length[2]) {
  const SporeTriangleMesh *patch = fitting->patch;
  length[0] = length[1] = 0;
  for (size_t h = 0; h < 3 * patch->triangle_count; h++) {
    size_t a = patch->triangles[h], b = patch->triangles[h % 3 == 2 ? h - 2 : h + 1];
    const double *from = fitting->parameters + 2 * a, *to = fitting->parameters + 2 * b;
    for (int way = 0; way < 2; way++) {
      double level = from[1 - way];
      if (level == to[1 - way] && (level == 0 || level == 1))
        length[way] += 0.5 * spore_vec3_distance(spore_vec3_load(patch->vertices + 3 * a),
                                                 spore_vec3_load(patch->vertices + 3 * b));
    }
  }
}

/* As many control points along v as their distance along u allows. */
static void share_points(const double length[2], size_t count, size_t points[2]) {
  double across = round((double)(count - 1) * length[1] / length[0]) + 1;
  points[0] = count;
  points[1] = (size_t)fmin(fmax(across, SPORE_SHEET_LEAST_POINTS), (double)count);
}

static double worst(const SporeSheetReport *report) { return fmax(report->largest[0], report->largest[1]); }

/* The fewest control points that reach the tolerance: twice as many until they do, and then between. Where none do, the
 * number with the least error. */
static bool search(SporeSheetFitting *fitting, const SporeSheetOptions *options, const double length[2], size_t *count,
                   SporeError *error) {
  size_t low = SPORE_SHEET_LEAST_POINTS - 1, high = 0, best = SPORE_SHEET_LEAST_POINTS, points[2];
  double least = HUGE_VAL;
  for (size_t next = SPORE_SHEET_LEAST_POINTS, round = 0; next > low && next != high; round++) {
    SporeSheetReport tried;
    fitting->done = LAID_OUT + (1 - LAID_OUT) * (1 - pow(0.8, (double)round));
    if (!spore_progress_step(fitting->progress, fitting->done, _("choosing control points"), error)) return false;
    share_points(length, next, points);
    if (!spore_sheet_measure(fitting, points, NULL, &tried, error)) return false;
    if (worst(&tried) < least) least = worst(&tried), best = next;
    if (worst(&tried) <= options->tolerance) high = next;
    else low = next;
    next = high ? (low + high + 1) / 2 : 2 * next < SPORE_SHEET_MOST_POINTS ? 2 * next : SPORE_SHEET_MOST_POINTS;
  }
  *count = high ? high : best;
  return true;
}

static bool fit(SporeSheetFitting *fitting, const SporeSheetOptions *options, double *distance,
                SporeSheetReport *report, SporeError *error) {
  double length[2];
  size_t count = options->control_points, points[2];
  fitting->done = LAID_OUT;
  fitting->bvh = spore_bvh_create(fitting->patch, error);
  if (!fitting->bvh || !spore_progress_step(fitting->progress, LAID_OUT, _("fitting the sheet"), error)) return false;
  side_lengths(fitting, length);
  if (!count && !search(fitting, options, length, &count, error)) return false;
  share_points(length, count, points);
  if (!spore_sheet_measure(fitting, points, distance, report, error)) return false;
  report->diagonal = spore_mesh_diagonal(fitting->patch->vertices, fitting->patch->vertex_count, 3);
  report->reached = options->control_points || worst(report) <= options->tolerance;
  return spore_progress_step(fitting->progress, 1, NULL, error);
}

static bool check(const SporeSheetOptions *options, SporeError *error) {
  size_t count = options->control_points;
  if (count ? count >= SPORE_SHEET_LEAST_POINTS && count <= SPORE_SHEET_MOST_POINTS : options->tolerance > 0)
    return true;
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("neither the number of control points nor a tolerance is known; expected %d to %d of them, "
                           "or a distance in metres above 0; give one of the two"),
                         SPORE_SHEET_LEAST_POINTS, SPORE_SHEET_MOST_POINTS);
}

bool spore_sheet_from_mesh(const SporeTriangleMesh *mesh, const SporeSheetOptions *options, SporeTriangleMesh *patch,
                           double **distance, SporeSheetReport *report, const SporeProgress *progress,
                           SporeError *error) {
  uint64_t start = spore_clock_ns();
  SporeSheetFitting fitting = {.patch = patch, .smoothing = options->smoothing, .progress = progress};
  double *off = NULL;
  *patch = (SporeTriangleMesh){0}, *report = (SporeSheetReport){0};
  bool good = check(options, error) && spore_progress_step(progress, 0, _("cutting out the patch"), error) &&
              cut_patch(mesh, options, patch, report, error) && lay_out(&fitting, options, report, progress, error);
  if (good && distance) {
    off = SPORE_NEW_ARRAY(double, patch->vertex_count);
    good = off || spore_generate_no_memory(error);
  }
  good = good && fit(&fitting, options, off, report, error);
  report->seconds = 1e-9 * (double)(spore_clock_ns() - start);
  spore_free(fitting.parameters);
  spore_bvh_free(fitting.bvh);
  if (good && distance) *distance = off;
  else spore_free(off);
  if (!good) spore_triangle_mesh_clear(patch);
  return good;
}
