/* Axis-aligned boxes. Private to core/collide. */
#ifndef SPORE_COLLIDE_BOUNDS_H
#define SPORE_COLLIDE_BOUNDS_H

#include <assert.h>
#include <math.h>
#include <stdbool.h>

typedef struct SporeBounds {
  double lower[3], upper[3]; /* m; lower > upper: empty */
} SporeBounds;

#define SPORE_BOUNDS_EMPTY ((SporeBounds){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}})

/* ball: x y z radius */
static inline void spore_bounds_add_ball(SporeBounds *bounds, const double *ball) {
  assert(ball[3] >= 0);
  for (int k = 0; k < 3; k++) {
    double lower = ball[k] - ball[3], upper = ball[k] + ball[3];
    if (lower < bounds->lower[k]) bounds->lower[k] = lower;
    if (upper > bounds->upper[k]) bounds->upper[k] = upper;
  }
}

static inline bool spore_bounds_touch_ball(const SporeBounds *bounds, const double *ball) {
  assert(ball[3] >= 0);
  for (int k = 0; k < 3; k++)
    if (ball[k] + ball[3] < bounds->lower[k] || ball[k] - ball[3] > bounds->upper[k]) return false;
  return true;
}

static inline bool spore_bounds_touch(const SporeBounds *a, const SporeBounds *b) {
  for (int k = 0; k < 3; k++)
    if (a->upper[k] < b->lower[k] || a->lower[k] > b->upper[k]) return false;
  return true;
}

/* Widens bounds by what a and b, which touch, have in common. */
static inline void spore_bounds_add_common(SporeBounds *bounds, const SporeBounds *a, const SporeBounds *b) {
  assert(spore_bounds_touch(a, b));
  for (int k = 0; k < 3; k++) {
    double lower = a->lower[k] > b->lower[k] ? a->lower[k] : b->lower[k];
    double upper = a->upper[k] < b->upper[k] ? a->upper[k] : b->upper[k];
    if (lower < bounds->lower[k]) bounds->lower[k] = lower;
    if (upper > bounds->upper[k]) bounds->upper[k] = upper;
  }
}

#endif
