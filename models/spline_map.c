#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/carry.h"
#include "models/spline.h"

#define WIDTH 16       /* control points of a row, at most */
#define ROUNDING 1e-14 /* of the line's size: an offset that is none */
#define SAMPLES 8      /* a span, to begin the search for the nearest */

typedef struct Spline {
  size_t span_count;
  const double *control;
  double size;
} Spline;

static SporeVec3 at(const Spline *spline, const double weight[4], size_t span) {
  SporeVec3 sum = {0, 0, 0};
  for (size_t k = 0; k < 4; k++)
    sum = spore_vec3_add_scaled(sum, weight[k], spore_vec3_load(spline->control + 3 * (span + k)));
  return sum;
}

/* Parameter of the point of the line that is nearest to p: the best of some, then Newton's method. */
static double nearest(const Spline *spline, SporeVec3 p) {
  double best = 0, least = HUGE_VAL;
  size_t span;
  for (size_t i = 0; i <= SAMPLES * spline->span_count; i++) {
    SporeSplineBasis basis = spore_spline_basis(spline->span_count, (double)i / SAMPLES, &span);
    double distance = spore_vec3_distance(p, at(spline, basis.value, span));
    if (distance < least) least = distance, best = (double)i / SAMPLES;
  }
  for (int round = 0; round < 20; round++) {
    SporeSplineBasis basis = spore_spline_basis(spline->span_count, best, &span);
    SporeVec3 off = spore_vec3_sub(at(spline, basis.value, span), p), slope = at(spline, basis.first, span);
    double square = spore_vec3_dot(slope, slope);
    double change =
        -spore_vec3_dot(off, slope) / fmax(square + spore_vec3_dot(off, at(spline, basis.second, span)), 0.5 * square);
    best = fmin(fmax(best + fmin(fmax(change, -0.5), 0.5), 0), (double)spline->span_count);
  }
  return best;
}

typedef struct Row {
  uint32_t block[WIDTH];
  double weight[WIDTH];
} Row;

/* spore_carry_offset of `width` control points from `first`. */
static double carry(const Spline *spline, SporeVec3 offset, size_t first, size_t width, double *weight) {
  double work[WIDTH];
  return spore_carry_offset(spline->control + 3 * first, width, offset, ROUNDING * spline->size, weight, work);
}

/* From where the row puts the point to p. */
static SporeVec3 missing(const Spline *spline, const Row *row, size_t used, SporeVec3 p) {
  for (size_t i = 0; i < used; i++)
    p = spore_vec3_add_scaled(p, -row->weight[i], spore_vec3_load(spline->control + 3 * (size_t)row->block[i]));
  return p;
}

static bool map_point(const Spline *spline, const double *point, size_t index, Row *row, SporeError *error) {
  SporeVec3 p = spore_vec3_load(point);
  size_t span, count = spline->span_count + 3;
  SporeSplineBasis basis = spore_spline_basis(spline->span_count, nearest(spline, p), &span);
  SporeVec3 offset = spore_vec3_sub(p, at(spline, basis.value, span));
  double off = spore_vec3_length(offset);
  for (size_t width = 4; width <= WIDTH; width += 4) {
    size_t used = width < count ? width : count, before = (used - 4) / 2;
    size_t first = span < before ? 0 : span - before;
    if (first + used > count) first = count - used;
    double extra[WIDTH] = {0};
    bool on = off <= ROUNDING * spline->size;
    double sum = on ? 0 : carry(spline, offset, first, used, extra);
    bool last = width + 4 > WIDTH || used == count;
    if (sum > (last ? SPORE_CARRY_AT_MOST : SPORE_CARRY_LIGHT)) {
      if (last) break;
      continue;
    }
    for (size_t i = 0; i < WIDTH; i++) {
      row->block[i] = (uint32_t)(first + (i < used ? i : 0));
      row->weight[i] = i < used ? extra[i] : 0;
    }
    for (size_t k = 0; k < 4; k++) row->weight[span - first + k] += basis.value[k];
    if (!on) carry(spline, missing(spline, row, used, p), first, used, row->weight); /* what rounding took */
    return true;
  }
  char place[64];
  snprintf(place, sizeof place, "point %zu", index);
  return spore_error_set(
      error, SPORE_ERROR_INPUT, place,
      _("the point lies %g m off a line that is too straight there to carry it; points of a straight "
        "thread must lie on it; move spheres and visual vertices onto the line"),
      off);
}

bool spore_spline_map(size_t span_count, const double *control, const double *points, size_t count,
                      SporeMapping *mapping, SporeError *error) {
  Spline spline = {span_count, control, spore_carry_size(control, span_count + 3)};
  uint32_t *blocks = SPORE_NEW_ARRAY(uint32_t, WIDTH * count);
  double *weights = SPORE_NEW_ARRAY(double, WIDTH *count);
  bool good = blocks && weights;
  if (!good) spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for %zu points"), count);
  for (size_t i = 0; good && i < count; i++) {
    Row row;
    good = map_point(&spline, points + 3 * i, i, &row, error);
    memcpy(blocks + WIDTH * i, row.block, sizeof row.block);
    memcpy(weights + WIDTH * i, row.weight, sizeof row.weight);
  }
  good = good && spore_mapping_init_linear(mapping, count, WIDTH, blocks, weights, error);
  spore_free(blocks);
  spore_free(weights);
  return good;
}
