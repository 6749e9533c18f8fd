/* Points that follow a sheet, and samples of the sheet. */
#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/spline/offset_weights.h"
#include "models/spline/patch.h"
#include "models/spline/spline.h"

#define SIDE 8              /* control points of a row each way, at most */
#define WIDTH (SIDE * SIDE) /* in all */
#define ROUNDING 1e-14      /* of the sheet's size: an offset that is none */
#define FLAT 1e-6           /* of the sheet's size: an offset that a flat sheet may drop */
#define SAMPLES 4           /* a span, to begin the search for the nearest */

typedef struct Sheet {
  size_t span[2];
  const double *control;
  double size, drop; /* m: an offset that may be dropped */
  double *sample;    /* (SAMPLES span + 1) each way, x 3 */
} Sheet;

/* The sixteen weights of a point, and those of its derivatives by u, v, uu, vv, uv. */
typedef struct Place {
  size_t first[2];
  double weight[6][16];
} Place;

static Place place_at(const Sheet *sheet, const double at[2]) {
  Place place;
  SporeSplineBasis x = spore_spline_basis(spore_spline_uniform(sheet->span[0]), at[0], &place.first[0]);
  SporeSplineBasis y = spore_spline_basis(spore_spline_uniform(sheet->span[1]), at[1], &place.first[1]);
  const double *factor[6][2] = {{x.value, y.value},  {x.first, y.value},  {x.value, y.first},
                                {x.second, y.value}, {x.value, y.second}, {x.first, y.first}};
  for (int d = 0; d < 6; d++)
    for (size_t k = 0; k < 16; k++) place.weight[d][k] = factor[d][0][k % 4] * factor[d][1][k / 4];
  return place;
}

static SporeVec3 combine(const Sheet *sheet, const Place *place, int derivative) {
  SporeVec3 sum = {0, 0, 0};
  for (size_t k = 0; k < 16; k++) {
    size_t node = (place->first[1] + k / 4) * (sheet->span[0] + 3) + place->first[0] + k % 4;
    sum = spore_vec3_add_scaled(sum, place->weight[derivative][k], spore_vec3_load(sheet->control + 3 * node));
  }
  return sum;
}

static size_t sample_count(const Sheet *sheet) {
  return (SAMPLES * sheet->span[0] + 1) * (SAMPLES * sheet->span[1] + 1);
}

static void take_samples(Sheet *sheet) {
  double *to = sheet->sample;
  for (size_t j = 0; j <= SAMPLES * sheet->span[1]; j++)
    for (size_t i = 0; i <= SAMPLES * sheet->span[0]; i++, to += 3) {
      Place place = place_at(sheet, (const double[2]){(double)i / SAMPLES, (double)j / SAMPLES});
      spore_vec3_store(to, combine(sheet, &place, 0));
    }
}

/* One step of Newton's method for the nearest point; where the square of the distance is not convex, of Gauss's. */
static void approach(const Sheet *sheet, SporeVec3 p, double at[2]) {
  Place place = place_at(sheet, at);
  SporeVec3 off = spore_vec3_sub(combine(sheet, &place, 0), p), u = combine(sheet, &place, 1),
            v = combine(sheet, &place, 2);
  double uu = spore_vec3_dot(u, u), vv = spore_vec3_dot(v, v), uv = spore_vec3_dot(u, v);
  double bent[3], slope[2] = {spore_vec3_dot(off, u), spore_vec3_dot(off, v)};
  for (int k = 0; k < 3; k++) bent[k] = spore_vec3_dot(off, combine(sheet, &place, 3 + k));
  double full = (uu + bent[0]) * (vv + bent[1]) - (uv + bent[2]) * (uv + bent[2]);
  if (uu + bent[0] > 0.5 * uu && full > 0.25 * (uu * vv - uv * uv)) uu += bent[0], vv += bent[1], uv += bent[2];
  bool held[2];
  for (int e = 0; e < 2; e++)
    held[e] = (at[e] <= 0 && slope[e] > 0) || (at[e] >= (double)sheet->span[e] && slope[e] < 0);
  if (held[0] || held[1]) uv = 0;
  double determinant = uu * vv - uv * uv;
  double change[2] = {(uv * slope[1] - vv * slope[0]) / determinant, (uv * slope[0] - uu * slope[1]) / determinant};
  for (int e = 0; e < 2; e++)
    if (!held[e]) at[e] = fmin(fmax(at[e] + fmin(fmax(change[e], -0.5), 0.5), 0), (double)sheet->span[e]);
}

static Place nearest(const Sheet *sheet, SporeVec3 p) {
  double least = HUGE_VAL, at[2] = {0, 0};
  const double *sample = sheet->sample;
  for (size_t j = 0; j <= SAMPLES * sheet->span[1]; j++)
    for (size_t i = 0; i <= SAMPLES * sheet->span[0]; i++, sample += 3) {
      double distance = spore_vec3_distance(p, spore_vec3_load(sample));
      if (distance < least) least = distance, at[0] = (double)i / SAMPLES, at[1] = (double)j / SAMPLES;
    }
  for (int round = 0; round < 20; round++) approach(sheet, p, at);
  return place_at(sheet, at);
}

typedef struct Row {
  size_t used;
  uint32_t block[WIDTH];
  double weight[WIDTH], point[3 * WIDTH];
} Row;

/* The place's weights among side x side control points around it, as far as there are so many. */
static void begin_row(const Sheet *sheet, const Place *place, size_t side, Row *row) {
  size_t first[2], count[2];
  for (int e = 0; e < 2; e++) {
    size_t nodes = sheet->span[e] + 3, before;
    count[e] = side < nodes ? side : nodes, before = (count[e] - 4) / 2;
    first[e] = place->first[e] < before ? 0 : place->first[e] - before;
    if (first[e] + count[e] > nodes) first[e] = nodes - count[e];
  }
  row->used = count[0] * count[1];
  for (size_t n = 0; n < row->used; n++) {
    size_t i = first[0] + n % count[0], j = first[1] + n / count[0];
    size_t x = i - place->first[0], y = j - place->first[1]; /* beyond 3 also where it is less than 0 */
    row->block[n] = (uint32_t)(j * (sheet->span[0] + 3) + i);
    row->weight[n] = x < 4 && y < 4 ? place->weight[0][4 * y + x] : 0;
    memcpy(row->point + 3 * n, sheet->control + 3 * (size_t)row->block[n], 3 * sizeof *row->point);
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
  Place place = nearest(sheet, p);
  double off = spore_vec3_distance(p, combine(sheet, &place, 0)), nothing = ROUNDING * sheet->size, work[WIDTH];
  size_t most = sheet->span[0] > sheet->span[1] ? sheet->span[0] + 3 : sheet->span[1] + 3;
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
  Sheet sheet = {{span_u, span_v}, control, spore_points_size(control, (span_u + 3) * (span_v + 3)), 0, NULL};
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
  Sheet sheet = {.span = {span_u, span_v}, .control = control};
  *count = sample_count(&sheet);
  *points = sheet.sample = SPORE_NEW_ARRAY(double, 3 * *count);
  if (sheet.sample) take_samples(&sheet);
  return sheet.sample != NULL;
}
