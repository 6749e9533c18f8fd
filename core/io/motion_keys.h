/* Key frames of a motion: as few as keep what lies between two keys, moved along straight lines, within a bound of
 * where it was. */
#ifndef SPORE_IO_MOTION_KEYS_H
#define SPORE_IO_MOTION_KEYS_H

#include <glib.h>

typedef struct SporeMotionKeys {
  gsize count;     /* points */
  double bound;    /* m */
  double error;    /* m: the farthest that any frame so far is from the straight line between its keys */
  GArray *times;   /* double, s, of the keys */
  GPtrArray *keys; /* float[3 count], m; the first and the last frame are keys */
  GArray *waiting_times;
  GPtrArray *waiting; /* frames since the last key; private */
} SporeMotionKeys;

/* An empty motion of `count` points. */
void spore_motion_keys_init(SporeMotionKeys *motion, gsize count, double bound);
void spore_motion_keys_clear(SporeMotionKeys *motion);
/* Adds the next frame. positions: count x 3, m; times rise. */
void spore_motion_keys_add(SporeMotionKeys *motion, double time_s, const double *positions);
/* To be called after the last frame. A motion in which nothing moves keeps one key. */
void spore_motion_keys_end(SporeMotionKeys *motion);

#endif
