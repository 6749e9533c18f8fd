/* Near pairs of a set of spheres: against a look at every pair, along each axis. */
#include <glib.h>
#include <math.h>

#include "core/collide/near_pairs.h"
#include "core/math/vec3.h"

#define COUNT 300

static bool mark(void *data, uint32_t a, uint32_t b) {
  guint *seen = data;
  g_assert_cmpuint(a, <, b);
  seen[COUNT * a + b]++;
  return true;
}

static void test_all_pairs(void) {
  GRand *random = g_rand_new_with_seed(5);
  for (size_t axis = 0; axis < 3; axis++) {
    double centre[3 * COUNT], radius[COUNT];
    guint near = 0, *seen = g_new0(guint, COUNT * COUNT);
    for (size_t i = 0; i < COUNT; i++) {
      for (size_t k = 0; k < 3; k++) centre[3 * i + k] = g_rand_double_range(random, 0, k == axis ? 3 : 0.3);
      radius[i] = g_rand_double_range(random, 0.002, 0.08);
    }
    g_assert_true(spore_near_pairs(centre, radius, COUNT, 1.2, 0.01, mark, seen));
    for (size_t a = 0; a < COUNT; a++)
      for (size_t b = a + 1; b < COUNT; b++) {
        double distance = spore_vec3_distance(spore_vec3_load(centre + 3 * a), spore_vec3_load(centre + 3 * b));
        guint expected = distance < 1.2 * (radius[a] + radius[b]) + 0.01;
        g_assert_cmpuint(seen[COUNT * a + b], ==, expected);
        near += expected;
      }
    g_test_message("%u near pairs of %u", near, COUNT * (COUNT - 1) / 2);
    g_assert_cmpuint(near, >, 100);
    g_free(seen);
  }
  g_rand_free(random);
}

static bool stop(void *data, uint32_t a, uint32_t b) {
  (*(guint *)data)++;
  return false;
}

static void test_ends(void) {
  const double centre[9] = {0}, radius[3] = {1, 1, 1};
  guint calls = 0;
  g_assert_false(spore_near_pairs(centre, radius, 3, 1, 0, stop, &calls));
  g_assert_cmpuint(calls, ==, 1);
  g_assert_true(spore_near_pairs(centre, radius, 1, 1, 0, stop, &calls));
  g_assert_cmpuint(calls, ==, 1);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/near-pairs/all-pairs", test_all_pairs);
  g_test_add_func("/near-pairs/ends", test_ends);
  return g_test_run();
}
