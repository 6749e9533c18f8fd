/* How near a sheet of splines is to its patch. */
#include <math.h>

#include "core/base/memory.h"
#include "core/generate/common/common.h"
#include "core/generate/sheet/private.h"
#include "core/math/spline_sheet.h"
#include "core/mesh/common.h"
#include "core/mesh/sheet_fit.h"

#define SAMPLES 4    /* points of the sheet a span, each way */
#define ROUNDS 12    /* at most, to the nearest place on the sheet */
#define SETTLED 1e-6 /* spans */
#define ASKED 1024   /* places, between questions whether to go on */

/* Squares of distances, weighed by area. */
typedef struct Sum {
  double square, area, largest;
} Sum;

static void add(Sum *sum, double distance, double area) {
  sum->square += area * distance * distance;
  sum->area += area;
  sum->largest = fmax(sum->largest, distance);
}

/* Asked at each i-th of many places. */
static bool goes_on(const SporeSheetFitting *fitting, size_t i) {
  return i % ASKED != 0 || spore_progress(fitting->progress, fitting->done, NULL);
}

static double mean(const Sum *sum) { return sqrt(sum->square / sum->area); }

/* Distance of a point from the sheet, near the place of these parameters (0 to 1); *place: there. */
static double to_sheet(const SporeSplineSheet *sheet, SporeVec3 p, double u, double v, SporeSheetPlace *place) {
  double at[2] = {u * (double)sheet->span[0], v * (double)sheet->span[1]};
  for (int round = 0; round < ROUNDS; round++)
    if (spore_spline_sheet_approach(sheet, p, at) < SETTLED) break;
  *place = spore_spline_sheet_place(sheet, at);
  return spore_vec3_distance(p, spore_spline_sheet_point(sheet, place, 0));
}

static SporeVec3 normal_at(const SporeSplineSheet *sheet, const SporeSheetPlace *place) {
  return spore_vec3_cross(spore_spline_sheet_point(sheet, place, 1), spore_spline_sheet_point(sheet, place, 2));
}

static bool measure_vertices(const SporeSheetFitting *fitting, const SporeSplineSheet *sheet, const double *share,
                             double *distance, Sum *sum) {
  const SporeTriangleMesh *patch = fitting->patch;
  SporeSheetPlace place;
  for (size_t i = 0; i < patch->vertex_count; i++) {
    if (!goes_on(fitting, i)) return false;
    const double *at = fitting->parameters + 2 * i;
    double off = to_sheet(sheet, spore_vec3_load(patch->vertices + 3 * i), at[0], at[1], &place);
    add(sum, off, share[i]);
    if (distance) distance[i] = off;
  }
  return true;
}

/* The middles of the triangles: how far they are, and whether the sheet faces the same way there. */
static bool measure_triangles(const SporeSheetFitting *fitting, const SporeSplineSheet *sheet, Sum *sum,
                              size_t *fold_overs) {
  const SporeTriangleMesh *patch = fitting->patch;
  SporeSheetPlace place;
  size_t facing[2] = {0, 0};
  for (size_t t = 0; t < patch->triangle_count; t++) {
    if (!goes_on(fitting, t)) return false;
    SporeVec3 corner[3], middle = {0, 0, 0};
    double u = 0, v = 0;
    for (size_t k = 0; k < 3; k++) {
      size_t i = patch->triangles[3 * t + k];
      corner[k] = spore_vec3_load(patch->vertices + 3 * i);
      middle = spore_vec3_add_scaled(middle, 1.0 / 3, corner[k]);
      u += fitting->parameters[2 * i] / 3, v += fitting->parameters[2 * i + 1] / 3;
    }
    SporeVec3 area = spore_mesh_area_vector(corner[0], corner[1], corner[2]);
    add(sum, to_sheet(sheet, middle, u, v, &place), spore_vec3_length(area));
    double along = spore_vec3_dot(area, normal_at(sheet, &place));
    facing[1] += along >= 0, facing[0] += along <= 0;
  }
  *fold_overs = facing[0] < facing[1] ? facing[0] : facing[1]; /* u and v may go around the patch either way */
  return true;
}

/* Points of the sheet, in the middles of SAMPLES parts of each span both ways. The sum's area is that of the sheet,
 * m^2. */
static bool measure_sheet(const SporeSheetFitting *fitting, const SporeSplineSheet *sheet, Sum *sum) {
  for (size_t j = 0; j < SAMPLES * sheet->span[1]; j++)
    for (size_t i = 0; i < SAMPLES * sheet->span[0]; i++) {
      if (!goes_on(fitting, j * SAMPLES * sheet->span[0] + i)) return false;
      const double at[2] = {((double)i + 0.5) / SAMPLES, ((double)j + 0.5) / SAMPLES};
      SporeSheetPlace place = spore_spline_sheet_place(sheet, at);
      double off = spore_bvh_distance(fitting->bvh, spore_spline_sheet_point(sheet, &place, 0), NULL, NULL);
      add(sum, off, spore_vec3_length(normal_at(sheet, &place)) / (SAMPLES * SAMPLES));
    }
  return true;
}

static bool measure_all(const SporeSheetFitting *fitting, const SporeSplineSheet *sheet, double *share,
                        double *distance, SporeSheetReport *report) {
  Sum of_patch = {0}, of_sheet = {0};
  report->area = spore_triangle_mesh_share_area(fitting->patch, share);
  if (!measure_vertices(fitting, sheet, share, distance, &of_patch) ||
      !measure_triangles(fitting, sheet, &of_patch, &report->fold_overs) || !measure_sheet(fitting, sheet, &of_sheet))
    return false;
  report->area_kept = of_sheet.area / report->area;
  report->rms[0] = mean(&of_patch), report->rms[1] = mean(&of_sheet);
  report->largest[0] = of_patch.largest, report->largest[1] = of_sheet.largest;
  report->control_points[0] = sheet->span[0] + 3, report->control_points[1] = sheet->span[1] + 3;
  return true;
}

bool spore_sheet_measure(const SporeSheetFitting *fitting, const size_t points[2], double *distance,
                         SporeSheetReport *report, SporeError *error) {
  double *control = SPORE_NEW_ARRAY(double, 3 * points[0] * points[1]);
  double *share = SPORE_NEW_ARRAY(double, fitting->patch->vertex_count);
  const SporeSplineSheet sheet = {{points[0] - 3, points[1] - 3}, control};
  bool good =
      control && share && spore_sheet_fit(fitting->patch, fitting->parameters, sheet.span, fitting->smoothing, control);
  bool measured = good && measure_all(fitting, &sheet, share, distance, report);
  spore_free(control);
  spore_free(share);
  if (!good) return spore_generate_no_memory(error);
  return measured || spore_progress_step(fitting->progress, fitting->done, NULL, error);
}
