/* Pacing by the clock: deadlines, and what is counted when they are missed. The clock itself is never waited for long;
 * a pace that is early or late is made by moving its start. */
#include <glib.h>

#include "core/measure/pace.h"

#define SECOND_NS UINT64_C(1000000000)

static void test_due(void) {
  SporePace pace;
  spore_pace_start(&pace, 3, 2);
  g_assert_cmpuint(spore_pace_due_ns(&pace, 3), ==, pace.clock_ns);
  g_assert_cmpuint(spore_pace_due_ns(&pace, 4) - pace.clock_ns, ==, SECOND_NS / 2);
  spore_pace_set_speed(&pace, 4, 0.5);
  g_assert_cmpuint(spore_pace_due_ns(&pace, 5) - pace.clock_ns, ==, 2 * SECOND_NS);
  spore_pace_set_speed(&pace, 4, 0);
  g_assert_cmpuint(spore_pace_due_ns(&pace, 5), ==, 0);
  spore_pace_end(&pace, 5);
  SporePaceSummary summary = spore_pace_summary(&pace, 5);
  g_assert_cmpuint(summary.steps, ==, 1);
  g_assert_cmpuint(summary.misses, ==, 0);
}

static void test_early(void) {
  SporePace pace;
  spore_pace_start(&pace, 0, 1);
  pace.clock_ns += 100 * SECOND_NS; /* all is due in 100 s */
  spore_pace_begin(&pace, spore_pace_due_ns(&pace, 0));
  spore_pace_end(&pace, 0.001);
  SporePaceSummary summary = spore_pace_summary(&pace, 0.001);
  g_assert_cmpuint(summary.misses, ==, 0);
  g_assert_cmpfloat(summary.worst_late_us, ==, 0);
  g_assert_cmpfloat(summary.jitter_max_us, ==, 0);
  g_assert_cmpfloat(summary.given_up_s, ==, 0);
}

/* A little late is made up for; far behind is given up, once. */
static void test_late(void) {
  SporePace pace;
  spore_pace_start(&pace, 0, 1);
  pace.clock_ns -= 50 * SECOND_NS;
  spore_pace_begin(&pace, spore_pace_due_ns(&pace, 0));
  spore_pace_end(&pace, 10);
  SporePaceSummary summary = spore_pace_summary(&pace, 10);
  g_assert_cmpuint(summary.misses, ==, 1);
  g_assert_cmpfloat(summary.worst_late_us, >=, 40e6);
  g_assert_cmpfloat(summary.jitter_max_us, >=, 4.2e6); /* a sample of the profile holds 4.29 s at most in its median */
  g_assert_cmpfloat(summary.given_up_s, >=, 40);
  g_assert_cmpuint(spore_pace_due_ns(&pace, 10), <=, spore_clock_ns());
  g_assert_cmpuint(spore_pace_due_ns(&pace, 1000), >, spore_clock_ns());
}

static void test_sleep(void) {
  uint64_t due = spore_clock_ns() + SECOND_NS / 500;
  spore_pace_sleep_until(due);
  g_assert_cmpuint(spore_clock_ns(), >=, due);
  spore_pace_sleep_until(0);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/pace/due", test_due);
  g_test_add_func("/pace/early", test_early);
  g_test_add_func("/pace/late", test_late);
  g_test_add_func("/pace/sleep", test_sleep);
  return g_test_run();
}
