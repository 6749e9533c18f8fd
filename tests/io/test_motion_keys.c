/* Key frames of a motion: few, within the bound, and the error that is told is the error. */
#include <math.h>

#include "core/io/motion_keys.h"

#define POINTS 3

/* The distance of the farthest point of any frame from the straight line between the keys around it. */
static double measure(const SporeMotionKeys *motion, const GArray *times, const GPtrArray *frames) {
  double worst = 0;
  for (guint i = 0; i < frames->len; i++) {
    double time = g_array_index(times, double, i);
    guint after = 0;
    while (g_array_index(motion->times, double, after) < time && after + 1 < motion->times->len) after++;
    guint before = after ? after - 1 : 0;
    double begin = g_array_index(motion->times, double, before), end = g_array_index(motion->times, double, after);
    const float *from = motion->keys->pdata[before], *to = motion->keys->pdata[after];
    for (int p = 0; p < POINTS; p++) {
      double square = 0;
      for (int k = 3 * p; k < 3 * p + 3; k++) {
        double part = after > before ? (time - begin) / (end - begin) : 1;
        double off = (double)from[k] * (1 - part) + (double)to[k] * part - ((double *)frames->pdata[i])[k];
        square += off * off;
      }
      worst = fmax(worst, sqrt(square));
    }
  }
  return worst;
}

/* Runs `count` frames; returns the number of keys, once error and bound are right. */
static guint run(guint count, double bound, void (*place)(double time, double *positions)) {
  SporeMotionKeys motion;
  g_autoptr(GArray) times = g_array_new(FALSE, FALSE, sizeof(double));
  g_autoptr(GPtrArray) frames = g_ptr_array_new_with_free_func(g_free);
  spore_motion_keys_init(&motion, POINTS, bound);
  for (guint i = 0; i < count; i++) {
    double time = 0.02 * i, *positions = g_new(double, 3 * POINTS);
    place(time, positions);
    spore_motion_keys_add(&motion, time, positions);
    g_array_append_val(times, time);
    g_ptr_array_add(frames, positions);
  }
  spore_motion_keys_end(&motion);
  g_assert_cmpfloat(g_array_index(motion.times, double, 0), ==, 0);
  double worst = measure(&motion, times, frames);
  g_test_message("%u frames, %u keys, error %g, told %g, bound %g", count, motion.keys->len, worst, motion.error,
                 bound);
  g_assert_cmpfloat(motion.error, <=, bound);
  g_assert_cmpfloat(fabs(worst - motion.error), <, 5e-7); /* keys are floats, of up to 2 m here: 2.4e-7 apart */
  guint keys = motion.keys->len;
  spore_motion_keys_clear(&motion);
  return keys;
}

static void stand(double time, double *positions) {
  for (int k = 0; k < 3 * POINTS; k++) positions[k] = k;
}

static void go_straight(double time, double *positions) {
  for (int k = 0; k < 3 * POINTS; k++) positions[k] = 0.125 * k + time * (k % 2 ? 0.5 : -0.25);
}

static void turn_round(double time, double *positions) {
  for (int p = 0; p < POINTS; p++) {
    positions[3 * p] = 0.1 * (p + 1) * cos(2 * time);
    positions[3 * p + 1] = 0.1 * (p + 1) * sin(2 * time);
    positions[3 * p + 2] = 0;
  }
}

static void jump(double time, double *positions) {
  for (int k = 0; k < 3 * POINTS; k++) positions[k] = time < 0.99 ? 0 : 1;
}

static void test_few(void) {
  g_assert_cmpuint(run(1, 1e-6, go_straight), ==, 1);
  g_assert_cmpuint(run(40, 1e-6, stand), ==, 1);
  g_assert_cmpuint(run(40, 1e-6, go_straight), ==, 2);
  g_assert_cmpuint(run(200, 1e-6, go_straight), <=, 6); /* frames wait for a key 48 at a time at most */
  g_assert_cmpuint(run(100, 1e-6, jump), <=, 6);
}

/* An arc of radius r and angle a is r (1 - cos(a/2)) from its chord: keys are as far apart as the bound lets them. */
static void test_bound(void) {
  for (double bound = 1e-4; bound < 0.05; bound *= 4) {
    double apart = 2 * acos(1 - bound / 0.3) / 2; /* s between keys, at 2 rad/s */
    guint least = (guint)(200 * 0.02 / apart);
    guint keys = run(201, bound, turn_round);
    g_assert_cmpuint(keys, >=, least);
    g_assert_cmpuint(keys, <=, (guint)(200 / MAX(floor(apart / 0.02) - 1, 1)) + 6);
  }
  g_assert_cmpuint(run(50, 0, turn_round), ==, 50);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/motion_keys/few", test_few);
  g_test_add_func("/motion_keys/bound", test_bound);
  return g_test_run();
}
