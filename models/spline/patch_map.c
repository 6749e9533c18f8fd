/* Points that follow a sheet, and samples of the sheet. */
#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/math/spline_sheet.h"
#include "models/spline/offset_weights.h"
#include "models/spline/patch.h"
#include "models/spline/spline.h"

#define SIDE 8              /* control points of a row each way, at most */
#define WIDTH (SIDE * SIDE) /* in all */
#define ROUNDING 1e-14      /* of the sheet's size: an offset that is none */
#define FLAT 1e-6           /* of the sheet's size: an offset that a flat sheet may drop */
#define SAMPLES 4           /* a span, to begin the search for the nearest */

typedef struct Sheet {
  SporeSplineSheet spline;
  double size, drop; /* m: an offset that may be dropped */
  double *sample;    /* (SAMPLES span + 1) each way, x 3 */
} Sheet;

static size_t sample_count(const Sheet *sheet) {
  return (SAMPLES * sheet->spline.span[0] + 1) * (SAMPLES * sheet->spline.span[1] + 1);
}

static void take_samples(Sheet *sheet) {
  double *to = sheet->sample;
  for (size_t j = 0; j <= SAMPLES * sheet->spline.span[1]; j++)
    for (size_t i = 0; i <= SAMPLES * sheet->spline.span[0]; i++, to += 3) {
      SporeSheetPlace place =
          spore_spline_sheet_place(&sheet->spline, (const double[2]){(double)i / SAMPLES, (double)j / SAMPLES});
      spore_vec3_store(to, spore_spline_sheet_point(&sheet->spline, &place, 0));
    }
}

static SporeSheetPlace nearest(const Sheet *sheet, SporeVec3 p) {
  double least = HUGE_VAL, at[2] = {0, 0};
  const double *sample = sheet->sample;
  for (size_t j = 0; j <= SAMPLES * sheet->spline.span[1]; j++)
    for (size_t i = 0; i <= SAMPLES * sheet->spline.span[0]; i++, sample += 3) {
      double distance = spore_vec3_distance(p, spore_vec3_load(sample));
      if (distance < least) least = distance, at[0] = (double)i / SAMPLES, at[1] = (double)j / SAMPLES;
    }
  for (int round = 0; round < 20; round++) spore_spline_sheet_approach(&sheet->spline, p, at);
  return spore_spline_sheet_place(&sheet->spline, at);
}

typedef struct Row {
  size_t used;
  uint32_t block[WIDTH];
  double weight[WIDTH], point[3 * WIDTH];
} Row;

/* The place's weights among side x side control points around it, as far as there are so many. */
static void begin_row(const Sheet *sheet, const SporeSheetPlace *place, size_t side, Row *row) {
  size_t first[2], count[2];
  for (int e = 0; e < 2; e++) {
    size_t nodes = sheet->spline.span[e] + 3, before;
    count[e] = side < nodes ? side : nodes, before = (count[e] - 4) / 2;
    first[e] = place->first[e] < before ? 0 : place->first[e] - before;
    if (first[e] + count[e] > nodes) first[e] = nodes - count[e];
  }
  row->used = count[0] * count[1];
  for (size_t n = 0; n < row->used; n++) {
    size_t i = first[0] + n % count[0], j = first[1] + n / count[0];
    size_t x = i - place->first[0], y = j - place->first[1]; /* beyond 3 also where it is less than 0 */
    row->block[n] = (uint32_t)(j * (sheet->spline.span[0] + 3) + i);
    row->weight[n] = x < 4 && y < 4 ? place->weight[0][4 * y + x] : 0;
    memcpy(row->point + 3 * n, sheet->spline.control + 3 * (size_t)row->block[n], 3 * sizeof *row->point);
  }
}

/* From where the row puts the point to p. */
static SporeVec3 missing(const Row *row, SporeVec3 p) {
  for (size_t n = 0; n < row->used; n++)
    p = spore_vec3_add_scaled(p, -row->weight[n], spore_vec3_load(row->point + 3 * n));
  return p;
}

