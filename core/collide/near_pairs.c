/* Finds near pairs of spheres by sorting them along an axis. */
#include "core/collide/near_pairs.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "core/base/memory.h"
#include "core/math/vec3.h"

/* A sphere to be sorted by its place on the axis; equal places by number. */
typedef struct Sorted {
  double place;
  uint32_t sphere;
} Sorted;

static int by_place(const void *a, const void *b) {
  const Sorted *one = a, *other = b;
  if (one->place != other->place) return one->place < other->place ? -1 : 1;
  return one->sphere < other->sphere ? -1 : one->sphere > other->sphere;
}

static size_t longest_axis(const double *centre, size_t count) {
  size_t longest = 0;
  double most = -1;
  for (size_t k = 0; k < 3; k++) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (size_t i = 0; i < count; i++) low = fmin(low, centre[3 * i + k]), high = fmax(high, centre[3 * i + k]);
    if (high - low > most) most = high - low, longest = k;
  }
  return longest;
}

static Sorted *sort(const double *centre, size_t count) {
  Sorted *sorted = SPORE_NEW_ARRAY(Sorted, count);
  size_t axis = longest_axis(centre, count);
  if (!sorted) return NULL;
  for (size_t i = 0; i < count; i++) sorted[i] = (Sorted){centre[3 * i + axis], (uint32_t)i};
  qsort(sorted, count, sizeof *sorted, by_place);
  return sorted;
}

bool spore_near_pairs(const double *centre, const double *radius, size_t count, double scale, double reach,
                      SporeNearPairFound found, void *data) {
  assert(scale > 0 && reach >= 0);
  double widest = 0;
  for (size_t i = 0; i < count; i++) widest = fmax(widest, radius[i]);
  Sorted *sorted = sort(centre, count);
  bool going = sorted;
  for (size_t i = 0; going && i < count; i++) {
    uint32_t a = sorted[i].sphere;
    double farthest = sorted[i].place + scale * (radius[a] + widest) + reach;
    for (size_t j = i + 1; going && j < count && sorted[j].place < farthest; j++) {
      uint32_t b = sorted[j].sphere;
      double near = scale * (radius[a] + radius[b]) + reach;
      SporeVec3 away = spore_vec3_sub(spore_vec3_load(centre + 3 * a), spore_vec3_load(centre + 3 * b));
      if (spore_vec3_dot(away, away) < near * near) going = a < b ? found(data, a, b) : found(data, b, a);
    }
  }
  spore_free(sorted);
  return going;
}
