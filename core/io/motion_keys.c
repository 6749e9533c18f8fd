/* Key frames by an opening window: a frame becomes a key when the next one would leave the bound. */
#include "core/io/motion_keys.h"

#include <math.h>
#include <string.h>

#define WINDOW 48 /* frames that wait at most: what they take is bounded, and so is the work for each */

void spore_motion_keys_init(SporeMotionKeys *motion, gsize count, double bound) {
  *motion = (SporeMotionKeys){.count = count, .bound = bound};
  motion->times = g_array_new(FALSE, FALSE, sizeof(double));
  motion->waiting_times = g_array_new(FALSE, FALSE, sizeof(double));
  motion->keys = g_ptr_array_new_with_free_func(g_free);
  motion->waiting = g_ptr_array_new_with_free_func(g_free);
}

void spore_motion_keys_clear(SporeMotionKeys *motion) {
  g_array_unref(motion->times);
  g_array_unref(motion->waiting_times);
  g_ptr_array_unref(motion->keys);
  g_ptr_array_unref(motion->waiting);
}

static double time_of(const GArray *times, guint i) { return g_array_index(times, double, i); }

/* The square of the farthest that a point of `frame` is from a part of the way between two frames. */
static double farthest(const float *from, const float *to, double part, const float *frame, gsize count) {
  double most = 0;
  for (gsize i = 0; i < 3 * count; i += 3) {
    double square = 0;
    for (gsize k = i; k < i + 3; k++) {
      double off = (double)from[k] + part * ((double)to[k] - (double)from[k]) - (double)frame[k];
      square += off * off;
    }
    most = fmax(most, square);
  }
  return most;
}

/* The farthest, m, that the first `count` waiting frames are from the line between the last key and `to`. */
static double error_to(const SporeMotionKeys *motion, const float *to, double time_s, guint count) {
  const float *from = motion->keys->pdata[motion->keys->len - 1];
  double begin = time_of(motion->times, motion->times->len - 1), most = 0;
  for (guint i = 0; i < count; i++) {
    double part = (time_of(motion->waiting_times, i) - begin) / (time_s - begin);
    most = fmax(most, farthest(from, to, part, motion->waiting->pdata[i], motion->count));
  }
  return sqrt(most);
}

static void add_key(SporeMotionKeys *motion, float *frame, double time_s) {
  g_ptr_array_add(motion->keys, frame);
  g_array_append_val(motion->times, time_s);
}

/* The last frame that waits becomes a key, and none waits any more. */
static void take_last(SporeMotionKeys *motion) {
  guint last = motion->waiting->len - 1;
  double time_s = time_of(motion->waiting_times, last);
  float *frame = motion->waiting->pdata[last];
  motion->error = fmax(motion->error, error_to(motion, frame, time_s, last));
  motion->waiting->pdata[last] = NULL; /* the keys own it now */
  add_key(motion, frame, time_s);
  g_ptr_array_set_size(motion->waiting, 0);
  g_array_set_size(motion->waiting_times, 0);
}

void spore_motion_keys_add(SporeMotionKeys *motion, double time_s, const double *positions) {
  float *frame = g_new(float, 3 * motion->count + 1);
  for (gsize i = 0; i < 3 * motion->count; i++) frame[i] = (float)positions[i];
  if (!motion->keys->len) {
    add_key(motion, frame, time_s);
    return;
  }
  guint waiting = motion->waiting->len;
  if (waiting && (waiting == WINDOW || error_to(motion, frame, time_s, waiting) > motion->bound)) take_last(motion);
  g_ptr_array_add(motion->waiting, frame);
  g_array_append_val(motion->waiting_times, time_s);
}

void spore_motion_keys_end(SporeMotionKeys *motion) {
  if (motion->waiting->len) take_last(motion);
  const float *first = motion->keys->len ? motion->keys->pdata[0] : NULL;
  for (guint i = 1; i < motion->keys->len; i++)
    if (memcmp(first, motion->keys->pdata[i], 3 * motion->count * sizeof *first) != 0) return;
  g_ptr_array_set_size(motion->keys, MIN(motion->keys->len, 1));
  g_array_set_size(motion->times, motion->keys->len);
}
