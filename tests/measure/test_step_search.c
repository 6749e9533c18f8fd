/* The search for the largest safe step: it ends within the ratio that its cuts leave, and tries no more than it may. */
#include <glib.h>
#include <math.h>

#include "core/measure/step_search.h"

typedef struct Limit {
  double limit_s; /* steps up to here are safe */
  size_t tries, end_after;
} Limit;

static int is_safe(void *data, double step_s) {
  Limit *limit = data;
  if (limit->end_after > 0 && limit->tries == limit->end_after) return -1;
  limit->tries++;
  return step_s <= limit->limit_s;
}

static SporeStepFound search(Limit *limit, double predicted_s, size_t cuts) {
  const SporeStepSearch search = {.predicted_s = predicted_s, .usual_s = 1e-3, .largest_s = 0.1, .cuts = cuts};
  return spore_step_search(&search, is_safe, limit);
}

/* Wherever the limit lies: 6 cuts of a ratio of 2 leave 1.1 %. */
static void test_range(void) {
  for (double part = 0.06; part < 15; part *= 1.13) {
    Limit limit = {.limit_s = part * 1e-3};
    SporeStepFound found = search(&limit, 1e-3, 6);
    g_assert_cmpuint(found.tries, <=, 6 + 1 + (gsize)ceil(fabs(log2(part)) + 1e-9));
    g_assert_cmpfloat(found.safe_s, <=, limit.limit_s);
    g_assert_cmpfloat(found.unsafe_s, >, limit.limit_s);
    g_assert_cmpfloat(found.unsafe_s / found.safe_s, <=, pow(2, 1. / 64) * (1 + 1e-12));
  }
}

static void test_everything_is_safe(void) {
  Limit limit = {.limit_s = HUGE_VAL};
  SporeStepFound found = search(&limit, HUGE_VAL, 6);
  g_assert_cmpfloat(found.safe_s, ==, 0.1);
  g_assert_true(isinf(found.unsafe_s));
  g_assert_cmpuint(found.tries, ==, 1);
}

static void test_nothing_is_safe(void) {
  Limit limit = {.limit_s = 0};
  SporeStepFound found = search(&limit, 0, 6);
  g_assert_cmpfloat(found.safe_s, ==, 0);
  g_assert_cmpfloat(found.unsafe_s, <, 1e-3);
  g_assert_cmpuint(found.tries, <=, 7);
}

/* No limit was predicted, and there is one. */
static void test_unexpected_limit(void) {
  Limit limit = {.limit_s = 0.02};
  SporeStepFound found = search(&limit, HUGE_VAL, 10);
  g_assert_cmpfloat(found.safe_s, <=, 0.02);
  g_assert_cmpfloat(found.safe_s, >, 0.019);
}

static void test_ended(void) {
  Limit limit = {.limit_s = 1, .end_after = 2};
  SporeStepFound found = search(&limit, 1e-3, 6);
  g_assert_cmpuint(found.tries, ==, 2);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/step_search/range", test_range);
  g_test_add_func("/step_search/everything_is_safe", test_everything_is_safe);
  g_test_add_func("/step_search/nothing_is_safe", test_nothing_is_safe);
  g_test_add_func("/step_search/unexpected_limit", test_unexpected_limit);
  g_test_add_func("/step_search/ended", test_ended);
  return g_test_run();
}