static bool map_point(const Sheet *sheet, const double *point, size_t index, Row *row, SporeError *error) {
  SporeVec3 p = spore_vec3_load(point);
  SporeSheetPlace place = nearest(sheet, p);
  double off = spore_vec3_distance(p, spore_spline_sheet_point(&sheet->spline, &place, 0)),
         nothing = ROUNDING * sheet->size, work[WIDTH];
  size_t most = sheet->spline.span[0] > sheet->spline.span[1] ? sheet->spline.span[0] + 3 : sheet->spline.span[1] + 3;
  for (size_t side = 4; side <= SIDE; side += 2) {
    bool last = side + 2 > SIDE || side >= most;
    begin_row(sheet, &place, side, row);
    if (off <= nothing) return true;
    double sum = spore_offset_weights(row->point, row->used, missing(row, p), nothing, row->weight, work);
    if (sum <= SPORE_OFFSET_WEIGHTS_LIGHT || (last && sum <= SPORE_OFFSET_WEIGHTS_MOST && off > sheet->drop)) {
      spore_offset_weights(row->point, row->used, missing(row, p), nothing, row->weight, work); /* what rounding took */
      return true;
    }
    if (last) break;
  }
  begin_row(sheet, &place, 4, row);
  if (off <= sheet->drop) return true;
  char text[64];
  snprintf(text, sizeof text, "point %zu", index);
  return spore_error_set(error, SPORE_ERROR_INPUT, text,
                         _("the point lies %g m off a flat sheet, which cannot carry it; points of a flat sheet must "
                           "lie in it; move spheres and visual vertices onto the sheet, or use tetrahedra"),
                         off);
}

static bool map_points(Sheet *sheet, const double *points, size_t count, const SporeCancel *cancel, uint32_t *blocks,
                       double *weights, SporeError *error) {
  take_samples(sheet);
  for (size_t i = 0; i < count; i++) {
    Row row;
    if (!spore_mapping_goes_on(cancel, error) || !map_point(sheet, points + 3 * i, i, &row, error)) return false;
    for (size_t n = 0; n < WIDTH; n++) {
      blocks[WIDTH * i + n] = row.block[n < row.used ? n : 0];
      weights[WIDTH * i + n] = n < row.used ? row.weight[n] : 0;
    }
  }
  return true;
}

bool spore_patch_map(size_t span_u, size_t span_v, const double *control, const double *points, size_t count,
                     const SporeCancel *cancel, double slack, SporeMapping *mapping, SporeError *error) {
  assert(count == 0 || points);
  assert(slack >= 0);
  Sheet sheet = {{{span_u, span_v}, control}, spore_points_size(control, (span_u + 3) * (span_v + 3)), 0, NULL};
  sheet.drop = fmax(FLAT * sheet.size, slack);
  sheet.sample = SPORE_NEW_ARRAY(double, 3 * sample_count(&sheet));
  uint32_t *blocks = SPORE_NEW_ARRAY(uint32_t, WIDTH * count);
  double *weights = SPORE_NEW_ARRAY(double, WIDTH *count);
  bool good = sheet.sample && blocks && weights;
  if (!good) spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for %zu points"), count);
  good = good && map_points(&sheet, points, count, cancel, blocks, weights, error) &&
         spore_mapping_init_linear(mapping, count, WIDTH, blocks, weights, error);
  spore_free(sheet.sample);
  spore_free(blocks);
  spore_free(weights);
  return good;
}

bool spore_patch_sample(size_t span_u, size_t span_v, const double *control, double **points, size_t *count) {
  Sheet sheet = {.spline = {{span_u, span_v}, control}};
  *count = sample_count(&sheet);
  *points = sheet.sample = SPORE_NEW_ARRAY(double, 3 * *count);
  if (sheet.sample) take_samples(&sheet);
  return sheet.sample != NULL;
}
