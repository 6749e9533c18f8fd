/* Points that follow a line, and samples of the line. */
#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/body/path.h"
#include "models/spline/offset_weights.h"
#include "models/spline/spline.h"

#define WIDTH 16       /* control points of a row, at most */
#define ROUNDING 1e-14 /* of the line's size: an offset that is none */
#define WRITTEN 1e-5   /* of the line's size: an offset that comes of few digits in a file */

typedef struct Spline {
  SporeSplineKnots knots;
  const double *control, *arms;
  double size, slack;
  const double *samples; /* of spore_path_sample, where places are sought */
} Spline;

typedef struct Row {
  size_t used;
  uint32_t block[WIDTH];
  double weight[WIDTH];
} Row;

static SporeVec3 node(const Spline *spline, uint32_t index) {
  assert(index < spline->knots.span_count + 3 || spline->arms);
  size_t count = spline->knots.span_count + 3;
  return spore_vec3_load(index < count ? spline->control + 3 * (size_t)index : spline->arms + 3 * (index - count));
}

/* spore_offset_weights of the row's points. */
static double offset_weights(const Spline *spline, SporeVec3 offset, const Row *row, double *weight) {
  double work[WIDTH], points[3 * WIDTH];
  for (size_t i = 0; i < row->used; i++) spore_vec3_store(points + 3 * i, node(spline, row->block[i]));
  return spore_offset_weights(points, row->used, offset, ROUNDING * spline->size, weight, work);
}

/* From the place that the row gives to p. */
static SporeVec3 missing(const Spline *spline, const Row *row, SporeVec3 p) {
  for (size_t i = 0; i < row->used; i++) p = spore_vec3_add_scaled(p, -row->weight[i], node(spline, row->block[i]));
  return p;
}

/* Control points about the span, `width` of them or all. Returns where the span's begin among them. */
static size_t take_points(const Spline *spline, size_t span, size_t width, Row *row) {
  assert(width >= 4 && span < spline->knots.span_count);
  size_t count = spline->knots.span_count + 3, used = width < count ? width : count, before = (used - 4) / 2;
  size_t first = span < before ? 0 : span - before;
  if (first + used > count) first = count - used;
  *row = (Row){.used = used};
  for (size_t i = 0; i < used; i++) row->block[i] = (uint32_t)(first + i);
  return span - first;
}

/* The control points of the span, and the arms at its knots and at `more` knots before and behind. */
static size_t take_arms(const Spline *spline, size_t span, size_t more, Row *row) {
  assert(spline->arms && span < spline->knots.span_count);
  size_t first = take_points(spline, span, 4, row), from = span > more ? span - more : 0;
  for (size_t knot = from; knot <= span + 1 + more && knot <= spline->knots.span_count; knot++)
    row->block[row->used++] = (uint32_t)(spline->knots.span_count + 3 + knot);
  return first;
}

/* Fills a row that reproduces the offset. False: the points of the row cannot. `last`: there are no more points to
 * try. */
static bool fill_row(const Spline *spline, SporeVec3 p, const SporePathPlace *place, size_t first, bool last,
                     Row *row) {
  SporeVec3 offset = spore_vec3_sub(p, place->position);
  bool on = spore_vec3_length(offset) <= ROUNDING * spline->size;
  double sum = on ? 0 : offset_weights(spline, offset, row, row->weight);
  if (last && sum > SPORE_OFFSET_WEIGHTS_LIGHT && spore_vec3_length(offset) <= spline->slack) {
    memset(row->weight, 0, sizeof row->weight);
    on = true;
    sum = 0;
  }
  if (sum > (last ? SPORE_OFFSET_WEIGHTS_MOST : SPORE_OFFSET_WEIGHTS_LIGHT)) return false;
  for (size_t k = 0; k < 4; k++) row->weight[first + k] += place->weight[k];
  if (!on) offset_weights(spline, missing(spline, row, p), row, row->weight); /* what rounding took */
  for (size_t i = row->used; i < WIDTH; i++) row->block[i] = row->block[0];
  return true;
}

/* Finds a row for the point, whose place on the line is known. False: no row reproduces the point. */
static bool find_row(const Spline *spline, SporeVec3 p, const SporePathPlace *place, Row *row) {
  size_t count = spline->knots.span_count + 3;
  bool last = false;
  for (size_t more = 0; spline->arms && more < 2; more++)
    if (fill_row(spline, p, place, take_arms(spline, place->first, more, row), more > 0, row)) return true;
  for (size_t width = 4; !last; width += 4) {
    last = width + 4 > WIDTH || width >= count;
    if (fill_row(spline, p, place, take_points(spline, place->first, width, row), last, row)) return true;
  }
  return false;
}

