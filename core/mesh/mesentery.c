/* Spreads a mesentery from its root to a bowel. The least sum of squares among places in order is a shortest way,
 * found by dynamic programming (R. Bellman, "Dynamic Programming", 1957), point after point. */
#include "core/mesh/mesentery.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/math/vec3.h"

#define PLACES SPORE_MESENTERY_PLACES

/* The search: places of the root in the order that is tried, and for each point and place the place of the point before
 * it. */
typedef struct Search {
  const double *points, *weight;
  size_t count;
  double place[3 * PLACES];
  uint8_t *before; /* count x PLACES */
} Search;

static void set_places(const SporeCurve *root, double *place) {
  double length = spore_curve_length(root), walked = 0;
  size_t next = 0;
  for (size_t i = 1; i < root->count; i++) {
    SporeVec3 a = spore_vec3_load(root->points + 4 * (i - 1)), b = spore_vec3_load(root->points + 4 * i);
    double piece = spore_vec3_distance(a, b);
    for (; next < PLACES && (double)next / (PLACES - 1) * length <= walked + piece; next++) {
      double part = piece > 0 ? ((double)next / (PLACES - 1) * length - walked) / piece : 0;
      spore_vec3_store(place + 3 * next, spore_vec3_add_scaled(a, part, spore_vec3_sub(b, a)));
    }
    walked += piece;
  }
  for (; next < PLACES; next++) memcpy(place + 3 * next, root->points + 4 * (root->count - 1), 3 * sizeof *place);
}

static void reverse(double *place) {
  for (size_t i = 0, j = PLACES - 1; i < j; i++, j--)
    for (int k = 0; k < 3; k++) {
      double kept = place[3 * i + k];
      place[3 * i + k] = place[3 * j + k];
      place[3 * j + k] = kept;
    }
}

/* Fills `before`, and returns the least sum; *last: the place of the last point. */
static double search(Search *search, size_t *last) {
  double sum[PLACES] = {0};
  for (size_t i = 0; i < search->count; i++) {
    SporeVec3 point = spore_vec3_load(search->points + 3 * i);
    size_t best = 0;
    double least = sum[0];
    for (size_t j = 0; j < PLACES; j++) {
      SporeVec3 away = spore_vec3_sub(point, spore_vec3_load(search->place + 3 * j));
      if (sum[j] < least) least = sum[j], best = j;
      search->before[i * PLACES + j] = (uint8_t)best;
      sum[j] = least + search->weight[i] * spore_vec3_dot(away, away);
    }
  }
  *last = 0;
  for (size_t j = 1; j < PLACES; j++)
    if (sum[j] < sum[*last]) *last = j;
  return sum[*last];
}

/* The place of the straight pieces between the places that is nearest to a point, among those next to place j; as a
 * number of the places. */
static double nearest_beside(const double *place, size_t j, SporeVec3 point) {
  double best = (double)j, least = HUGE_VAL;
  for (size_t from = j > 0 ? j - 1 : j; from <= j && from + 1 < PLACES; from++) {
    SporeVec3 a = spore_vec3_load(place + 3 * from), along = spore_vec3_sub(spore_vec3_load(place + 3 * from + 3), a);
    double square = spore_vec3_dot(along, along);
    double part = square > 0 ? spore_vec3_dot(spore_vec3_sub(point, a), along) / square : 0;
    part = fmin(fmax(part, 0), 1);
    double distance = spore_vec3_distance(point, spore_vec3_add_scaled(a, part, along));
    if (distance < least) least = distance, best = (double)from + part;
  }
  return best;
}

/* From the last point to the first; then each foot goes to the nearest place beside, but not before the foot before. */
static void trace(const Search *search, size_t last, double *feet) {
  double reached = 0;
  for (size_t i = search->count; i-- > 0; last = search->before[i * PLACES + last]) feet[3 * i] = (double)last;
  for (size_t i = 0; i < search->count; i++) {
    double at = nearest_beside(search->place, (size_t)feet[3 * i], spore_vec3_load(search->points + 3 * i));
    reached = fmax(reached, at);
    size_t from = (size_t)fmin(reached, PLACES - 2);
    SporeVec3 a = spore_vec3_load(search->place + 3 * from), b = spore_vec3_load(search->place + 3 * from + 3);
    spore_vec3_store(feet + 3 * i, spore_vec3_add_scaled(a, reached - (double)from, spore_vec3_sub(b, a)));
  }
}

bool spore_mesentery_spread(const SporeCurve *root, const double *points, const double *weight, size_t count,
                            double *feet) {
  assert(count > 0 && root->count > 1);
  Search in = {.points = points, .weight = weight, .count = count, .before = SPORE_NEW_ARRAY(uint8_t, count * PLACES)};
  size_t last, last_back;
  if (!in.before) return false;
  set_places(root, in.place);
  double ahead = search(&in, &last);
  trace(&in, last, feet);
  reverse(in.place);
  if (search(&in, &last_back) < ahead) trace(&in, last_back, feet);
  spore_free(in.before);
  return true;
}