/* anchor: NULL, or what the mapping keeps of it. */
static bool map_point(const Spline *spline, const double *point, size_t index, double *anchor, Row *row,
                      SporeError *error) {
  SporeVec3 p = spore_vec3_load(point);
  SporePathPlace place = spore_path_seek(spline->knots, spline->control, spline->samples, p);
  if (anchor) {
    anchor[0] = place.parameter;
    spore_vec3_store(anchor + 1, spore_vec3_sub(p, place.position));
  }
  if (find_row(spline, p, &place, row)) return true;
  char where[64];
  snprintf(where, sizeof where, "point %zu", index);
  return spore_error_set(
      error, SPORE_ERROR_INPUT, where,
      _("the point lies %g m off a line that is too straight there to carry it; points of a straight "
        "thread must lie on it; move spheres and visual vertices onto the line"),
      spore_vec3_distance(p, place.position));
}

static bool give_room(SporeMapping *mapping) {
  uint32_t used = mapping->row_start[mapping->point_count];
  uint32_t *block = spore_reallocate(mapping->block, used, WIDTH * mapping->point_count, sizeof *block);
  if (block) mapping->block = block;
  double *weight = spore_reallocate(mapping->weight, used, WIDTH * mapping->point_count, sizeof *weight);
  if (weight) mapping->weight = weight;
  return (block && weight) || mapping->point_count == 0;
}

void spore_spline_map_follow(SporeSplineKnots knots, const double *control, const double *arms, SporeMapping *mapping) {
  assert(mapping->anchors);
  double size = spore_points_size(control, knots.span_count + 3);
  Spline spline = {knots, control, arms, size, WRITTEN * size, NULL}, onto = spline;
  onto.slack = HUGE_VAL;
  uint32_t filled = 0;
  for (size_t i = 0; i < mapping->point_count; i++) {
    Row row;
    const double *anchor = mapping->anchors + 4 * i;
    SporePathPlace place = spore_path_at(knots, control, anchor[0]);
    SporeVec3 p = spore_vec3_add(place.position, spore_vec3_load(anchor + 1));
    if (!find_row(&spline, p, &place, &row)) find_row(&onto, p, &place, &row); /* what was carried stays somewhere */
    for (size_t k = 0; k < row.used; k++) {
      if (row.weight[k] == 0) continue;
      mapping->block[filled] = row.block[k];
      mapping->weight[filled++] = row.weight[k];
    }
    mapping->row_start[i + 1] = filled;
  }
}

bool spore_spline_map(SporeSplineKnots knots, const double *control, const double *arms, const double *points,
                      size_t count, const SporeCancel *cancel, double slack, bool follows, SporeMapping *mapping,
                      SporeError *error) {
  assert(count == 0 || points);
  assert(slack >= 0);
  double *samples = SPORE_NEW_ARRAY(double, 3 * spore_path_sample_count(knots));
  Spline spline = {knots, control, arms, spore_points_size(control, knots.span_count + 3), slack, samples};
  spline.slack = fmax(slack, WRITTEN * spline.size);
  uint32_t *blocks = SPORE_NEW_ARRAY(uint32_t, WIDTH * count);
  double *weights = SPORE_NEW_ARRAY(double, WIDTH *count);
  double *anchors = follows ? SPORE_NEW_ARRAY(double, 4 * count) : NULL;
  bool good = samples && blocks && weights && (anchors || !follows);
  if (good) spore_path_sample(knots, control, samples);
  else spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for %zu points"), count);
  for (size_t i = 0; good && i < count && (good = spore_mapping_goes_on(cancel, error)); i++) {
    Row row;
    good = map_point(&spline, points + 3 * i, i, anchors ? anchors + 4 * i : NULL, &row, error);
    memcpy(blocks + WIDTH * i, row.block, sizeof row.block);
    memcpy(weights + WIDTH * i, row.weight, sizeof row.weight);
  }
  good = good && spore_mapping_init_linear(mapping, count, WIDTH, blocks, weights, error);
  spore_free(samples);
  spore_free(blocks);
  spore_free(weights);
  if (good && follows && !give_room(mapping)) {
    spore_mapping_clear(mapping);
    good = spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for %zu points"), count);
  }
  if (good) mapping->anchors = anchors;
  else spore_free(anchors);
  return good;
}

double *spore_spline_sample(SporeSplineKnots knots, const double *control, size_t more, size_t *count) {
  *count = SPORE_SPLINE_SAMPLES * knots.span_count + 1;
  double *points = SPORE_NEW_ARRAY(double, 3 * (*count + more));
  for (size_t i = 0; points && i < *count; i++)
    spore_vec3_store(points + 3 * i,
                     spore_path_at(knots, control, spore_spline_part(knots, SPORE_SPLINE_SAMPLES, i)).position);
  return points;
}
